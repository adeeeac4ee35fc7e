#include "joints/types.hpp"

namespace carom::detail {

/// A spring of limited force draws a point of b to the target.
template <int D>
JointRecord<D> place(const TargetJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    if (joint.target) require_finite(*joint.target, "target");
    return JointBuilder<D>(site).anchors(joint.target.value_or(joint.anchor), joint.anchor).record;
}

template <int D>
void configure(const TargetJoint<D>& joint, JointRecord<D>& record) {
    set_layout<D, layout(LinearPart::held, AngularPart::none)>(record);
    require_positive(joint.frequency, "frequency");
    require_not_negative(joint.damping_ratio, "damping_ratio");
    require_most(joint.max, "max");
    record.held.linear = spring_settings(joint.frequency, joint.damping_ratio, joint.max);
}

CAROM_INSTANTIATE_JOINT(TargetJoint)

}  // namespace carom::detail
