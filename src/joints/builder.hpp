#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "carom/joints.hpp"
#include "carom/transform.hpp"
#include "dynamics/joint.hpp"
#include "math/check.hpp"

/// What the joint types are built from.
namespace carom::detail {

/// Where the bodies of a joint are when it is added. The world stands at the origin.
template <int D>
struct JointSite {
    Transform<D> a{}, b{};         ///< frames of the bodies
    Vec<D> center_a{}, center_b{};  ///< centres of mass in the world
    double angle = 0;               ///< 2D: of b against a, whole turns included
};

/// Makes the record of a joint from what it is in the world.
template <int D>
class JointBuilder {
  public:
    explicit JointBuilder(const JointSite<D>& site) : site_(site) {}

    JointBuilder& anchors(const Vec<D>& a, const Vec<D>& b) {
        record.anchor_a = apply_inverse(site_.a, a);
        record.anchor_b = apply_inverse(site_.b, b);
        return *this;
    }
    /// Frames that are parallel now.
    JointBuilder& frame(const Rotation<D>& frame) { return frames(frame, frame); }
    JointBuilder& frames(const Rotation<D>& a, const Rotation<D>& b) {
        record.frame_a = normalized(inverse(site_.a.rotation) * a);
        record.frame_b = normalized(inverse(site_.b.rotation) * b);
        return *this;
    }
    /// A coordinate that is zero as the bodies stand (a distance is what it is).
    JointBuilder& drive(Measure measure) {
        DriveSettings& drive = record.drives.emplace_back();
        drive.measure = measure;
        if (D == 2 && measure == Measure::twist) drive.zero = site_.angle;
        return *this;
    }

    JointRecord<D> record;

  private:
    const JointSite<D>& site_;
};

/// The rows that the joint is made of.
template <int D, Layout L>
void set_layout(JointRecord<D>& record) {
    constexpr int index = layout_index<D>(L);
    static_assert(index >= 0, "the layout is not among those that are compiled");
    record.layout = index;
}

/// The frame whose x axis lies along the axis.
inline Rotation2 frame_along(const Vec2& axis) {
    const Vec2 x = normalized(axis);
    return {x.x, x.y};
}
Rotation3 frame_along(const Vec3& axis);
/// The frame with this x axis, and the y axis as near to `second` as can be.
Rotation3 frame_along(const Vec3& axis, const Vec3& second);

template <int D>
void require_direction(const Vec<D>& axis, std::string_view field) {
    require_finite(axis, field);
    if (!(length_squared(axis) > 1e-100)) throw Error(std::string(field) + ": the zero vector has no direction");
}

inline void check(const JointSpring& spring, std::string_view field) {
    const std::string prefix = std::string(field) + ".";
    require_positive(spring.frequency, prefix + "frequency");
    require_not_negative(spring.damping_ratio, prefix + "damping_ratio");
    if (spring.rest) require_finite(*spring.rest, prefix + "rest");
}

/// Infinity is allowed.
inline void require_most(double value, std::string_view field) {
    if (!(value >= 0)) refuse(field, value, "is negative or not a number");
}

inline SpringSettings spring_settings(const JointSpring& spring, double rest) {
    SpringSettings s;
    s.frequency = spring.frequency;
    s.damping_ratio = spring.damping_ratio;
    s.rest = spring.rest.value_or(rest);
    return s;
}

inline SpringSettings spring_settings(double frequency, double damping_ratio, double most) {
    SpringSettings s;
    s.frequency = frequency;
    s.damping_ratio = damping_ratio;
    s.most = most;
    return s;
}

inline void set_limits(DriveSettings& drive, const std::optional<JointLimits>& limits, std::string_view field) {
    drive.low = -std::numeric_limits<double>::infinity();
    drive.high = std::numeric_limits<double>::infinity();
    if (!limits) return;
    if (std::isnan(limits->low) || std::isnan(limits->high)) throw Error(std::string(field) + ": not a number");
    if (limits->low > limits->high)
        refuse(field, limits->low, "as the lower limit is above the upper one, " + to_text(limits->high));
    drive.low = limits->low;
    drive.high = limits->high;
}

/// A motor with a target is a spring of limited force, and then there can be no other spring.
inline void set_motor_and_spring(DriveSettings& drive, const std::optional<JointMotor>& motor,
                                 const std::optional<JointSpring>& spring, double rest,
                                 std::string_view field = "motor") {
    drive.spring = {};
    drive.motor_speed = drive.motor_most = 0;
    if (spring) {
        check(*spring, "spring");
        drive.spring = spring_settings(*spring, rest);
    }
    if (!motor) return;
    const std::string prefix = std::string(field) + ".";
    require_finite(motor->speed, prefix + "speed");
    require_most(motor->max, prefix + "max");
    if (!motor->target) {
        drive.motor_speed = motor->speed;
        drive.motor_most = motor->max;
        return;
    }
    require_finite(*motor->target, prefix + "target");
    require_positive(motor->frequency, prefix + "frequency");
    require_not_negative(motor->damping_ratio, prefix + "damping_ratio");
    if (spring) throw Error(std::string(field) + ": with a target it is a spring, beside which there is no other");
    drive.spring = spring_settings(motor->frequency, motor->damping_ratio, motor->max);
    drive.spring.rest = *motor->target;
}

}  // namespace carom::detail
