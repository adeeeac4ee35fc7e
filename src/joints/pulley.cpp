#include "joints/couplings.hpp"

namespace carom::detail {

/// The distances of the two anchors from the two points of the world make up the length of the rope.
template <int D>
CouplingRecord<D> couple(const PulleyJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.ground_a, "ground_a");
    require_finite(joint.ground_b, "ground_b");
    require_positive(joint.ratio, "ratio");
    if (joint.anchor_a) require_finite(*joint.anchor_a, "anchor_a");
    if (joint.anchor_b) require_finite(*joint.anchor_b, "anchor_b");
    const Vec<D> a = joint.anchor_a.value_or(site.center_a), b = joint.anchor_b.value_or(site.center_b);
    if (a == joint.ground_a) throw Error("ground_a: lies at anchor_a, so that the rope has no direction");
    if (b == joint.ground_b) throw Error("ground_b: lies at anchor_b, so that the rope has no direction");
    // Each half of the rope ends at a point of the world.
    JointSite<D> of_a, of_b;
    of_a.b = site.a;
    of_b.b = site.b;
    CouplingRecord<D> record;
    record.ends = {JointBuilder<D>(of_a).anchors(joint.ground_a, a).drive(Measure::stretch).record,
                   JointBuilder<D>(of_b).anchors(joint.ground_b, b).drive(Measure::stretch).record};
    record.factors = {1, joint.ratio};
    record.is_rope = true;
    return record;
}

template CouplingRecord<2> couple(const PulleyJoint<2>&, const JointSite<2>&);
template CouplingRecord<3> couple(const PulleyJoint<3>&, const JointSite<3>&);

}  // namespace carom::detail
