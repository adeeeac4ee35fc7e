#include <gtest/gtest.h>

#include "world/builders.hpp"

// Small stacks stand: after a few seconds they are still, not deep in one another, and where they were built.
// Nothing may sleep.

namespace carom::test {
namespace {

/// What a stack may do in its last second, and how far a body may come from where it was built.
struct Limits {
    double speed = 1e-3;    // m/s
    double overlap = 2e-3;  // m
    double moved = 0.02;    // m
};

/// High columns and very unlike masses settle slowly: their points sink further before they carry.
constexpr Limits wall{1e-3, 4e-3, 0.02}, column{5e-3, 0.01, 0.06}, unlike_masses{0.04, 0.1, 0.12},
    totem{0.03, 2e-3, 0.02};

/// Lets the world run for five seconds and asks for rest.
template <int D>
void expect_still(World<D>& world, const Limits& limits = {}) {
    constexpr int steps = 300;
    std::vector<Vec<D>> start;
    for (const BodyId<D>& body : world.bodies()) start.push_back(world.center_of_mass(body));
    run(world, steps - 60);
    double speed = 0;
    for (int i = 0; i < 60; ++i) {
        world.step(frame_time);
        speed = std::max(speed, fastest(world));
    }
    EXPECT_LT(speed, limits.speed);
    EXPECT_LT(deepest_overlap(world), limits.overlap);
    double moved = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
        moved = std::max(moved, length(world.center_of_mass(world.bodies()[i]) - start[i]));
    EXPECT_LT(moved, limits.moved) << "it did not stay as it was built";
}

template <class T>
class Stacks : public testing::Test {};
TYPED_TEST_SUITE(Stacks, BothDimensions);

TYPED_TEST(Stacks, TenBoxes) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (int i = 0; i < 10; ++i) world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5 + i)));
    expect_still(world, column);
}

TYPED_TEST(Stacks, TenBoxesLetFallApart) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (int i = 0; i < 10; ++i) world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.501 + 1.001 * i)));
    expect_still(world, column);
}

TYPED_TEST(Stacks, APyramid) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (int row = 0; row < 8; ++row) {
        for (int i = 0; i < 8 - row; ++i)
            world.add_body(body_of<D>(cube<D>(1), vec<D>(1.05 * (i + 0.5 * row), 0.5 + row)));
    }
    expect_still(world);
}

TYPED_TEST(Stacks, AWall) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (int row = 0; row < 6; ++row) {
        for (int i = 0; i < 6 - row % 2; ++i)
            world.add_body(body_of<D>(Box<D>{vec<D>(1, 0.5, 0.5)},
                                      vec<D>(1.001 * i + 0.5 * (row % 2), 0.25 + 0.5 * row)));
    }
    expect_still(world, wall);
}

TYPED_TEST(Stacks, ABoxOnARowOfCapsules) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (int i = -1; i <= 1; ++i) {
        // In the plane they lie along x; in space along z, where they could roll: they are wedged.
        const Vec<D> half = D == 2 ? vec<D>(0.25, 0) : vec<D>(0, 0, 0.5);
        Material material;
        material.rolling_resistance = D == 2 ? 0 : 0.02;
        world.add_body(body_of<D>(Capsule<D>{-half, half, 0.25}, vec<D>(1.05 * i, 0.25), material));
    }
    world.add_body(body_of<D>(Box<D>{vec<D>(3, 0.5, 1)}, vec<D>(0, 0.75)));
    expect_still(world);
}

TYPED_TEST(Stacks, AHeavyBlockOnTwoSmallOnes) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (const double x : {-1.0, 1.0}) {
        BodyDefinition<D> d = body_of<D>(cube<D>(0.5), vec<D>(x, 0.25));
        d.mass = 1;
        world.add_body(d);
    }
    BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(3, 1, 1)}, vec<D>(0, 1));
    d.mass = 400;
    world.add_body(d);
    expect_still(world, unlike_masses);
}

TYPED_TEST(Stacks, ATableWithThingsOnIt) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    BodyDefinition<D> table;
    table.position = vec<D>(0, 1);
    const auto part = [&](const Vec<D>& size, const Vec<D>& center) {
        table.shapes.push_back(shape_of<D>(Box<D>{size}));
        table.shapes.back().center = center;
    };
    part(vec<D>(3, 0.2, 2), vec<D>(0, 0.1));
    for (const double x : {-1.3, 1.3}) {
        for (const double z : {-0.8, 0.8}) {
            if (D == 3 || z > 0) part(vec<D>(0.2, 1, 0.2), vec<D>(x, -0.5, z));
        }
    }
    world.add_body(table);
    world.add_body(body_of<D>(cube<D>(0.6), vec<D>(-0.8, 1.5)));
    world.add_body(body_of<D>(cube<D>(0.4), vec<D>(-0.8, 2)));
    world.add_body(body_of<D>(cube<D>(0.8), vec<D>(0.7, 1.6)));
    expect_still(world);
}

/// A slope of 20° with enough friction holds a box where it is; only the settling moves it.
TYPED_TEST(Stacks, ABoxOnASlope) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const double angle = 20 * std::acos(-1.0) / 180;
    BodyDefinition<D> slope = ground<D>();
    slope.rotation = turn_about_z<D>(angle);
    world.add_body(slope);
    BodyDefinition<D> d = body_of<D>(cube<D>(1));
    d.rotation = slope.rotation;
    d.position = rotate(slope.rotation, vec<D>(0, 0.5));
    world.add_body(d);
    expect_still(world);
}

/// Shapes of every kind on one another: a totem.
TEST(StacksInSpace, ATotem) {
    World3 world(sleepless<3>());
    world.add_body(ground<3>());
    world.add_body(body_of<3>(Cylinder{0.6, 1}, {0, 0.5, 0}));
    world.add_body(body_of<3>(Box3{{1, 0.5, 1}}, {0, 1.25, 0}));
    Hull3 frustum;
    for (const double x : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
            frustum.points.push_back({0.5 * x, 0, 0.5 * z});
            frustum.points.push_back({0.3 * x, 0.6, 0.3 * z});
        }
    }
    world.add_body(body_of<3>(frustum, {0, 1.5, 0}));
    world.add_body(body_of<3>(Box3{{0.8, 0.4, 0.8}, 0.05}, {0, 2.3, 0}));
    world.add_body(body_of<3>(Cone{0.4, 0.8}, {0, 2.9, 0}));
    expect_still(world, totem);
}

}  // namespace
}  // namespace carom::test
