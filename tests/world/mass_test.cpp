#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Mass, centre and inertia of bodies: from the shapes, and where the user knows better.

namespace carom::test {
namespace {

template <int D>
Inertia<D> round_inertia(double i) {
    if constexpr (D == 2)
        return i;
    else
        return {i, i, i, 0, 0, 0};
}
double first_moment(double i) { return i; }
double first_moment(const Symmetric3<double>& i) { return i.xx; }

template <class T>
class Mass : public testing::Test {};
TYPED_TEST_SUITE(Mass, BothDimensions);

TYPED_TEST(Mass, FollowsFromTheShapes) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(cube<D>(1));
    d.shapes.push_back(shape_of<D>(cube<D>(2)));
    d.shapes[1].center = vec<D>(3, 0);
    d.shapes[1].material.density = 500;
    const BodyId<D> body = world.add_body(d);
    const double m1 = 1000, m2 = 500 * std::pow(2, D), mass = m1 + m2;
    const MassProperties<D> p = world.mass_properties(body);
    EXPECT_NEAR(p.mass, mass, 1e-9);
    EXPECT_LT(length(p.center - vec<D>(3 * m2 / mass, 0)), 1e-12);
    EXPECT_LT(length(world.position(body)), 1e-15) << "the frame stays where it was put";
    EXPECT_LT(length(world.center_of_mass(body) - p.center), 1e-15);
    // A cube turns about its middle with m s² / 6; for the pair's z axis Steiner adds the reduced mass times
    // 3².
    const double about_z = m1 / 6 + m2 * 4 / 6 + m1 * m2 / mass * 9;
    if constexpr (D == 2)
        EXPECT_NEAR(p.inertia, about_z, 1e-9);
    else
        EXPECT_NEAR(p.inertia.zz, about_z, 1e-9);
}

TYPED_TEST(Mass, FollowsShapesThatComeAndGo) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(5, 5));
    d.rotation = turn_about_z<D>(0.5);
    d.velocity = vec<D>(1, 2);
    d.angular_velocity = spin<D>(3);
    const BodyId<D> body = world.add_body(d);
    const Vec<D> corner = world.position(body) + vec<D>(0.3, 0.1);
    const Vec<D> velocity = world.velocity_at(body, corner);
    ShapeDefinition<D> arm = shape_of<D>(cube<D>(1));
    arm.center = vec<D>(2, 0);
    const ShapeId<D> shape = world.add_shape(body, arm);
    EXPECT_NEAR(world.mass_properties(body).mass, 2000, 1e-9);
    EXPECT_LT(length(world.mass_properties(body).center - vec<D>(1, 0)), 1e-12);
    EXPECT_LT(length(world.position(body) - vec<D>(5, 5)), 1e-14) << "the frame does not jump";
    EXPECT_LT(length(world.velocity_at(body, corner) - velocity), 1e-13) << "nor does any point's velocity";
    world.remove_shape(shape);
    EXPECT_NEAR(world.mass_properties(body).mass, 1000, 1e-9);
    EXPECT_LT(length(world.mass_properties(body).center), 1e-12);
    EXPECT_LT(length(world.position(body) - vec<D>(5, 5)), 1e-14);
    EXPECT_LT(length(world.velocity_at(body, corner) - velocity), 1e-13);
}

TYPED_TEST(Mass, AGivenMassScalesTheInertia) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(cube<D>(1));
    d.mass = 6;
    const MassProperties<D> p = world.mass_properties(world.add_body(d));
    EXPECT_EQ(p.mass, 6);
    EXPECT_NEAR(first_moment(p.inertia), 1, 1e-12);
    d.shapes[0].material.density = 0;  // the shape still says how the mass is spread
    const MassProperties<D> light = world.mass_properties(world.add_body(d));
    EXPECT_EQ(light.mass, 6);
    EXPECT_NEAR(first_moment(light.inertia), 1, 1e-12);
}

TYPED_TEST(Mass, OverridesHold) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(2, 2));
    d.mass = 6;
    d.center_of_mass = vec<D>(0.25, -0.25);
    d.inertia = round_inertia<D>(3);
    const BodyId<D> body = world.add_body(d);
    world.add_shape(body, shape_of<D>(Ball{2}));
    MassProperties<D> p = world.mass_properties(body);
    EXPECT_EQ(p.mass, 6);
    EXPECT_EQ(p.center, vec<D>(0.25, -0.25));
    EXPECT_EQ(p.inertia, round_inertia<D>(3));
    EXPECT_LT(length(world.center_of_mass(body) - vec<D>(2.25, 1.75)), 1e-15);

    world.set_mass_properties(body, {2, vec<D>(0, 0.5), round_inertia<D>(0.5)});
    p = world.mass_properties(body);
    EXPECT_EQ(p.mass, 2);
    EXPECT_LT(length(world.center_of_mass(body) - vec<D>(2, 2.5)), 1e-15);
    EXPECT_LT(length(world.position(body) - vec<D>(2, 2)), 1e-15);
    world.apply_impulse(body, vec<D>(3, 0), vec<D>(2, 3.5));
    EXPECT_LT(length(world.velocity(body) - vec<D>(1.5, 0)), 1e-15);
    EXPECT_NEAR(spin_speed<D>(world.angular_velocity(body)), 6, 1e-14) << "3 N·s at 1 m on ½ kg·m²";
}

TYPED_TEST(Mass, ATensorTurnsWithItsBody) {
    constexpr int D = TypeParam::value;
    if constexpr (D == 3) {
        World3 world(no_gravity<3>());
        BodyDefinition3 d = body_of<3>(Ball{1});
        d.inertia = Inertia<3>{2, 3, 4, 0.5, -0.25, 0.125};
        Random random(4);
        d.rotation = random.rotation<3>();
        const BodyId3 body = world.add_body(d);
        const Vec3 impulse = random.in_cube<3>(1);
        world.apply_angular_impulse(body, impulse);
        const Vec3 w = world.angular_velocity(body);
        EXPECT_LT(
            length(rotate(world.rotation(body), *d.inertia * unrotate(world.rotation(body), w)) - impulse),
            1e-14);
    } else {
        World2 world(no_gravity<2>());
        BodyDefinition2 d = body_of<2>(Ball{1});
        d.inertia = 4;
        const BodyId2 body = world.add_body(d);
        world.apply_angular_impulse(body, 2);
        EXPECT_EQ(world.angular_velocity(body), 0.5);
    }
}

/// A body whose centre of mass lies in one corner falls over that corner's side: an unbalanced box on an
/// edge.
TYPED_TEST(Mass, TheCentreDecidesHowABodyTips) {
    constexpr int D = TypeParam::value;
    for (const double offset : {-0.4, 0.4}) {
        World<D> world;
        world.add_body(fixed_of<D>(Box<D>{vec<D>(0.4, 1, 2)}, vec<D>(0, -0.5)));
        BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(1, 0.2, 1)}, vec<D>(0, 0.1));
        d.center_of_mass = vec<D>(offset, 0);
        const BodyId<D> body = world.add_body(d);
        run(world, 30);
        const Vec<D> axis = rotate(world.rotation(body), vec<D>(1, 0));
        EXPECT_LT(axis.y * offset, -0.01);
    }
}

/// A point without extent: it falls, and nothing turns it.
TYPED_TEST(Mass, APointHasNoInertia) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d;
    d.mass = 1;
    const BodyId<D> body = world.add_body(d);
    world.apply_torque(body, spin<D>(5));
    world.apply_force(body, vec<D>(1, 0), vec<D>(0, 7));
    run(world, 10);
    EXPECT_EQ(spin_speed<D>(world.angular_velocity(body)), 0);
    EXPECT_NEAR(world.velocity(body).x, frame_time, 1e-15);
    EXPECT_TRUE(world.quarantined().empty());
}

}  // namespace
}  // namespace carom::test
