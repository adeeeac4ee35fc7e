#include "carom/driver.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "collision/random.hpp"
#include "world/builders.hpp"

namespace carom::test {
namespace {

template <class T>
class Driver : public testing::Test {};
TYPED_TEST_SUITE(Driver, BothDimensions);

/// A body in steady motion along x at 1 m/s.
template <int D>
BodyId<D> add_runner(World<D>& world) {
    BodyDefinition<D> d = unit_body<D>();
    d.velocity = vec<D>(1, 0);
    d.angular_velocity = spin<D>(0.5);
    return world.add_body(d);
}

TYPED_TEST(Driver, TakesTheStepsThatAreDue) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    FixedStepDriver<D> driver(world, 0.01);
    EXPECT_EQ(driver.advance(0), 0);
    EXPECT_EQ(driver.advance(0.0099), 0);
    EXPECT_NEAR(driver.alpha(), 0.99, 1e-12);
    EXPECT_EQ(driver.advance(0.0002), 1);
    EXPECT_NEAR(driver.alpha(), 0.01, 1e-12);
    EXPECT_EQ(driver.advance(0.0399), 4);
    EXPECT_EQ(world.steps(), 5u);
    EXPECT_NEAR(world.time(), 0.05, 1e-15);
}

TYPED_TEST(Driver, LosesNoTimeOverIrregularFrames) {
    constexpr int D = TypeParam::value;
    Random random(1);
    World<D> world(no_gravity<D>());
    const BodyId<D> body = add_runner(world);
    FixedStepDriver<D> driver(world, frame_time, 100);
    double total = 0;
    std::uint64_t steps = 0;
    for (int i = 0; i < 2000; ++i) {
        const double frame = i % 100 == 7 ? 0.3 : random.between(0, 0.04);
        steps += static_cast<std::uint64_t>(driver.advance(frame));
        total += frame;
        ASSERT_GE(driver.alpha(), 0);
        ASSERT_LT(driver.alpha(), 1);
        ASSERT_EQ(world.steps(), steps);
        // What is drawn lags by exactly one step, so motion looks as smooth as time is.
        ASSERT_NEAR(driver.interpolated(body).position.x, std::max(0.0, total - frame_time), 1e-9);
        if constexpr (D == 2) {
            const double angle = std::max(0.0, 0.5 * (total - frame_time));
            const Rotation2 q = driver.interpolated(body).rotation;
            ASSERT_NEAR(q.c, std::cos(angle), 1e-6);
            ASSERT_NEAR(q.s, std::sin(angle), 1e-6);
        }
    }
    EXPECT_NEAR(static_cast<double>(steps) * frame_time + driver.alpha() * frame_time, total, 1e-8);
}

TYPED_TEST(Driver, SixtyFramesASecondAreSixtySteps) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    FixedStepDriver<D> driver(world);
    for (int i = 0; i < 6000; ++i) ASSERT_EQ(driver.advance(1.0 / 60), 1) << "frame " << i;
    for (int i = 0; i < 6000; ++i) ASSERT_EQ(driver.advance(1.0 / 120), i % 2) << "half frame " << i;
}

TYPED_TEST(Driver, DropsTimeThatItCannotCatchUp) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    FixedStepDriver<D> driver(world, 0.01, 5);
    EXPECT_EQ(driver.advance(10), 5);
    EXPECT_GE(driver.alpha(), 0);
    EXPECT_LT(driver.alpha(), 1);
    EXPECT_EQ(driver.advance(0), 0) << "the rest is gone";
    EXPECT_EQ(driver.advance(0.0101), 1);
    EXPECT_EQ(driver.advance(1e300), 5);
    EXPECT_LT(driver.alpha(), 1);
}

TYPED_TEST(Driver, StepsGiveWhatTheWorldGives) {
    constexpr int D = TypeParam::value;
    Random random(3);
    World<D> driven, plain;
    for (World<D>* world : {&driven, &plain}) {
        world->add_body(ground<D>());
        for (int i = 0; i < 5; ++i) world->add_body(body_of<D>(cube<D>(0.5), vec<D>(0.1 * i, 1 + i)));
    }
    FixedStepDriver<D> driver(driven);
    int steps = 0;
    while (steps < 120) steps += driver.advance(random.between(0, 0.05));
    run(plain, steps);
    EXPECT_EQ(driven.hash(), plain.hash());
}

TYPED_TEST(Driver, ATeleportDoesNotSmear) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> body = add_runner(world);
    FixedStepDriver<D> driver(world, 0.01);
    driver.advance(0.055);
    driver.teleport(body, {vec<D>(100, 7), turn_about_z<D>(2)});
    EXPECT_EQ(driver.interpolated(body).position, vec<D>(100, 7)) << "there at once, and not on the way";
    driver.advance(0.002);
    EXPECT_EQ(driver.interpolated(body).position, vec<D>(100, 7));
    driver.advance(0.01);
    EXPECT_NEAR(driver.interpolated(body).position.x, 100 + 0.01 * driver.alpha(), 1e-12)
        << "then it runs on";
    EXPECT_EQ(world.position(body).x, 100 + 0.01);
}

TYPED_TEST(Driver, ANewBodyIsWhereItIs) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> first = add_runner(world);
    FixedStepDriver<D> driver(world, 0.01);
    driver.advance(0.055);
    const BodyId<D> late = world.add_body(unit_body<D>(vec<D>(50, 0)));
    EXPECT_EQ(driver.interpolated(late).position, vec<D>(50, 0));
    driver.teleport(late, {vec<D>(60, 0), {}});
    EXPECT_EQ(driver.interpolated(late).position, vec<D>(60, 0));
    // One that takes over a place has nothing of the one that was there.
    world.remove_body(first);
    const BodyId<D> heir = world.add_body(unit_body<D>(vec<D>(-9, 0)));
    EXPECT_EQ(heir.index, first.index);
    EXPECT_EQ(driver.interpolated(heir).position, vec<D>(-9, 0));
    EXPECT_THROW(driver.interpolated(first), Error);
    EXPECT_THROW(driver.teleport(first, {}), Error);
}

TYPED_TEST(Driver, TurnsTheShortWay) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.rotation = turn_about_z<D>(3.1);
    d.angular_velocity = spin<D>(10);
    const BodyId<D> body = world.add_body(d);
    FixedStepDriver<D> driver(world, 0.01);
    driver.advance(0.015);  // from 3.1 to 3.2, across the cut at π; drawn half-way
    const Vec<D> x = rotate(driver.interpolated(body).rotation, vec<D>(1, 0));
    EXPECT_NEAR(x.x, std::cos(3.15), 1e-9);
    EXPECT_NEAR(x.y, std::sin(3.15), 1e-9);
}

TYPED_TEST(Driver, RefusesNonsense) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(FixedStepDriver<D>(world, 0), Error);
    EXPECT_THROW(FixedStepDriver<D>(world, -1), Error);
    EXPECT_THROW(FixedStepDriver<D>(world, 2), Error);
    EXPECT_THROW(FixedStepDriver<D>(world, nan), Error);
    EXPECT_THROW(FixedStepDriver<D>(world, 0.01, 0), Error);
    FixedStepDriver<D> driver(world);
    EXPECT_THROW(driver.advance(-0.1), Error);
    EXPECT_THROW(driver.advance(nan), Error);
    EXPECT_THROW(driver.advance(std::numeric_limits<double>::infinity()), Error);
    EXPECT_EQ(world.steps(), 0u);
    EXPECT_EQ(driver.alpha(), 0);
    EXPECT_EQ(driver.advance(frame_time), 1);
}

}  // namespace
}  // namespace carom::test
