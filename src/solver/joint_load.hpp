#pragma once

#include <array>
#include <span>

#include "dynamics/body.hpp"
#include "dynamics/joint.hpp"
#include "solver/joint_rows.hpp"

/// From the records of joints to rows, and what a joint measures.
namespace carom::detail {

/// The two bodies of a joint, with its frames and anchors, as they are now.
template <int D>
struct JointPose {
    Rotation<D> frame_a{}, frame_b{};   ///< in the world
    Vec<D> arm_a{}, arm_b{};            ///< from the centres of mass to the anchors
    Vec<D> gap{};                       ///< from anchor a to anchor b
    Vec<D> velocity_a{}, velocity_b{};  ///< of the centres of mass
    Angular<D> spin_a{}, spin_b{};
    double angle = 0;  ///< 2D: of b against a, whole turns included

    Vec<D> axis_a(int i) const { return axis(frame_a, i); }
    Vec<D> axis_b(int i) const { return axis(frame_b, i); }
    /// Velocity of anchor b against anchor a.
    Vec<D> speed() const { return velocity_b + cross(spin_b, arm_b) - velocity_a - cross(spin_a, arm_a); }
    /// The same against the point of a that is at anchor b now.
    Vec<D> speed_along_line() const { return speed() - cross(spin_a, gap); }

    static Vec<D> axis(const Rotation<D>& frame, int i) {
        Vec<D> unit{};
        unit[i] = 1;
        return rotate(frame, unit);
    }
};

/// In the plane the angle takes some time, and only coordinates want it.
template <int D>
JointPose<D> pose_of(const JointRecord<D>& joint, std::span<const BodyState<D>> states,
                     std::span<const BodyMass<D>> masses, bool with_angle = true);

/// A coordinate of a joint, its rate, and the axis of its row.
template <int D>
struct Measured {
    Vec<D> axis{};
    double value = 0;
    double speed = 0;
};
template <int D>
Measured<D> measure(const DriveSettings& drive, const JointPose<D>& pose);

/// By how much a joint is not what it should be: m and rad. Springs and limits that are kept want nothing.
struct JointErrors {
    double linear = 0, angular = 0;
};
template <int D>
JointErrors errors(const JointRecord<D>& joint, const JointPose<D>& pose);

/// Brings `stiffness` and `damping` of the spring to this length of a sub-step.
void prepare_spring(SpringSettings& spring, double h);

/// The spring as a row of a joint, which its other rows make heavier by `share`.
SpringRow<float> spring_row(SpringSettings& spring, double h, double share);
/// A drive as it is at the start of the step; `drive.coordinate` is measured.
template <int D>
DriveBase<D, float> drive_row(DriveSettings& drive, const JointRecord<D>& joint, const JointPose<D>& pose,
                              std::span<const BodyState<D>> states, std::span<const BodyMass<D>> masses,
                              double h);
/// By how much frame b is turned against frame a, as a rotation vector.
template <int D>
Angular<D> turn_between(const JointPose<D>& pose);

/// The rows of a joint as floats, one every `stride`: `fields` of them, of which the first are impulses that
/// are kept from step to step.
template <int D>
struct JointLoader {
    std::size_t fields;
    /// Writes the kept impulses.
    void (*take)(const JointRecord<D>& joint, float* to, std::size_t stride);
    /// Writes all others.
    void (*load)(JointRecord<D>& joint, const JointPose<D>& pose, std::span<const BodyState<D>> states,
                 std::span<const BodyMass<D>> masses, double h, float* to, std::size_t stride);
    /// Gives the record its impulses.
    void (*store)(JointRecord<D>& joint, const float* from, std::size_t stride);
};

template <int D>
const std::array<JointLoader<D>, layouts<D>.size()>& joint_loaders();

}  // namespace carom::detail
