#include "joints/types.hpp"

namespace carom::detail {

/// The hub (anchor b) moves along the axis of the suspension, and the wheel turns. In space its own axis
/// stays at a right angle to that of the suspension, about which it is steered.
template <int D>
JointRecord<D> place(const WheelJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    require_direction(joint.axis, "axis");
    JointBuilder<D> builder(site);
    builder.anchors(joint.anchor, joint.anchor).drive(Measure::along);
    if constexpr (D == 2) {
        return builder.frame(frame_along(joint.axis)).drive(Measure::twist).record;
    } else {
        require_direction(joint.spin_axis, "spin_axis");
        require_direction(cross(normalized(joint.axis), normalized(joint.spin_axis)), "spin_axis (across axis)");
        return builder.frame(frame_along(joint.axis, joint.spin_axis))
            .drive(Measure::spin)
            .drive(Measure::steer)
            .record;
    }
}

template <int D>
void configure(const WheelJoint<D>& joint, JointRecord<D>& record) {
    set_limits(record.drives[0], joint.limits, "limits");
    set_motor_and_spring(record.drives[0], {}, joint.spring, 0);
    set_motor_and_spring(record.drives[1], joint.motor, {}, 0);
    if constexpr (D == 2) {
        if (joint.steering || joint.steering_limits) throw Error("steering: has a meaning in 3D only");
        set_layout<D, layout(LinearPart::line, AngularPart::none, DriveKind::slide, DriveKind::turn)>(record);
    } else {
        set_layout<D, layout(LinearPart::line, AngularPart::square, DriveKind::slide, DriveKind::turn,
                             DriveKind::turn)>(record);
        const JointLimits straight{0, 0};
        set_limits(record.drives[2], joint.steering ? joint.steering_limits : straight, "steering_limits");
        set_motor_and_spring(record.drives[2], joint.steering, {}, 0, "steering");
    }
}

CAROM_INSTANTIATE_JOINT(WheelJoint)

}  // namespace carom::detail
