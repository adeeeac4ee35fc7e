#include "joints/types.hpp"

namespace carom::detail {

/// The anchors stay together; in space the axes stay parallel.
template <int D>
JointRecord<D> place(const HingeJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    JointBuilder<D> builder(site);
    builder.anchors(joint.anchor, joint.anchor);
    if constexpr (D == 3) {
        require_direction(joint.axis, "axis");
        builder.frame(frame_along(joint.axis));
    }
    return builder.drive(Measure::twist).record;
}

template <int D>
void configure(const HingeJoint<D>& joint, JointRecord<D>& record) {
    DriveSettings& drive = record.drives[0];
    set_limits(drive, joint.limits, "limits");
    set_motor_and_spring(drive, joint.motor, joint.spring, 0);
    constexpr AngularPart angular = D == 2 ? AngularPart::none : AngularPart::across;
    if (joint.limits || joint.motor || joint.spring) {
        set_layout<D, layout(LinearPart::point, angular, DriveKind::turn)>(record);
    } else {
        set_layout<D, layout(LinearPart::point, angular)>(record);
    }
}

CAROM_INSTANTIATE_JOINT(HingeJoint)

}  // namespace carom::detail
