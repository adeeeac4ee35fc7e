#include "joints/types.hpp"

namespace carom::detail {

/// Anchor b stays on a line through anchor a, which turns with a, and b does not turn against a.
template <int D>
JointRecord<D> place(const SliderJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    require_direction(joint.axis, "axis");
    return JointBuilder<D>(site)
        .anchors(joint.anchor, joint.anchor)
        .frame(frame_along(joint.axis))
        .drive(Measure::along)
        .record;
}

template <int D>
void configure(const SliderJoint<D>& joint, JointRecord<D>& record) {
    set_layout<D, layout(LinearPart::line, AngularPart::locked, DriveKind::slide)>(record);
    set_limits(record.drives[0], joint.limits, "limits");
    set_motor_and_spring(record.drives[0], joint.motor, joint.spring, 0);
}

CAROM_INSTANTIATE_JOINT(SliderJoint)

}  // namespace carom::detail
