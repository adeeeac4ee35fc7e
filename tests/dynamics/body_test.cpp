#include "dynamics/body.hpp"

#include <gtest/gtest.h>

#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// A random tensor that a body can have: principal moments that fulfil the triangle inequality, turned.
Symmetric3<double> random_inertia(Random& random) {
    const double a = random.between(0.1, 2), b = random.between(0.1, 2), c = random.between(0.1, 2);
    return rotated(diagonal(b + c, a + c, a + b), random.rotation<3>());
}

BodyMass<3> mass_with(const Symmetric3<double>& inertia, const Locks& locks = {}) {
    BodyMass<3> m;
    m.mass = m.inverse_mass = 1;
    m.inertia = inertia;
    m.inverse_inertia = inverse(inertia);
    m.isotropic = false;
    m.locks = locks;
    return m;
}

TEST(Turn, CountsWholeTurnsInThePlane) {
    Random random(1);
    BodyState<2> state;
    double angle = 0;
    for (int i = 0; i < 5000; ++i) {
        const double step = i % 10 == 0 ? random.between(-40, 40) : random.between(-3, 3);
        turn<2>(state, step);
        angle += step;
        ASSERT_NEAR(whole_angle(state), angle, 1e-9) << "after " << i << " turns";
    }
}

TEST(Turn, CountsASlowTurnAcrossTheCutBothWays) {
    BodyState<2> state;
    for (int i = 0; i < 7000; ++i) turn<2>(state, 1e-3);
    EXPECT_NEAR(whole_angle(state), 7, 1e-9);
    for (int i = 0; i < 14000; ++i) turn<2>(state, -1e-3);
    EXPECT_NEAR(whole_angle(state), -7, 1e-9);
}

TEST(Turn, GoesAboutTheRotationVectorInSpace) {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        BodyState<3> state;
        state.rotation = random.rotation<3>();
        const Vec3 axis = random.direction<3>();
        const double angle = random.between(-6, 6);
        const Rotation3 expected = Rotation3::from_axis_angle(axis, angle) * state.rotation;
        turn<3>(state, angle * axis);
        const Vec3 v = random.direction<3>();
        ASSERT_LT(length(rotate(state.rotation, v) - rotate(expected, v)), 1e-14);
    }
}

TEST(WorldInverseInertia, FollowsTheRotation) {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const BodyMass<3> m = mass_with(random_inertia(random));
        const Rotation3 q = random.rotation<3>();
        const Vec3 spin = random.in_cube<3>(3);
        const Vec3 momentum = rotate(q, m.inertia * unrotate(q, spin));
        ASSERT_LT(length(world_inverse_inertia<3>(m, q) * momentum - spin), 1e-12);
    }
}

/// What locks mean: there is a torque about the locked axes, and only about them, that keeps the spin about
/// them at zero. So I ω − L is zero along the free axes, where ω is what the inverse makes of L.
TEST(WorldInverseInertia, LeavesLockedAxesOut) {
    Random random(4);
    for (int i = 0; i < 400; ++i) {
        const Locks locks{false, false, false, (i & 1) != 0, (i & 2) != 0, (i & 4) != 0};
        const BodyMass<3> m = mass_with(random_inertia(random), locks);
        const Rotation3 q = random.rotation<3>();
        const Vec3 momentum = random.in_cube<3>(3);
        const Vec3 spin = world_inverse_inertia<3>(m, q) * momentum;
        const Vec3 rest = rotate(q, m.inertia * unrotate(q, spin)) - momentum;
        const bool locked[] = {locks.rx, locks.ry, locks.rz};
        for (int axis = 0; axis < 3; ++axis) ASSERT_NEAR(locked[axis] ? spin[axis] : rest[axis], 0, 1e-12);
    }
}

TEST(WorldInverseInertia, IsZeroInThePlaneWhenLocked) {
    BodyMass<2> m;
    m.inverse_mass = 1;
    m.inverse_inertia = 0.25;
    EXPECT_EQ(world_inverse_inertia<2>(m, {}), 0.25);
    m.locks.rz = true;
    EXPECT_EQ(world_inverse_inertia<2>(m, {}), 0);
}

TEST(Frame, IsWhereTheCentreOfMassSaysItIs) {
    Random random(5);
    for (int i = 0; i < 50; ++i) {
        BodyState<3> state;
        state.position = random.in_cube<3>(10);
        state.rotation = random.rotation<3>();
        BodyMass<3> mass;
        mass.center = random.in_cube<3>(2);
        ASSERT_LT(length(apply(frame(state, mass), mass.center) - state.position), 1e-14);
    }
}

/// The energy of many points that move with the body.
TEST(KineticEnergy, IsThatOfTheBodysParts) {
    Random random(6);
    BodyState<3> state;
    state.rotation = random.rotation<3>();
    state.velocity = random.in_cube<3>(2);
    state.angular_velocity = random.in_cube<3>(2);
    BodyMass<3> mass;
    double expected = 0;
    std::vector<Vec3> points;
    for (int i = 0; i < 20; ++i) points.push_back(random.in_cube<3>(1));
    Vec3 center{};
    for (const Vec3& p : points) center += p / 20;
    for (const Vec3& p : points) {
        const Vec3 arm = p - center;
        mass.mass += 1;
        mass.inertia = mass.inertia + steiner(1.0, arm);
        const Vec3 v = state.velocity + cross(state.angular_velocity, rotate(state.rotation, arm));
        expected += 0.5 * dot(v, v);
    }
    EXPECT_NEAR(kinetic_energy(state, mass), expected, 1e-12 * expected);
}

TEST(Locks, StripTheirComponents) {
    EXPECT_EQ(free_components<2>({true, false}, {1, 2}), (Vec2{0, 2}));
    EXPECT_EQ(free_components<2>({false, true}, {1, 2}), (Vec2{1, 0}));
    EXPECT_EQ(free_components<3>({false, false, true}, {1, 2, 3}), (Vec3{1, 2, 0}));
    const Locks turns{false, false, false, true, false, true};
    EXPECT_EQ(free_spin<3>(turns, {1, 2, 3}), (Vec3{0, 2, 0}));
    EXPECT_EQ(free_spin<2>(turns, 4.0), 0);
    EXPECT_EQ(free_spin<2>({true, true, true, true, true, false}, 4.0), 4);
}

}  // namespace
}  // namespace carom::detail
