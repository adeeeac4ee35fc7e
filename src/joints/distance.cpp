#include "joints/types.hpp"

namespace carom::detail {

/// A row along the line from anchor to anchor.
template <int D>
JointRecord<D> place(const DistanceJoint<D>& joint, const JointSite<D>& site) {
    if (joint.anchor_a) require_finite(*joint.anchor_a, "anchor_a");
    if (joint.anchor_b) require_finite(*joint.anchor_b, "anchor_b");
    const Vec<D> a = joint.anchor_a.value_or(site.center_a), b = joint.anchor_b.value_or(site.center_b);
    JointRecord<D> record = JointBuilder<D>(site).anchors(a, b).drive(Measure::stretch).record;
    record.drives[0].zero = length(b - a);
    return record;
}

template <int D>
void configure(const DistanceJoint<D>& joint, JointRecord<D>& record) {
    set_layout<D, layout(LinearPart::none, AngularPart::none, DriveKind::stretch)>(record);
    if (joint.length) require_not_negative(*joint.length, "length");
    DriveSettings& drive = record.drives[0];
    const double length = joint.length.value_or(drive.zero);
    set_limits(drive, joint.limits, "limits");
    if (!joint.limits && !joint.motor && !joint.spring) drive.low = drive.high = length;
    set_motor_and_spring(drive, joint.motor, joint.spring, length);
}

CAROM_INSTANTIATE_JOINT(DistanceJoint)

}  // namespace carom::detail
