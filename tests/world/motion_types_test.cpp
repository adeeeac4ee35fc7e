#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Fixed and kinematic bodies, locked axes, gravity scale, damping.

namespace carom::test {
namespace {

template <class T>
class Motion : public testing::Test {};
TYPED_TEST_SUITE(Motion, BothDimensions);

/// A heap of bodies that fall on what stands at the origin.
template <int D>
void pour(World<D>& world, int count) {
    Random random(5);
    for (int i = 0; i < count; ++i) {
        BodyDefinition<D> d = body_of<D>(i % 2 ? Geometry<D>{Ball{0.3}} : Geometry<D>{cube<D>(0.5)});
        d.position = random.in_cube<D>(1);
        d.position.y = 2 + 0.7 * i;
        d.velocity = vec<D>(0, -5);
        world.add_body(d);
    }
}

TYPED_TEST(Motion, AFixedBodyNeverMoves) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = fixed_of<D>(cube<D>(2), vec<D>(0.25, -0.5));
    d.velocity = vec<D>(3, 3);  // of no meaning for it
    const BodyId<D> block = world.add_body(d);
    const BodyId<D> mesh = world.add_body(fixed_of<D>(Ball{1}, vec<D>(3, 0)));
    pour(world, 20);
    const Transform<D> before = world.transform(block), other = world.transform(mesh);
    run(world, 120);
    EXPECT_GT(world.counts().contacts, 0);
    EXPECT_EQ(world.transform(block), before);
    EXPECT_EQ(world.transform(mesh), other);
    EXPECT_EQ(world.velocity(block), Vec<D>{});
    EXPECT_EQ(world.mass_properties(block).mass, 0);
    EXPECT_EQ(world.energy(block).total(), 0);
}

TYPED_TEST(Motion, AKinematicBodyGoesItsWayWhateverLiesOnIt) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = fixed_of<D>(cube<D>(2), vec<D>(0, 0));
    d.type = BodyType::kinematic;
    d.velocity = vec<D>(0.5, 0.25);
    d.angular_velocity = spin<D>(0.4);
    const BodyId<D> platform = world.add_body(d);
    pour(world, 20);
    run(world, 120);
    EXPECT_LT(length(world.position(platform) - vec<D>(1, 0.5)), 1e-13);
    EXPECT_EQ(world.velocity(platform), vec<D>(0.5, 0.25));
    EXPECT_EQ(spin_speed<D>(world.angular_velocity(platform)), 0.4);
    const Vec<D> x = rotate(world.rotation(platform), vec<D>(1, 0));
    EXPECT_NEAR(std::atan2(x.y, x.x), 0.8, 1e-12);
}

TYPED_TEST(Motion, AKinematicBodyPushes) {
    constexpr int D = TypeParam::value;
    World<D> world;
    Material smooth;
    smooth.friction = 0;
    world.add_body(ground<D>(smooth));
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(-2, 0.5), smooth);
    d.type = BodyType::kinematic;
    d.velocity = vec<D>(2, 0);
    world.add_body(d);
    const BodyId<D> ball = world.add_body(body_of<D>(Ball{0.5}, vec<D>(0, 0.5), smooth));
    run(world, 180);
    EXPECT_NEAR(world.velocity(ball).x, 2, 1e-4);
    EXPECT_NEAR(world.position(ball).x, -2 + 2 * 3 + 1, 2e-3);
    EXPECT_TRUE(world.awake(ball)) << "what is pushed does not sleep";
}

TYPED_TEST(Motion, AKinematicLiftCarries) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(4, 1, 4)}, vec<D>(0, -0.5));
    d.type = BodyType::kinematic;
    const BodyId<D> lift = world.add_body(d);
    const BodyId<D> crate = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 120);
    EXPECT_FALSE(world.awake(crate));
    world.set_velocity(lift, vec<D>(0.5, 1));
    run(world, 120);
    EXPECT_NEAR(world.position(crate).y, 2.5, 5e-3);
    EXPECT_NEAR(world.position(crate).x, 1, 0.05) << "friction takes it along";
    EXPECT_NEAR(world.velocity(crate).y, 1, 1e-3);
    world.set_velocity(lift, {});
    run(world, 120);
    EXPECT_FALSE(world.awake(crate));
    EXPECT_NEAR(world.position(crate).y, 2.5, 5e-3);
}

TYPED_TEST(Motion, TypesCanChange) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(fixed_of<D>(cube<D>(1), vec<D>(0, 3)));
    run(world, 30);
    EXPECT_EQ(world.position(box), vec<D>(0, 3));
    world.set_type(box, BodyType::dynamic);
    EXPECT_EQ(world.type(box), BodyType::dynamic);
    EXPECT_NEAR(world.mass_properties(box).mass, 1000, 1e-9);
    run(world, 30);
    EXPECT_NEAR(world.velocity(box).y, -9.81 / 2, 1e-9);
    world.set_type(box, BodyType::kinematic);
    EXPECT_EQ(world.mass_properties(box).mass, 0);
    const double y = world.position(box).y, speed = world.velocity(box).y;
    run(world, 6);
    EXPECT_NEAR(world.position(box).y, y + 0.1 * speed, 1e-12) << "it keeps its velocity";
    world.set_type(box, BodyType::fixed);
    EXPECT_EQ(world.velocity(box), Vec<D>{});
    world.set_type(box, BodyType::dynamic);
    run(world, 180);
    EXPECT_NEAR(world.position(box).y, 0.5, 2e-3) << "it still collides";
}

TYPED_TEST(Motion, WhatLiesOnABodyFallsWhenItTurnsToAir) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> table = world.add_body(fixed_of<D>(cube<D>(1)));
    const BodyId<D> cup = world.add_body(body_of<D>(cube<D>(0.5), vec<D>(0, 0.75)));
    run(world, 120);
    EXPECT_FALSE(world.awake(cup));
    world.set_type(table, BodyType::dynamic);
    run(world, 30);
    EXPECT_TRUE(world.awake(cup));
    EXPECT_NEAR(world.velocity(cup).y, world.velocity(table).y, 1e-3);
    EXPECT_LT(world.velocity(table).y, -4.8);
}

/// Each lock alone, and under contact: a body tumbles down stairs of balls and never leaves what is locked.
TYPED_TEST(Motion, LockedAxesStayLockedInContact) {
    constexpr int D = TypeParam::value;
    Random random(3);
    for (int axis = 0; axis < 6; ++axis) {
        Locks locks;
        bool* const each[] = {&locks.x, &locks.y, &locks.z, &locks.rx, &locks.ry, &locks.rz};
        *each[axis] = true;
        if (D == 2 && axis != 0 && axis != 1 && axis != 5) continue;
        World<D> world(sleepless<D>());
        for (int i = 0; i < 60; ++i)
            world.add_body(fixed_of<D>(Ball{0.5}, random.in_cube<D>(2) + vec<D>(0, -1.2, 0)));
        BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(1, 0.6, 0.8)}, vec<D>(0, 3));
        d.rotation = random.rotation<D>();
        d.velocity = vec<D>(2, -5, 1);
        d.locks = locks;
        if constexpr (D == 3) d.angular_velocity = {2, 3, 4};
        const BodyId<D> body = world.add_body(d);
        const Vec<D> start = world.center_of_mass(body);
        const double angle = D == 2 ? std::atan2(rotate(world.rotation(body), vec<D>(1, 0)).y,
                                                 rotate(world.rotation(body), vec<D>(1, 0)).x)
                                    : 0;
        bool touched = false;
        for (int i = 0; i < 120; ++i) {
            world.step(frame_time);
            touched |= world.counts().contacts > 0;
            if (axis < 3) {
                ASSERT_EQ(world.center_of_mass(body)[axis], start[axis]);
                ASSERT_EQ(world.velocity(body)[axis], 0);
            } else if constexpr (D == 3) {
                ASSERT_EQ(world.angular_velocity(body)[axis - 3], 0);
            } else {
                const Vec<D> x = rotate(world.rotation(body), vec<D>(1, 0));
                ASSERT_NEAR(std::atan2(x.y, x.x), angle, 1e-12);
            }
        }
        EXPECT_TRUE(touched || axis == 1) << "axis " << axis;
    }
}

TYPED_TEST(Motion, AFullyLockedBodyCarriesLikeAFixedOne) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1));
    d.locks = {true, true, true, true, true, true};
    const BodyId<D> shelf = world.add_body(d);
    const BodyId<D> book = world.add_body(body_of<D>(cube<D>(0.5), vec<D>(0, 0.8)));
    run(world, 120);
    EXPECT_EQ(world.position(shelf), Vec<D>{});
    EXPECT_NEAR(world.position(book).y, 0.75, 1e-3);
}

TYPED_TEST(Motion, LocksCanBeSetAndTakenAway) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.velocity = vec<D>(1, 2);
    d.angular_velocity = spin<D>(3);
    const BodyId<D> body = world.add_body(d);
    Locks locks;
    locks.x = locks.rz = true;
    world.set_locks(body, locks);
    EXPECT_EQ(world.velocity(body), vec<D>(0, 2));
    EXPECT_EQ(spin_speed<D>(world.angular_velocity(body)), 0);
    world.set_velocity(body, vec<D>(5, 1));
    world.set_angular_velocity(body, spin<D>(5));
    world.apply_impulse(body, vec<D>(4, 0), vec<D>(0, 1));
    EXPECT_EQ(world.velocity(body), vec<D>(0, 1));
    EXPECT_EQ(spin_speed<D>(world.angular_velocity(body)), 0);
    world.apply_force(body, vec<D>(10, 0), vec<D>(0, 1));
    run(world, 60);
    EXPECT_LT(length(world.position(body) - vec<D>(0, 1)), 1e-13);
    world.set_locks(body, {});
    world.apply_impulse(body, vec<D>(4, 0));
    EXPECT_EQ(world.velocity(body), vec<D>(4, 1));
}

TYPED_TEST(Motion, GravityScales) {
    constexpr int D = TypeParam::value;
    World<D> world;
    std::vector<BodyId<D>> bodies;
    for (const double scale : {0.0, 0.5, 1.0, -2.0}) {
        BodyDefinition<D> d = unit_body<D>(vec<D>(3 * static_cast<double>(bodies.size()), 0));
        d.gravity_scale = scale;
        bodies.push_back(world.add_body(d));
    }
    run(world, 30);
    EXPECT_EQ(world.velocity(bodies[0]).y, 0);
    EXPECT_NEAR(world.velocity(bodies[1]).y, -0.25 * 9.81, 1e-12);
    EXPECT_NEAR(world.velocity(bodies[2]).y, -0.5 * 9.81, 1e-12);
    EXPECT_NEAR(world.velocity(bodies[3]).y, 9.81, 1e-12);
    EXPECT_NEAR(world.energy(bodies[3]).potential, -2 * 9.81 * world.position(bodies[3]).y, 1e-12);
    world.set_gravity_scale(bodies[2], 0);
    world.set_gravity(vec<D>(2, 0));
    EXPECT_EQ(world.definition().gravity, vec<D>(2, 0));
    run(world, 30);
    EXPECT_NEAR(world.velocity(bodies[2]).x, 0, 1e-15);
    EXPECT_NEAR(world.velocity(bodies[1]).x, 0.5, 1e-12);
}

TYPED_TEST(Motion, AHeavyScaleRestsToo) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.6));
    d.gravity_scale = 20;
    const BodyId<D> box = world.add_body(d);
    run(world, 180);
    EXPECT_LT(fastest(world), 1e-3);
    EXPECT_NEAR(world.position(box).y, 0.5, 2e-3);
}

TYPED_TEST(Motion, DampingDecaysAsItSays) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.velocity = vec<D>(4, 0);
    d.angular_velocity = spin<D>(5);
    d.linear_damping = 0.7;
    d.angular_damping = 1.3;
    const BodyId<D> body = world.add_body(d);
    run(world, 120);
    EXPECT_NEAR(world.velocity(body).x, 4 * std::exp(-0.7 * 2), 1e-12);
    EXPECT_NEAR(world.position(body).x, 4 * (1 - std::exp(-0.7 * 2)) / 0.7, 1e-12);
    EXPECT_NEAR(spin_speed<D>(world.angular_velocity(body)), 5 * std::exp(-1.3 * 2), 1e-12);
    world.set_damping(body, 0, 0);
    const double speed = world.velocity(body).x;
    run(world, 60);
    EXPECT_EQ(world.velocity(body).x, speed);
}

/// In contact the decay is the same: a body slides without friction.
TYPED_TEST(Motion, DampingDecaysInContact) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    Material smooth;
    smooth.friction = 0;
    world.add_body(ground<D>(smooth));
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5), smooth);
    d.velocity = vec<D>(4, 0);
    d.linear_damping = 0.7;
    const BodyId<D> body = world.add_body(d);
    run(world, 120);
    EXPECT_NEAR(world.velocity(body).x, 4 * std::exp(-0.7 * 2), 1e-4);
    EXPECT_NEAR(world.position(body).x, 4 * (1 - std::exp(-0.7 * 2)) / 0.7, 0.01);
}

TYPED_TEST(Motion, ATransformCanBeSet) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5));
    d.shapes.push_back(shape_of<D>(Ball{0.2}));
    d.shapes[1].center = vec<D>(1, 0);
    const BodyId<D> body = world.add_body(d);
    run(world, 60);
    const Transform<D> there{vec<D>(5, 4), turn_about_z<D>(1.2)};
    world.set_velocity(body, vec<D>(1, 2));
    world.set_transform(body, there);
    EXPECT_LT(length(world.position(body) - there.position), 1e-15);
    EXPECT_EQ(world.rotation(body), normalized(there.rotation));
    EXPECT_EQ(world.velocity(body), vec<D>(1, 2)) << "the velocity stays";
    if constexpr (D == 2) {
        EXPECT_NEAR(world.angle(body), 1.2, 1e-15);
    }
    run(world, 6);
    EXPECT_NEAR(world.velocity(body).y, 2 - 0.981, 1e-12) << "nothing holds it there";
}

TEST(Angle, CountsWholeTurns) {
    for (const double speed : {0.3, 7.0, 100.0, 150.0, 400.0, -90.0, -150.0}) {
        World2 world(no_gravity<2>());
        BodyDefinition2 d = unit_body<2>();
        d.angular_velocity = speed;
        const BodyId2 body = world.add_body(d);
        run(world, 120);
        EXPECT_NEAR(world.angle(body), 2 * speed, 1e-9);
    }
}

}  // namespace
}  // namespace carom::test
