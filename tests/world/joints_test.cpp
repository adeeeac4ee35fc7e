#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "world/builders.hpp"

// What joints hold, how they swing, and that they push both bodies alike.

namespace carom::test {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
JointDefinition<D> joint_of(const decltype(JointDefinition<D>::kind)& kind, std::optional<BodyId<D>> a,
                            BodyId<D> b) {
    JointDefinition<D> joint;
    joint.kind = kind;
    joint.a = a;
    joint.b = b;
    return joint;
}

/// An axis in the direction of x, in 3D; hinges turn about z.
template <int D>
Vec<D> x_axis() {
    return vec<D>(1, 0);
}

/// One joint of each kind that holds something, at a point.
template <int D>
std::vector<std::pair<std::string, decltype(JointDefinition<D>::kind)>> holding_kinds(const Vec<D>& anchor) {
    return {
        {"hinge", HingeJoint<D>{.anchor = anchor}},
        {"slider", SliderJoint<D>{.anchor = anchor, .axis = x_axis<D>(), .limits = JointLimits{-0.1, 0.1}}},
        {"ball", BallJoint<D>{.anchor = anchor}},
        {"weld", WeldJoint<D>{.anchor = anchor}},
        {"distance", DistanceJoint<D>{}},
        {"rope", DistanceJoint<D>{.limits = JointLimits{0, 1.0}}},
        {"wheel", WheelJoint<D>{.anchor = anchor, .limits = JointLimits{-0.05, 0.05}}},
        {"limited hinge", HingeJoint<D>{.anchor = anchor, .limits = JointLimits{-0.3, 0.3}}}};
}

template <class T>
class Joints : public testing::Test {};
TYPED_TEST_SUITE(Joints, BothDimensions);

/// Two boxes of 1 m, of which the first hangs from the world by a joint and the second from the first.
TYPED_TEST(Joints, HoldWithinAMillimetreAndATenthOfADegree) {
    constexpr int D = TypeParam::value;
    for (const auto& [name, ignored] : holding_kinds<D>({})) {
        SCOPED_TRACE(name);
        const auto kind_at = [&, n = name](const Vec<D>& anchor) {
            for (const auto& [other, kind] : holding_kinds<D>(anchor))
                if (other == n) return kind;
            return ignored;
        };
        World<D> world(sleepless<D>());
        BodyDefinition<D> anchor_body = body_of<D>(cube<D>(0.2), vec<D>(0, 2));
        anchor_body.type = BodyType::fixed;
        const BodyId<D> top = world.add_body(anchor_body);
        const BodyId<D> first = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0.3, 1.2)));
        const BodyId<D> second = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0.3, 0.4)));
        const JointId<D> upper = world.add_joint(joint_of<D>(kind_at(vec<D>(0, 2)), top, first));
        const JointId<D> lower = world.add_joint(joint_of<D>(kind_at(vec<D>(0.3, 0.8)), first, second));
        double linear = 0, angular = 0;
        for (int i = 0; i < 600; ++i) {
            world.step(frame_time);
            if (i < 30) continue;  // ropes fall into place
            for (const JointId<D> joint : {upper, lower}) {
                linear = std::max(linear, world.linear_error(joint));
                angular = std::max(angular, world.angular_error(joint));
            }
        }
        EXPECT_LT(linear, 1e-3);
        EXPECT_LT(angular, 0.1 * pi / 180);
        EXPECT_GT(world.position(second).y, -1);
    }
}

/// In empty space, momentum and angular momentum stay what they are, whatever holds the bodies.
TYPED_TEST(Joints, KeepMomentum) {
    constexpr int D = TypeParam::value;
    for (const auto& [name, kind] : holding_kinds<D>(vec<D>(0, 0))) {
        SCOPED_TRACE(name);
        World<D> world(no_gravity<D>());
        BodyDefinition<D> one = body_of<D>(cube<D>(0.5), vec<D>(-0.5, 0));
        one.velocity = vec<D>(0.3, 1, 0.2);
        one.angular_velocity = spin<D>(2);
        BodyDefinition<D> two = body_of<D>(cube<D>(0.7), vec<D>(0.5, 0.1));
        two.velocity = vec<D>(-0.5, 0.4);
        const BodyId<D> a = world.add_body(one), b = world.add_body(two);
        world.add_joint(joint_of<D>(kind, a, b));
        const auto momentum = [&] {
            return world.mass_properties(a).mass * world.velocity(a) +
                   world.mass_properties(b).mass * world.velocity(b);
        };
        const auto angular_momentum = [&] {
            double sum = 0;
            for (const BodyId<D> body : {a, b}) {
                const auto m = world.mass_properties(body);
                const Vec<D> x = world.center_of_mass(body), v = world.velocity(body);
                sum += m.mass * (x.x * v.y - x.y * v.x);
                if constexpr (D == 2)
                    sum += m.inertia * world.angular_velocity(body);
                else
                    sum += (m.inertia * world.angular_velocity(body)).z;
            }
            return sum;
        };
        const Vec<D> p = momentum();
        const double l = angular_momentum();
        run(world, 300);
        EXPECT_LT(length(momentum() - p), 1e-4 * length(p));
        // The cubes of space have the same inertia about every axis. The first blow, by which the joint takes
        // hold of bodies that part, moves them while they move, which costs some.
        EXPECT_NEAR(angular_momentum(), l, 3e-2 * std::fabs(l));
    }
}

TYPED_TEST(Joints, PendulumKeepsItsPeriodAndEnergy) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    BodyDefinition<D> bob = body_of<D>(Ball{0.1}, vec<D>(1, 0));
    bob.mass = 1;
    const BodyId<D> body = world.add_body(bob);
    const JointId<D> joint = world.add_joint(joint_of<D>(HingeJoint<D>{.anchor = vec<D>(0, 0)}, {}, body));
    double inertia;
    if constexpr (D == 2)
        inertia = world.mass_properties(body).inertia;
    else
        inertia = world.mass_properties(body).inertia.zz;
    const double start = world.energy().total();
    double before = 1, first = 0, last = 0;
    int crossings = 0;
    for (int i = 0; i < 900; ++i) {
        world.step(frame_time);
        const double x = world.position(body).x;
        if (x * before < 0) {
            const double t = world.time() - frame_time * x / (x - before);
            if (crossings++ == 0) first = t;
            last = t;
        }
        before = x;
        EXPECT_LT(world.linear_error(joint), 1e-4);
    }
    const double period = 2 * (last - first) / (crossings - 1);
    // From the horizontal: 1.180340599 of the period of small swings.
    EXPECT_NEAR(period, 2 * pi * std::sqrt((1 + inertia) / 9.81) * 1.180340599, 2e-4 * period);
    EXPECT_NEAR(world.energy().total(), start, 1e-3 * 9.81);
}

TYPED_TEST(Joints, MotorReachesItsSpeedWithItsTorque) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> wheel = body_of<D>(Ball{0.5});
    wheel.mass = 2;
    const BodyId<D> body = world.add_body(wheel);
    double inertia;
    if constexpr (D == 2)
        inertia = world.mass_properties(body).inertia;
    else
        inertia = world.mass_properties(body).inertia.zz;
    const JointMotor motor{.speed = 10, .max = 4 * inertia};  // 4 rad/s²
    const JointId<D> joint = world.add_joint(joint_of<D>(HingeJoint<D>{.motor = motor}, {}, body));
    run(world, 60);
    EXPECT_NEAR(world.coordinate_speed(joint), 4, 1e-3);
    EXPECT_NEAR(spin_speed<D>(world.joint_torque(joint)), motor.max, 1e-4 * motor.max);
    run(world, 180);
    EXPECT_NEAR(world.coordinate_speed(joint), 10, 1e-4);
    // 2.5 s of speeding up, and 1.5 s at full speed: the angle winds on beyond ±π.
    EXPECT_NEAR(world.coordinate(joint), 0.5 * 4 * 2.5 * 2.5 + 10 * 1.5, 0.02);
}

/// A mass on a spring, let go a metre away: x(1 s) of the closed form.
TYPED_TEST(Joints, SpringsFollowTheirClosedForm) {
    constexpr int D = TypeParam::value;
    constexpr std::pair<double, double> known[] = {
        {0, -0.839071529}, {0.05, -0.529208819}, {0.2, -0.136092048}, {0.5, -0.002170117}, {1, 0.000499399}};
    for (const auto& [damping_ratio, reference] : known) {
        SCOPED_TRACE(damping_ratio);
        const JointSpring spring{.frequency = 10 / (2 * pi), .damping_ratio = damping_ratio, .rest = 0.0};
        const decltype(JointDefinition<D>::kind) kinds[] = {
            SliderJoint<D>{.anchor = {}, .spring = spring},
            TargetJoint<D>{.anchor = {}, .frequency = spring.frequency, .damping_ratio = damping_ratio},
            DistanceJoint<D>{
                .anchor_a = vec<D>(-3, 0),
                .spring = JointSpring{.frequency = spring.frequency, .damping_ratio = damping_ratio}}};
        for (const auto& kind : kinds) {
            World<D> world(no_gravity<D>());
            const BodyId<D> body = world.add_body(body_of<D>(cube<D>(1)));
            world.add_joint(joint_of<D>(kind, {}, body));
            world.set_transform(body, {vec<D>(1, 0), {}});
            run(world, 60);
            EXPECT_NEAR(world.position(body).x, reference, 2e-3) << kind.index();
        }
    }
}

/// The frequency of a spring is that of what swings at the joint: a rod about its end.
TYPED_TEST(Joints, HingeSpringSwingsAtItsFrequency) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> rod = body_of<D>(cube<D>(0.3), vec<D>(0.5, 0));
    const BodyId<D> body = world.add_body(rod);
    const JointId<D> joint = world.add_joint(
        joint_of<D>(HingeJoint<D>{.spring = JointSpring{.frequency = 1, .rest = 0.2}}, {}, body));
    run(world, 30);  // half a period
    EXPECT_NEAR(world.coordinate(joint), 0.4, 2e-3);
    run(world, 30);
    EXPECT_NEAR(world.coordinate(joint), 0, 2e-3);
}

TYPED_TEST(Joints, LimitsStopWhereTheyAre) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> body = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0.5, 0)));
    const JointId<D> joint =
        world.add_joint(joint_of<D>(HingeJoint<D>{.limits = JointLimits{-0.6, 0.25}}, {}, body));
    run(world, 120);
    EXPECT_NEAR(world.coordinate(joint), -0.6, 1e-3);
    EXPECT_LT(world.angular_error(joint), 1e-3);
    world.set_limits(joint, JointLimits{-4.0 * pi, 0.25});
    world.set_motor(joint, JointMotor{.speed = -8, .max = 1e6});
    run(world, 150);
    EXPECT_NEAR(world.coordinate(joint), -4 * pi, 1e-2);
}

TYPED_TEST(Joints, BreakAndTellOfIt) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> weight = body_of<D>(cube<D>(0.4), vec<D>(0, -1));
    weight.mass = 10;
    const BodyId<D> body = world.add_body(weight);
    JointDefinition<D> strong = joint_of<D>(DistanceJoint<D>{.anchor_a = vec<D>(0, 0)}, {}, body);
    strong.break_force = 99;
    const JointId<D> joint = world.add_joint(strong);
    run(world, 60);
    ASSERT_TRUE(world.contains(joint));
    EXPECT_NEAR(length(world.joint_force(joint)), 98.1, 0.1);
    world.apply_impulse(body, vec<D>(0, -5));
    world.step(frame_time);
    EXPECT_FALSE(world.contains(joint));
    ASSERT_EQ(world.joint_breaks().size(), 1u);
    EXPECT_EQ(world.joint_breaks()[0].joint, joint);
    EXPECT_GT(world.joint_breaks()[0].force, 99);
    run(world, 60);
    EXPECT_LT(world.position(body).y, -3);
}

TYPED_TEST(Joints, JoinIslandsAndWake) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> a = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0, -0.5)));
    const BodyId<D> b = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0, -1.5)));
    const JointId<D> top = world.add_joint(joint_of<D>(HingeJoint<D>{.anchor = vec<D>(0, 0)}, {}, a));
    world.add_joint(joint_of<D>(HingeJoint<D>{.anchor = vec<D>(0, -1)}, a, b));
    run(world, 120);
    EXPECT_FALSE(world.awake(a) || world.awake(b));
    world.apply_impulse(b, vec<D>(0.5, 0));
    world.step(frame_time);
    EXPECT_TRUE(world.awake(a) && world.awake(b));
    run(world, 600);
    world.put_to_sleep(a);
    world.put_to_sleep(b);
    world.remove_joint(top);
    run(world, 30);
    EXPECT_LT(world.position(a).y, -0.6);
    EXPECT_EQ(world.counts().joints, 1);
    world.remove_body(a);
    EXPECT_EQ(world.counts().joints, 0);
}

TYPED_TEST(Joints, KeepTheirBodiesFromTouching) {
    constexpr int D = TypeParam::value;
    for (const bool collide : {false, true}) {
        World<D> world(no_gravity<D>());
        const BodyId<D> a = world.add_body(body_of<D>(cube<D>(1)));
        const BodyId<D> b = world.add_body(body_of<D>(cube<D>(1), vec<D>(0.8, 0)));
        JointDefinition<D> joint = joint_of<D>(SliderJoint<D>{.anchor = {}}, a, b);
        joint.collide = collide;
        const JointId<D> id = world.add_joint(joint);
        run(world, 60);
        EXPECT_EQ(world.counts().contacts > 0 || world.coordinate(id) > 0.05, collide);
        world.remove_joint(id);
        run(world, 60);
        EXPECT_GT(length(world.position(b) - world.position(a)), 0.95);
    }
}

TYPED_TEST(Joints, PulleyBalancesItsWeights) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> heavy = body_of<D>(cube<D>(0.2), vec<D>(-1, 0)),
                      light = body_of<D>(cube<D>(0.2), vec<D>(1, 0));
    heavy.mass = 2;
    light.mass = 1;
    const BodyId<D> a = world.add_body(heavy), b = world.add_body(light);
    const JointId<D> rope = world.add_joint(
        joint_of<D>(PulleyJoint<D>{.ground_a = vec<D>(-1, 6), .ground_b = vec<D>(1, 6)}, a, b));
    run(world, 60);
    EXPECT_NEAR(world.velocity(a).y, -3.27, 1e-3);
    EXPECT_NEAR(world.velocity(b).y, 3.27, 1e-3);
    EXPECT_NEAR(length(world.joint_force(rope)), 13.08, 1e-2);
    EXPECT_LT(world.linear_error(rope), 1e-3);
}

TYPED_TEST(Joints, GearsShareTheirTorque) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> a = world.add_body(body_of<D>(Ball{0.5})),
                    b = world.add_body(body_of<D>(Ball{0.3}, vec<D>(2, 0)));
    const auto inertia = [&](BodyId<D> body) {
        if constexpr (D == 2)
            return world.mass_properties(body).inertia;
        else
            return world.mass_properties(body).inertia.zz;
    };
    const JointId<D> first = world.add_joint(joint_of<D>(HingeJoint<D>{.anchor = {}}, {}, a));
    const JointId<D> second = world.add_joint(joint_of<D>(HingeJoint<D>{.anchor = vec<D>(2, 0)}, {}, b));
    constexpr double ratio = 3;
    JointDefinition<D> gear;
    gear.kind = GearJoint<D>{.joint_a = first, .joint_b = second, .ratio = ratio};
    const JointId<D> id = world.add_joint(gear);
    const double torque = 100;
    for (int i = 0; i < 60; ++i) {
        world.apply_torque(a, spin<D>(torque));
        world.step(frame_time);
    }
    const double speed = torque / (inertia(a) + ratio * ratio * inertia(b));
    EXPECT_NEAR(world.coordinate_speed(first), speed, 1e-3 * speed);
    EXPECT_NEAR(world.coordinate_speed(second), -ratio * speed, 1e-3 * ratio * speed);
    EXPECT_LT(world.angular_error(id), 1e-3);
    world.remove_joint(first);
    EXPECT_FALSE(world.contains(id));
}

TYPED_TEST(Joints, RackMovesWithItsPinion) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> pinion = world.add_body(body_of<D>(Ball{0.5})),
                    rack = world.add_body(body_of<D>(cube<D>(0.4), vec<D>(0, -1)));
    const JointId<D> hinge = world.add_joint(
        joint_of<D>(HingeJoint<D>{.anchor = {}, .motor = JointMotor{.speed = 2}}, {}, pinion));
    const JointId<D> slider = world.add_joint(joint_of<D>(SliderJoint<D>{.anchor = vec<D>(0, -1)}, {}, rack));
    JointDefinition<D> coupling;
    coupling.kind = RackJoint<D>{.joint_a = hinge, .joint_b = slider, .ratio = 0.5};
    const JointId<D> id = world.add_joint(coupling);
    run(world, 120);
    EXPECT_NEAR(world.position(rack).x, 0.5 * world.coordinate(hinge), 1e-3);
    EXPECT_NEAR(world.velocity(rack).x, 1, 1e-3);
    EXPECT_LT(world.linear_error(id), 1e-3);
}

TYPED_TEST(Joints, MotorAndTargetBringBodiesToTheirPlaces) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> hanging = body_of<D>(cube<D>(0.5));
    hanging.angular_damping = 3;
    const BodyId<D> a = world.add_body(hanging), b = world.add_body(body_of<D>(cube<D>(0.5), vec<D>(3, 0)));
    const JointId<D> drag = world.add_joint(joint_of<D>(TargetJoint<D>{.anchor = vec<D>(0, 0.25)}, {}, a));
    world.add_joint(
        joint_of<D>(MotorJoint<D>{.position = vec<D>(2, 1), .rotation = turn_about_z<D>(0.5)}, {}, b));
    world.set_target(drag, vec<D>(1, 2));
    run(world, 1200);
    // A spring of f Hz gives way by g / (2 π f)².
    const double sag = 9.81 / (4 * pi * pi * 25);
    EXPECT_LT(length(world.position(a) - vec<D>(1, 1.75 - sag)), 2e-3);
    EXPECT_LT(length(world.position(b) - vec<D>(2, 1 - sag)), 2e-3);
    EXPECT_NEAR(rotate(world.rotation(b), x_axis<D>()).y, std::sin(0.5), 1e-3);
}

TEST(JointsInSpace, BallStaysWithinItsCone) {
    World3 world;
    const BodyId3 body = world.add_body(body_of<3>(Capsule3{{0, 0, 0}, {0.8, 0, 0}, 0.1}));
    BallJoint<3> ball{.axis = {1, 0, 0}, .swing_limit = 0.5, .twist_limits = JointLimits{-0.4, 0.4}};
    world.add_joint(joint_of<3>(ball, {}, body));
    world.set_angular_velocity(body, {3, 1, 0});
    for (int i = 0; i < 300; ++i) {
        world.step(frame_time);
        const Rotation3 q = world.rotation(body);
        const double swing = std::acos(std::min(1.0, rotate(q, Vec3{1, 0, 0}).x));
        EXPECT_LT(swing, 0.52);
        EXPECT_LT(std::fabs(2 * std::atan2(q.x, q.w)), 0.42);
    }
    EXPECT_NEAR(rotate(world.rotation(body), Vec3{1, 0, 0}).x, std::cos(0.5), 2e-3);
}

TEST(JointsInSpace, WheelIsSteeredAndSprung) {
    World3 world;
    BodyDefinition3 chassis = body_of<3>(cube<3>(1));
    chassis.type = BodyType::fixed;
    const BodyId3 a = world.add_body(chassis), b = world.add_body(body_of<3>(Ball{0.4}, {0, -1, 0}));
    WheelJoint<3> wheel{.anchor = {0, -1, 0},
                        .spring = JointSpring{.frequency = 2, .damping_ratio = 0.7},
                        .motor = JointMotor{.speed = 5, .max = 1e4},
                        .steering = JointMotor{.target = 0.5, .frequency = 4}};
    const JointId3 joint = world.add_joint(joint_of<3>(wheel, a, b));
    run(world, 300);
    EXPECT_NEAR(world.coordinate(joint), -9.81 / (16 * pi * pi), 2e-3);
    // The axis of the wheel, which was z, has turned about y.
    const Vec3 spin = world.angular_velocity(b);
    EXPECT_NEAR(length(spin), 5, 0.01);
    EXPECT_NEAR(std::atan2(spin.x, spin.z), 0.5, 5e-3);
    EXPECT_LT(world.angular_error(joint), 1e-3);
}

TYPED_TEST(Joints, RefuseWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> a = world.add_body(body_of<D>(cube<D>(1))), b = world.add_body(body_of<D>(cube<D>(1)));
    BodyDefinition<D> fixed = body_of<D>(cube<D>(1));
    fixed.type = BodyType::fixed;
    const BodyId<D> floor = world.add_body(fixed);
    const auto message = [&](const JointDefinition<D>& joint) -> std::string {
        try {
            world.add_joint(joint);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    using Kind = decltype(JointDefinition<D>::kind);
    const auto refusal = [&](const Kind& kind) { return message(joint_of<D>(kind, a, b)); };
    EXPECT_EQ(message(joint_of<D>(HingeJoint<D>{}, a, a)), "a: a body is not joined to itself");
    EXPECT_EQ(message(joint_of<D>(HingeJoint<D>{}, {}, floor)), "b: one of the two bodies has to be dynamic");
    EXPECT_EQ(refusal(HingeJoint<D>{.limits = JointLimits{1, -1}}),
              "limits: 1 as the lower limit is above the upper one, -1");
    EXPECT_EQ(refusal(HingeJoint<D>{.motor = JointMotor{.max = -1}}),
              "motor.max: -1 is negative or not a number");
    EXPECT_EQ(refusal(SliderJoint<D>{.axis = {}}), "axis: the zero vector has no direction");
    EXPECT_EQ(refusal(SliderJoint<D>{.spring = JointSpring{.frequency = 0}}),
              "spring.frequency: 0 is not positive");
    EXPECT_EQ(refusal(DistanceJoint<D>{.length = -2.0}), "length: -2 is negative");
    EXPECT_EQ(refusal(PulleyJoint<D>{.ratio = 0}), "ratio: 0 is not positive");
    EXPECT_NE(refusal(GearJoint<D>{}), "");
    EXPECT_EQ(world.counts().joints, 0);
    const JointId<D> hinge = world.add_joint(joint_of<D>(HingeJoint<D>{}, a, b));
    EXPECT_THROW(world.set_joint(hinge, SliderJoint<D>{}), Error);
    EXPECT_THROW(world.set_target(hinge, {}), Error);
    world.remove_joint(hinge);
    EXPECT_THROW(world.remove_joint(hinge), Error);
}

}  // namespace
}  // namespace carom::test
