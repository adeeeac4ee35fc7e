#include "joints/types.hpp"

namespace carom::detail {

/// Springs of limited force and torque draw b to its place in the frame of a.
template <int D>
JointRecord<D> place(const MotorJoint<D>&, const JointSite<D>& site) {
    return JointBuilder<D>(site).anchors(site.b.position, site.b.position).frame(site.b.rotation).record;
}

template <int D>
void configure(const MotorJoint<D>& joint, JointRecord<D>& record) {
    set_layout<D, layout(LinearPart::held, AngularPart::held)>(record);
    require_positive(joint.frequency, "frequency");
    require_not_negative(joint.damping_ratio, "damping_ratio");
    require_most(joint.max_force, "max_force");
    require_most(joint.max_torque, "max_torque");
    if (joint.position) {
        require_finite(*joint.position, "position");
        record.anchor_a = *joint.position;
    }
    if (joint.rotation) {
        require_unit(*joint.rotation, "rotation");
        record.frame_a = normalized(*joint.rotation);
    }
    record.held.linear = spring_settings(joint.frequency, joint.damping_ratio, joint.max_force);
    record.held.angular = spring_settings(joint.frequency, joint.damping_ratio, joint.max_torque);
}

CAROM_INSTANTIATE_JOINT(MotorJoint)

}  // namespace carom::detail
