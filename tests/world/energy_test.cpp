#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "world/builders.hpp"

namespace carom::test {
namespace {

template <class T>
class EnergyIn : public testing::Test {};
TYPED_TEST_SUITE(EnergyIn, BothDimensions);

TYPED_TEST(EnergyIn, IsThatOfMotionAndHeight) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = unit_body<D>(vec<D>(1, 5));
    d.mass = 2;
    d.velocity = vec<D>(3, 4);
    d.angular_velocity = spin<D>(2);
    const BodyId<D> body = world.add_body(d);
    const Energy e = world.energy(body);
    EXPECT_NEAR(e.kinetic, 0.5 * 2 * 25 + 0.5 * 4, 1e-13);
    EXPECT_NEAR(e.potential, 2 * 9.81 * 5, 1e-12);
    EXPECT_NEAR(e.total(), e.kinetic + e.potential, 1e-15);
    d.position = vec<D>(30, -5);
    d.gravity_scale = 0.5;
    world.add_body(d);
    EXPECT_NEAR(world.energy().kinetic, 2 * e.kinetic, 1e-12);
    EXPECT_NEAR(world.energy().potential, 2 * 9.81 * 2.5, 1e-12);
    world.set_gravity(vec<D>(1, 0));
    EXPECT_NEAR(world.energy(body).potential, -2, 1e-13);
}

TYPED_TEST(EnergyIn, StaysInFreeFlight) {
    constexpr int D = TypeParam::value;
    Random random(1);
    World<D> world(sleepless<D>());
    for (int i = 0; i < 10; ++i) {
        BodyDefinition<D> d = body_of<D>(cube<D>(0.1 + 0.1 * i), vec<D>(20 * i, 0));
        d.velocity = random.in_cube<D>(10);
        d.angular_velocity = spin<D>(random.between(-9, 9));
        world.add_body(d);
    }
    const double before = world.energy().total();
    run(world, 600);
    EXPECT_NEAR(world.energy().total(), before, 1e-9 * world.energy().kinetic);
}

/// A ball that bounces with e = 1 keeps its energy, at any step size.
TYPED_TEST(EnergyIn, StaysInElasticBounces) {
    constexpr int D = TypeParam::value;
    for (const double h : {1.0 / 30, 1.0 / 60, 1.0 / 144}) {
        World<D> world(sleepless<D>());
        Material rubber;
        rubber.restitution = 1;
        world.add_body(ground<D>(rubber));
        BodyDefinition<D> d = body_of<D>(Ball{0.5}, vec<D>(0, 1.5), rubber);
        d.mass = 1;
        world.add_body(d);
        const double before = world.energy().total();
        run(world, static_cast<int>(10 / h), h);
        EXPECT_NEAR(world.energy().total(), before, 1e-3 * before) << "step " << h;
    }
}

/// Sums of springs, point gravity, motion and height that turn into each other.
TYPED_TEST(EnergyIn, StaysWhereForcesAreConservative) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition = sleepless<D>();
    definition.integrator = Integrator::rk4;
    World<D> world(definition);
    const BodyId<D> a = world.add_body(unit_body<D>(vec<D>(3, 0))),
                    b = world.add_body(unit_body<D>(vec<D>(0, 4)));
    Spring<D> spring;
    spring.a = a;
    spring.b = b;
    spring.anchor_a = vec<D>(0.3, 0.1);
    spring.stiffness = 20;
    spring.length = 3;
    world.add_force({spring});
    Spring<D> rope;
    rope.b = b;
    rope.stiffness = 50;
    world.add_force({rope});
    world.add_force({PointGravity<D>{vec<D>(-5, -5), 20}});
    const double before = world.energy().total();
    double most_kinetic = 0;
    for (int i = 0; i < 2400; ++i) {
        world.step(1.0 / 480);
        most_kinetic = std::max(most_kinetic, world.energy().kinetic);
        ASSERT_NEAR(world.energy().total(), before, 1e-5) << "step " << i;
    }
    EXPECT_GT(most_kinetic, 5);
}

}  // namespace
}  // namespace carom::test
