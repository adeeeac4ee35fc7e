#include "joints/types.hpp"

namespace carom::detail {

/// The anchors stay together and the frames parallel, each firmly or by a spring.
template <int D>
JointRecord<D> place(const WeldJoint<D>& joint, const JointSite<D>& site) {
    if (joint.anchor) require_finite(*joint.anchor, "anchor");
    const Vec<D> anchor = joint.anchor.value_or(site.center_b);
    return JointBuilder<D>(site).anchors(anchor, anchor).frame({}).record;
}

template <int D>
void configure(const WeldJoint<D>& joint, JointRecord<D>& record) {
    record.held = {};
    if (joint.spring) {
        check(*joint.spring, "spring");
        record.held.linear = spring_settings(*joint.spring, 0);
    }
    if (joint.angular_spring) {
        check(*joint.angular_spring, "angular_spring");
        record.held.angular = spring_settings(*joint.angular_spring, 0);
    }
    if (joint.spring && joint.angular_spring) {
        set_layout<D, layout(LinearPart::held, AngularPart::held)>(record);
    } else if (joint.spring) {
        set_layout<D, layout(LinearPart::held, AngularPart::locked)>(record);
    } else if (joint.angular_spring) {
        set_layout<D, layout(LinearPart::point, AngularPart::held)>(record);
    } else {
        set_layout<D, layout(LinearPart::point, AngularPart::locked)>(record);
    }
}

CAROM_INSTANTIATE_JOINT(WeldJoint)

}  // namespace carom::detail
