#pragma once

#include "world/state.hpp"

namespace carom::detail {

/// Visits the pairs of bodies that joints hold together.
template <int D>
template <class Visit>
void WorldState<D>::each_bond(const Visit& visit) const {
    for (const JointId<D>& id : joint_ids) {
        const JointRecord<D>& joint = joints[id.index];
        if (joint.body_a != no_body) visit(joint.body_a, joint.body_b);
    }
}

}  // namespace carom::detail
