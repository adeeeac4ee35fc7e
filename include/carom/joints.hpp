#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "carom/ids.hpp"
#include "carom/rotation.hpp"
#include "carom/vec.hpp"

namespace carom {

/// Handle of a joint.
template <int D>
using JointId = Id<D, struct JointTag>;

/// How joints are solved. Either way they hold the same; what differs is how far a chain or frame of joints
/// gives way, and what it costs.
enum class JointMethod : std::uint8_t {
    automatic,  ///< directly where chains are long or masses differ so much that sweeps would not hold them
    direct,     ///< all joints that hang together at once, by a factorised system: nothing stretches
    iterative,  ///< one after the other, again in every sub-step: the fastest for crowds of joints
};

/// What a coordinate of a joint may be: an angle (rad, beyond ±π where it winds) or a distance (m), zero at
/// the start. `low` may equal `high`; either may be infinite.
struct JointLimits {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// A spring with a damper that pulls a coordinate to `rest`. Frequency and damping ratio are those with which
/// the two bodies swing at the joint, whatever their masses are, if nothing else holds them.
struct JointSpring {
    double frequency = 1;          ///< Hz, positive
    double damping_ratio = 0;      ///< 1 is critical; not negative
    std::optional<double> rest{};  ///< rad or m; where the joint starts when left out
};

/// Drives a coordinate at a speed, or to a `target` as a spring does. With speed 0 it is friction.
struct JointMotor {
    double speed = 0;                ///< rad/s or m/s
    std::optional<double> target{};  ///< rad or m; then frequency and damping ratio count instead of speed
    double frequency = 5;            ///< Hz, positive
    double damping_ratio = 1;        ///< not negative
    double max = std::numeric_limits<double>::infinity();  ///< torque (N·m) or force (N), not negative
};

// Anchors are points of the world, and axes directions of the world, when the joint is added; from then on
// they belong to their bodies. Where an anchor may be left out, it is the centre of mass of its body.

/// Turns about one point (2D) or one axis (3D). Coordinate: the angle by which b turned against a.
template <int D>
struct HingeJoint {
    Vec<D> anchor{};
    Vec3 axis{0, 0, 1};  ///< 3D; any length but zero
    std::optional<JointLimits> limits{};
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};
};

/// Moves along one axis without turning. Coordinate: the way of b along the axis, which turns with a.
template <int D>
struct SliderJoint {
    Vec<D> anchor{};
    Vec<D> axis = [] {
        Vec<D> x{};
        x.x = 1;
        return x;
    }();  ///< any length but zero
    std::optional<JointLimits> limits{};
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};
};

/// Turns freely about one point. In the plane this is a hinge.
template <int D>
struct BallJoint {
    Vec<D> anchor{};
    Vec3 axis{1, 0, 0};                         ///< 3D: along the limb (b), for the two limits
    std::optional<Vec3> cone_axis{};            ///< 3D: of a, in the middle of the cone; `axis` when left out
    std::optional<double> swing_limit{};        ///< 3D: how far the axis leaves that of a, rad, in (0, π]
    std::optional<JointLimits> twist_limits{};  ///< 3D: turn about the axis, rad, within ±π
    std::optional<JointSpring> spring{};        ///< draws the axis to that of the cone; `rest` has no use
    double friction = 0;                        ///< greatest torque against turning, N·m
};

/// Holds two bodies together. With a spring it gives way softly.
template <int D>
struct WeldJoint {
    std::optional<Vec<D>> anchor{};       ///< of the force read back; the centre of mass of b when left out
    std::optional<JointSpring> spring{};  ///< of the place; `rest` has no use
    std::optional<JointSpring> angular_spring{};  ///< of the angle
};

/// Keeps two points at a distance: a rod; with limits a rope or a telescope; with a spring a sprung strut.
/// Coordinate: the distance.
template <int D>
struct DistanceJoint {
    std::optional<Vec<D>> anchor_a{}, anchor_b{};
    std::optional<double> length{};       ///< m, not negative; the distance at the start when left out
    std::optional<JointLimits> limits{};  ///< m; without limits, motor and spring the length is kept
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};  ///< `rest` is `length` when left out
};

/// A wheel (b) on a sprung axis of its chassis (a). In space it turns about `spin_axis`, which is steered
/// about `axis`. Coordinates: travel of the suspension along `axis`; angle of the wheel; angle of steering.
template <int D>
struct WheelJoint {
    Vec<D> anchor{};
    Vec<D> axis = [] {
        Vec<D> y{};
        y.y = 1;
        return y;
    }();                                           ///< of the suspension, any length but zero
    Vec3 spin_axis{0, 0, 1};                       ///< 3D: of the wheel, not along `axis`
    std::optional<JointLimits> limits{};           ///< of the suspension, m
    std::optional<JointSpring> spring{};           ///< of the suspension
    std::optional<JointMotor> motor{};             ///< of the wheel
    std::optional<JointMotor> steering{};          ///< 3D; without it the wheel is not steered
    std::optional<JointLimits> steering_limits{};  ///< 3D, rad, within ±π
};

/// A rope from a over two points of the world to b: |anchor_a − ground_a| + ratio · |anchor_b − ground_b| is
/// at most what it is at the start. Coordinate: that sum.
template <int D>
struct PulleyJoint {
    std::optional<Vec<D>> anchor_a{}, anchor_b{};
    Vec<D> ground_a{}, ground_b{};
    double ratio = 1;  ///< positive
};

/// Couples the angles of two hinges (or wheels) as gears that mesh: angle_b = −ratio · angle_a. It names its
/// joints; `a` and `b` of the definition stay empty.
template <int D>
struct GearJoint {
    JointId<D> joint_a{}, joint_b{};
    double ratio = 1;  ///< not zero
};

/// Couples a hinge and a slider as pinion and rack: way_b = ratio · angle_a. Bodies as for the gear.
template <int D>
struct RackJoint {
    JointId<D> joint_a{}, joint_b{};
    double ratio = 1;  ///< m/rad, not zero
};

/// A hinge that turns one way only: a pawl falls behind each tooth that passes. Coordinate: the angle.
template <int D>
struct RatchetJoint {
    Vec<D> anchor{};
    Vec3 axis{0, 0, 1};     ///< 3D; any length but zero
    double pitch = 0;       ///< angle from tooth to tooth, rad; with 0 it holds wherever it is
    bool backward = false;  ///< it turns towards negative angles
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};
};

/// Keeps a point of b on a curve that is fixed in a; b may turn as it likes. Coordinate: the way along the
/// curve from its first point on; on a loop it counts on from round to round.
template <int D>
struct PathJoint {
    std::vector<Vec<D>> points{};  ///< at least two; neighbours are not the same
    bool loop = false;             ///< does the last point lead to the first?
    bool smooth = true;  ///< a Catmull–Rom spline through the points; else straight from point to point
    std::optional<Vec<D>> anchor{};  ///< of b; its centre of mass when left out. It is drawn to the path.
    std::optional<JointLimits> limits{};  ///< m; an open path ends at its ends when left out
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};
};

/// What a generic joint does about a way along or a turn about one axis. Without anything it is free.
struct JointAxis {
    std::optional<JointLimits> limits = JointLimits{0, 0};  ///< m or rad; locked at first
    std::optional<JointMotor> motor{};
    std::optional<JointSpring> spring{};
};

/// A joint of which each way and turn is locked, limited, free, driven or sprung by itself. Its axes are
/// those of a; turns are the components of the turn of b against a as a rotation vector (axis times angle,
/// within ±π unless the other two are zero). Coordinate: the way along the first axis.
template <int D>
struct GenericJoint {
    Vec<D> anchor{};
    Vec<D> axis = [] {
        Vec<D> x{};
        x.x = 1;
        return x;
    }();                        ///< the first; any length but zero
    Vec3 second_axis{0, 1, 0};  ///< 3D: made perpendicular to the first
    std::array<JointAxis, D> ways{};
    std::array<JointAxis, D == 2 ? 1 : 3> turns{};
};

/// Drives b to a pose in the frame of a, by limited force and torque.
template <int D>
struct MotorJoint {
    std::optional<Vec<D>> position{};       ///< in the frame of a, m; that of the start when left out
    std::optional<Rotation<D>> rotation{};  ///< the same
    double frequency = 5;                   ///< Hz, positive
    double damping_ratio = 1;               ///< not negative
    double max_force = std::numeric_limits<double>::infinity();   ///< N, not negative
    double max_torque = std::numeric_limits<double>::infinity();  ///< N·m, not negative
};

/// Drags a point of b to a point of a, or of the world: the mouse.
template <int D>
struct TargetJoint {
    Vec<D> anchor{};                                       ///< the point of b
    std::optional<Vec<D>> target{};                        ///< where it shall go; `anchor` when left out
    double frequency = 5;                                  ///< Hz, positive
    double damping_ratio = 1;                              ///< not negative
    double max = std::numeric_limits<double>::infinity();  ///< force, N, not negative
};

/// Keeps the angle between the bodies (2D), or an axis of b along one of a (3D): with a as the world, b stays
/// upright. Both may move as they like otherwise.
template <int D>
struct ParallelJoint {
    Vec3 axis{0, 1, 0};                   ///< 3D
    std::optional<JointSpring> spring{};  ///< 2D: softly; `rest` has no use
};

/// A joint between two bodies, or a body and the world.
template <int D>
struct JointDefinition {
    std::variant<HingeJoint<D>, SliderJoint<D>, BallJoint<D>, WeldJoint<D>, DistanceJoint<D>, WheelJoint<D>,
                 MotorJoint<D>, TargetJoint<D>, ParallelJoint<D>, PulleyJoint<D>, GearJoint<D>, RackJoint<D>,
                 RatchetJoint<D>, PathJoint<D>, GenericJoint<D>>
        kind{};
    std::optional<BodyId<D>> a{};  ///< the world when left out
    BodyId<D> b{};
    bool collide = false;                                           ///< may the two bodies touch each other?
    double break_force = std::numeric_limits<double>::infinity();   ///< N, positive: it breaks beyond this
    double break_torque = std::numeric_limits<double>::infinity();  ///< N·m, positive
    std::string name{};
    std::uint64_t user_data = 0;
};

using JointDefinition2 = JointDefinition<2>;
using JointDefinition3 = JointDefinition<3>;
using JointId2 = JointId<2>;
using JointId3 = JointId<3>;

/// A joint broke in the last step, and was removed.
template <int D>
struct JointBreak {
    JointId<D> joint{};
    std::optional<BodyId<D>> a{};
    BodyId<D> b{};
    double force = 0, torque = 0;  ///< that broke it, N and N·m
};

}  // namespace carom
