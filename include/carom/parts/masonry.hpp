#pragma once

#include <span>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// How bodies that touch are glued together.
template <int D>
struct Mortar {
    /// N/m² (N/m in the plane), positive: the stress at which a joint breaks, on its whole area for a force,
    /// and at its rim for bending.
    double strength = 1e5;
    double reach = 0.01;  ///< m, positive: faces no further apart than this are glued
};

/// Welds every two of the bodies whose faces lie on each other, where they do. A weld breaks at the force
/// that stresses the area in common, and at the torque that stresses its rim, as beams are reckoned with;
/// then the two touch each other like any bodies, and `World::joint_breaks` tells. Bodies that touch at an
/// edge or a corner alone are left apart, and so are two that cannot move. Returns the joints, in the order
/// of the bodies. Throws `Error` for what cannot be.
template <int D>
std::vector<JointId<D>> glue(World<D>& world, std::span<const BodyId<D>> bodies,
                             const Mortar<D>& mortar = {});

}  // namespace carom
