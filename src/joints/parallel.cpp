#include "joints/types.hpp"

namespace carom::detail {

/// The frames stay parallel in the plane; in space one axis does.
template <int D>
JointRecord<D> place(const ParallelJoint<D>& joint, const JointSite<D>& site) {
    JointBuilder<D> builder(site);
    if constexpr (D == 2) {
        return builder.frame({}).record;
    } else {
        require_direction(joint.axis, "axis");
        return builder.frame(frame_along(joint.axis)).record;
    }
}

template <int D>
void configure(const ParallelJoint<D>& joint, JointRecord<D>& record) {
    if (joint.spring) {
        check(*joint.spring, "spring");
        if (D == 3) throw Error("spring: has a meaning in 2D only");
        record.held.angular = spring_settings(*joint.spring, 0);
        set_layout<D, layout(LinearPart::none, AngularPart::held)>(record);
    } else if constexpr (D == 2) {
        set_layout<D, layout(LinearPart::none, AngularPart::locked)>(record);
    } else {
        set_layout<D, layout(LinearPart::none, AngularPart::across)>(record);
    }
}

CAROM_INSTANTIATE_JOINT(ParallelJoint)

}  // namespace carom::detail
