#include <gtest/gtest.h>

#include <cstdio>

#include "world/builders.hpp"

// How far joints give way that carry a load, swing and are struck: each type that holds two bodies in a row,
// of equal mass, and with one that is ten and a hundred times the other.

// GCC 12 takes the values of empty optionals, which a variant moves along, for uninitialised reads.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace carom::test {
namespace {

template <int D>
using Kind = decltype(JointDefinition<D>::kind);

/// Where the second of two bodies in a row hangs on the first; the first is on the world by the same type.
template <int D>
Kind<D> joint_of(const std::string& type, const Vec<D>& anchor) {
    if (type == "hinge") return HingeJoint<D>{.anchor = anchor};
    if (type == "hinge with limits") return HingeJoint<D>{.anchor = anchor, .limits = JointLimits{-0.4, 0.4}};
    if (type == "slider") return SliderJoint<D>{.anchor = anchor, .limits = JointLimits{-0.1, 0.1}};
    if (type == "ball") return BallJoint<D>{.anchor = anchor};
    if (type == "weld") return WeldJoint<D>{.anchor = anchor};
    if (type == "ratchet") return RatchetJoint<D>{.anchor = anchor};
    if (type == "wheel") {
        WheelJoint<D> wheel{.anchor = anchor, .limits = JointLimits{-0.1, 0.1}};
        wheel.spring = JointSpring{.frequency = 3, .damping_ratio = 0.5};
        return wheel;
    }
    GenericJoint<D> generic;  // all locked
    generic.anchor = anchor;
    return generic;
}

struct Drift {
    double place = 0, angle = 0;  ///< the worst within ten seconds, m and rad
    double place_at_last = 0, angle_at_last = 0;
};

/// Two bodies in a row, let go from level; from the first, at 3 s, a blow of 1 m/s against the second.
template <int D>
Drift drift(const std::string& type, double ratio) {
    World<D> world(sleepless<D>());
    std::optional<BodyId<D>> before;
    std::vector<JointId<D>> joints;
    BodyId<D> last{};
    for (int i = 0; i < 2; ++i) {
        BodyDefinition<D> body = body_of<D>(Box<D>{vec<D>(0.5, 0.2, 0.2)}, vec<D>(0.5 * i + 0.25, 0));
        body.mass = i == 0 ? 1 : ratio;
        last = world.add_body(body);
        JointDefinition<D> joint;
        joint.a = before;
        joint.b = last;
        joint.kind = joint_of<D>(type, vec<D>(0.5 * i, 0));
        joints.push_back(world.add_joint(joint));
        before = last;
    }
    Drift worst;
    for (int i = 0; i < 600; ++i) {
        if (i == 180) world.apply_impulse(last, ratio * vec<D>(0.6, 0.8, 0.2));
        world.step(frame_time);
        worst.place_at_last = worst.angle_at_last = 0;
        for (const JointId<D> joint : joints) {
            worst.place_at_last = std::max(worst.place_at_last, world.linear_error(joint));
            worst.angle_at_last = std::max(worst.angle_at_last, world.angular_error(joint));
        }
        worst.place = std::max(worst.place, worst.place_at_last);
        worst.angle = std::max(worst.angle, worst.angle_at_last);
    }
    return worst;
}

template <class T>
class JointDrift : public testing::Test {};
TYPED_TEST_SUITE(JointDrift, BothDimensions);

/// With CAROM_TABLE in the environment it prints what it measured: the table of docs/joints.md.
TYPED_TEST(JointDrift, IsSmallUnderLoadForAnyTypeAndRatio) {
    constexpr int D = TypeParam::value;
    for (const std::string type :
         {"hinge", "hinge with limits", "slider", "ball", "weld", "ratchet", "wheel", "generic, locked"}) {
        std::string row = "| " + type + ", " + std::to_string(D) + "D |";
        for (const double ratio : {1.0, 10.0, 100.0}) {
            const Drift d = drift<D>(type, ratio);
            SCOPED_TRACE(type + ", 1 : " + std::to_string(ratio));
            EXPECT_LT(d.place, 5e-3);  // by the blow, or as limits are struck
            EXPECT_LT(d.angle, 0.012);
            EXPECT_LT(d.place_at_last, 1e-4);
            EXPECT_LT(d.angle_at_last, 1e-5);
            char text[100];
            std::snprintf(text, sizeof text, " %.4f, %.4f | %.4f, %.4f |", 1e3 * d.place, 57.29578 * d.angle,
                          1e3 * d.place_at_last, 57.29578 * d.angle_at_last);
            row += text;
        }
        if (std::getenv("CAROM_TABLE")) std::printf("%s\n", row.c_str());
    }
}

}  // namespace
}  // namespace carom::test
