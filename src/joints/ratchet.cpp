#include "joints/types.hpp"

namespace carom::detail {

/// A hinge with a lower limit that follows the teeth that have passed the pawl.
template <int D>
JointRecord<D> place(const RatchetJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    JointBuilder<D> builder(site);
    builder.anchors(joint.anchor, joint.anchor);
    if constexpr (D == 3) {
        require_direction(joint.axis, "axis");
        builder.frame(frame_along(joint.axis));
    }
    JointRecord<D> record = builder.drive(Measure::twist).record;
    (joint.backward ? record.drives[0].high : record.drives[0].low) = 0;
    return record;
}

template <int D>
void configure(const RatchetJoint<D>& joint, JointRecord<D>& record) {
    require_not_negative(joint.pitch, "pitch");
    DriveSettings& drive = record.drives[0];
    drive.pawl = joint.backward ? Pawl::holds_above : Pawl::holds_below;
    drive.pitch = joint.pitch;
    set_motor_and_spring(drive, joint.motor, joint.spring, 0);
    constexpr AngularPart angular = D == 2 ? AngularPart::none : AngularPart::across;
    set_layout<D, layout(LinearPart::point, angular, DriveKind::turn)>(record);
}

CAROM_INSTANTIATE_JOINT(RatchetJoint)

}  // namespace carom::detail
