#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "carom/error.hpp"
#include "collision/random.hpp"
#include "world/builders.hpp"

// Ratchets, joints along a path and generic joints.

namespace carom::test {
namespace {

constexpr double pi = 3.14159265358979323846;

template <class T>
class MachineJoints : public testing::Test {};
TYPED_TEST_SUITE(MachineJoints, BothDimensions);

template <int D>
struct Machine {
    World<D> world;
    BodyId<D> body;
    JointId<D> joint;

    Machine(const WorldDefinition<D>& definition, const decltype(JointDefinition<D>::kind)& kind,
            const Vec<D>& at, const Vec<D>& velocity = {}, const Angular<D>& spin = {})
        : world(definition) {
        BodyDefinition<D> own = body_of<D>(cube<D>(0.4), at);
        own.velocity = velocity;
        own.angular_velocity = spin;
        own.mass = 2;
        body = world.add_body(own);
        JointDefinition<D> joined;
        joined.kind = kind;
        joined.b = body;
        joint = world.add_joint(joined);
    }
    void run(
        double seconds, const std::function<void()>& each = [] {}) {
        for (int i = 0; i < std::lround(seconds / frame_time); ++i) {
            world.step(frame_time);
            each();
        }
    }
};

TYPED_TEST(MachineJoints, ARatchetTurnsOneWay) {
    constexpr int D = TypeParam::value;
    for (const bool backward : {false, true}) {
        const double sign = backward ? -1 : 1;
        RatchetJoint<D> ratchet{.anchor = {}, .pitch = 0.25, .backward = backward};
        Machine<D> m(no_gravity<D>(), ratchet, {}, {}, spin<D>(3 * sign));
        m.run(1);
        EXPECT_NEAR(sign * m.world.coordinate(m.joint), 3, 1e-3) << "it turns freely forward";
        double least = 10;
        m.world.set_angular_velocity(m.body, spin<D>(-3 * sign));
        m.run(1, [&] { least = std::min(least, sign * m.world.coordinate(m.joint)); });
        EXPECT_NEAR(least, 3 - std::fmod(3, 0.25), 2e-3) << "the last tooth holds";
        EXPECT_NEAR(spin_speed<D>(m.world.angular_velocity(m.body)), 0, 1e-3);
        EXPECT_LT(m.world.angular_error(m.joint), 2e-3);
    }
}

TYPED_TEST(MachineJoints, ARatchetWithoutTeethHoldsAtOnceAndUnderLoad) {
    constexpr int D = TypeParam::value;
    Machine<D> m(sleepless<D>(), RatchetJoint<D>{.anchor = {}}, vec<D>(0.5, 0), {}, spin<D>(4));
    m.world.set_velocity(m.body, vec<D>(0, 2));
    double highest = 0;
    m.run(3, [&] { highest = std::max(highest, m.world.coordinate(m.joint)); });
    EXPECT_GT(highest, 0.2);
    EXPECT_NEAR(m.world.coordinate(m.joint), highest, 2e-3) << "it does not fall back";
    const double torque = 2 * 9.81 * 0.5 * std::cos(m.world.coordinate(m.joint));
    if constexpr (D == 2)
        EXPECT_NEAR(m.world.joint_torque(m.joint), torque, 0.01 * torque);
    else
        EXPECT_NEAR(m.world.joint_torque(m.joint).z, torque, 0.01 * torque);
}

/// Points of a circle about the origin.
template <int D>
std::vector<Vec<D>> ring(double radius, int count) {
    std::vector<Vec<D>> points;
    for (int i = 0; i < count; ++i)
        points.push_back(
            vec<D>(radius * std::cos(2 * pi * i / count), radius * std::sin(2 * pi * i / count)));
    return points;
}

TYPED_TEST(MachineJoints, APathIsFollowedAndTheSpeedKept) {
    constexpr int D = TypeParam::value;
    PathJoint<D> path{.points = ring<D>(2, 64), .loop = true};
    Machine<D> m(no_gravity<D>(), path, vec<D>(2, 0), vec<D>(0, 5));
    double worst = 0;
    m.run(10, [&] { worst = std::max(worst, m.world.linear_error(m.joint)); });
    EXPECT_LT(worst, 1e-3);
    EXPECT_NEAR(length(m.world.velocity(m.body)), 5, 0.05) << "the path does no work";
    EXPECT_NEAR(m.world.coordinate(m.joint), 50, 0.5) << "the way counts on from round to round";
    EXPECT_NEAR(m.world.coordinate_speed(m.joint), 5, 0.05);
    EXPECT_NEAR(length(m.world.center_of_mass(m.body)), 2, 5e-3);
    EXPECT_NEAR(length(m.world.joint_force(m.joint)), 2 * 25 / 2.0, 0.7) << "m v² / r";
}

TYPED_TEST(MachineJoints, APathMayBeStraightHaveCornersLimitsAndAMotor) {
    constexpr int D = TypeParam::value;
    PathJoint<D> path{.points = {vec<D>(0, 0), vec<D>(4, 0), vec<D>(4, 3)}, .smooth = false};
    path.motor = JointMotor{.speed = 1, .max = 200};
    Machine<D> m(sleepless<D>(), path, {});
    m.run(2);
    EXPECT_NEAR(m.world.coordinate(m.joint), 2, 0.02);
    EXPECT_LT(length(m.world.center_of_mass(m.body) - vec<D>(2, 0)), 0.02);
    m.run(6);
    EXPECT_NEAR(m.world.coordinate(m.joint), 7, 2e-3) << "it ends where the path does";
    EXPECT_LT(length(m.world.center_of_mass(m.body) - vec<D>(4, 3)), 5e-3);
}

/// A bead on a parabola y = x² / 2 R swings at the bottom like a pendulum of length R.
TYPED_TEST(MachineJoints, ABeadOnAWireSwingsAsItShould) {
    constexpr int D = TypeParam::value;
    constexpr double R = 2;
    PathJoint<D> path;
    for (int i = -10; i <= 10; ++i) path.points.push_back(vec<D>(0.1 * i, 0.01 * i * i / (2 * R)));
    Machine<D> m(sleepless<D>(), path, path.points[12]);
    const double start = m.world.energy().total();
    int crossings = 0;
    double last = 1, time = 0, first = 0, latest = 0, most = 0;
    m.run(20, [&] {
        time += frame_time;
        const double x = m.world.center_of_mass(m.body).x;
        if (last > 0 && x <= 0) {
            latest = time - frame_time * x / (x - last);
            if (crossings++ == 0) first = latest;
        }
        last = x;
        most = std::max(most, m.world.energy().total());
    });
    const double period = 2 * pi * std::sqrt(R / 9.81);
    ASSERT_GE(crossings, 6);
    EXPECT_NEAR((latest - first) / (crossings - 1), period, 0.01 * period);
    EXPECT_LT(most, start + 0.02 * 2 * 9.81 * 0.02);
}

TYPED_TEST(MachineJoints, AGenericJointLocksAllAtFirst) {
    constexpr int D = TypeParam::value;
    Machine<D> m(sleepless<D>(), GenericJoint<D>{.anchor = vec<D>(-0.5, 0)}, {});
    m.run(2);
    EXPECT_LT(m.world.linear_error(m.joint), 1e-4);
    EXPECT_LT(m.world.angular_error(m.joint), 1e-4);
    EXPECT_NEAR(m.world.joint_force(m.joint).y, 2 * 9.81, 0.02);
}

TYPED_TEST(MachineJoints, AGenericJointIsAHingeASliderAndASpring) {
    constexpr int D = TypeParam::value;
    constexpr int about_z = D == 2 ? 0 : 2;
    {
        GenericJoint<D> hinge{.anchor = {}};
        hinge.turns[about_z].limits.reset();
        Machine<D> m(sleepless<D>(), hinge, vec<D>(1, 0));
        HingeJoint<D> own{.anchor = {}};
        Machine<D> other(sleepless<D>(), own, vec<D>(1, 0));
        double apart = 0, worst = 0;
        m.run(3, [&] {
            other.world.step(frame_time);
            apart = std::max(apart,
                             length(m.world.center_of_mass(m.body) - other.world.center_of_mass(other.body)));
            worst = std::max({worst, m.world.linear_error(m.joint), m.world.angular_error(m.joint)});
        });
        EXPECT_LT(apart, 0.01);
        EXPECT_LT(worst, 1e-3);
    }
    {
        GenericJoint<D> slider{.anchor = {}};
        slider.ways[0].limits = JointLimits{-1, 0.5};
        slider.ways[0].motor = JointMotor{.speed = 1, .max = 100};
        Machine<D> m(sleepless<D>(), slider, {});
        m.run(0.25);
        EXPECT_NEAR(m.world.coordinate(m.joint), 0.25, 0.01);
        m.run(1);
        EXPECT_NEAR(m.world.coordinate(m.joint), 0.5, 1e-3);
        EXPECT_LT(m.world.linear_error(m.joint), 1e-3);
    }
    {
        GenericJoint<D> strut{.anchor = {}};
        strut.ways[1].limits.reset();
        strut.ways[1].spring = JointSpring{.frequency = 1, .damping_ratio = 0.2, .rest = 0};
        Machine<D> m(no_gravity<D>(), strut, {}, vec<D>(0, 1));
        const double w = 2 * pi, damped = w * std::sqrt(1 - 0.04);
        double worst = 0, time = 0;
        m.run(2, [&] {
            time += frame_time;
            const double exact = std::exp(-0.2 * w * time) * std::sin(damped * time) / damped;
            worst = std::max(worst, std::fabs(m.world.center_of_mass(m.body).y - exact));
        });
        EXPECT_LT(worst, 1e-3);
    }
}

TEST(GenericJoints, KeepTheTurnsInSpaceWithinTheirLimits) {
    Random random(3);
    for (int i = 0; i < 20; ++i) {
        GenericJoint<3> joint{.anchor = {}};
        for (JointAxis& turn : joint.turns) turn.limits = JointLimits{-0.6, 0.6};
        Machine<3> m(no_gravity<3>(), joint, {}, {}, 4 * random.direction<3>());
        double worst = 0;
        m.run(2, [&] { worst = std::max(worst, m.world.angular_error(m.joint)); });
        EXPECT_LT(worst, 5e-3) << i;
    }
}

TYPED_TEST(MachineJoints, KeepMomentum) {
    constexpr int D = TypeParam::value;
    const GenericJoint<D> generic{.anchor = vec<D>(0.5, 0)};
    const RatchetJoint<D> ratchet{.anchor = vec<D>(0.5, 0), .pitch = 0.1};
    const PathJoint<D> path{.points = {vec<D>(0, 0), vec<D>(1, 0.2), vec<D>(2, 1)}};
    for (const decltype(JointDefinition<D>::kind)& kind :
         {decltype(JointDefinition<D>::kind)(generic), decltype(JointDefinition<D>::kind)(ratchet),
          decltype(JointDefinition<D>::kind)(path)}) {
        World<D> world(no_gravity<D>());
        BodyDefinition<D> a = body_of<D>(cube<D>(0.4), {}), b = body_of<D>(cube<D>(0.4), vec<D>(1, 0.2));
        a.mass = 1;
        b.mass = 3;
        a.angular_velocity = spin<D>(2);
        b.velocity = vec<D>(0.5, -1);
        JointDefinition<D> joint;
        joint.a = world.add_body(a);
        joint.b = world.add_body(b);
        joint.kind = kind;
        world.add_joint(joint);
        const auto momentum = [&] { return world.velocity(*joint.a) + 3.0 * world.velocity(joint.b); };
        const Vec<D> before = momentum();
        for (int i = 0; i < 120; ++i) world.step(frame_time);
        EXPECT_LT(length(momentum() - before), 1e-4);  // of 3.4 kg m/s
    }
}

TYPED_TEST(MachineJoints, RefuseWhatMakesNoSense) {
    constexpr int D = TypeParam::value;
    World<D> world;
    JointDefinition<D> joint;
    joint.b = world.add_body(body_of<D>(cube<D>(1)));
    const auto message = [&](const auto& kind) -> std::string {
        joint.kind = kind;
        try {
            world.add_joint(joint);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(RatchetJoint<D>{.pitch = -1}), "pitch: -1 is negative");
    EXPECT_EQ(message(PathJoint<D>{.points = {Vec<D>{}}}), "points: there are fewer than two");
    EXPECT_EQ(message(PathJoint<D>{.points = {Vec<D>{}, Vec<D>{}}}), "points: two neighbours are the same");
    EXPECT_NE(message(GenericJoint<D>{.axis = {}}).find("axis"), std::string::npos);
}

}  // namespace
}  // namespace carom::test
