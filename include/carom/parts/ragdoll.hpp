#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// A bone of a figure, and the joint by which it hangs on its parent. All places and directions are in the
/// frame of the figure, as it stands.
template <int D>
struct Bone {
    BodyDefinition<D> body{};
    int parent = -1;  ///< index of an earlier bone; −1 for one that hangs on none
    /// A hinge, ball or weld joint; its limits count from this pose. Left out of a bone without a parent.
    decltype(JointDefinition<D>::kind) joint{};
};

/// A figure as a table of bones.
template <int D>
struct RagdollDefinition {
    std::vector<Bone<D>> bones{};
    /// Pairs of bones that do not touch each other, beside those that a joint ties.
    std::vector<std::array<int, 2>> apart{};
};

/// A figure in the world.
template <int D>
struct Ragdoll {
    std::vector<BodyId<D>> bodies;                   ///< one for each bone
    std::vector<std::optional<JointId<D>>> joints;   ///< with the parent; none where there is none
    std::vector<std::optional<JointId<D>>> muscles;  ///< that drive it to a pose; none while it is limp
    std::vector<int> parents;                        ///< as in the table
};

/// Where a figure is put.
template <int D>
struct RagdollPlace {
    Transform<D> placed{};  ///< of the figure's frame
    Vec<D> velocity{};      ///< of all bones, m/s
    /// Goes over the group of those shapes that have one in the table; 0 leaves it. Give each figure a
    /// negative number of its own, and the bones of one do not touch each other.
    std::int32_t group = 0;
};

/// Adds the bodies and joints of a figure. Throws `Error` that names the bone; the world is then as before.
template <int D>
Ragdoll<D> add_ragdoll(World<D>& world, const RagdollDefinition<D>& definition,
                       const RagdollPlace<D>& place = {});

/// Removes its bodies, and with them the joints.
template <int D>
void remove_ragdoll(World<D>& world, const Ragdoll<D>& ragdoll);

/// How hard a figure holds a pose.
struct Muscles {
    double frequency = 6;                                         ///< Hz, positive
    double damping_ratio = 1;                                     ///< not negative
    double max_torque = std::numeric_limits<double>::infinity();  ///< at each joint, N·m, not negative
};

/// The turn of each bone against its parent, or for a bone without one against the world.
template <int D>
std::vector<Rotation<D>> pose_of(const World<D>& world, const Ragdoll<D>& ragdoll);

/// Drives each bone that has a parent towards its turn against that, from now on; call it again as the pose
/// changes. The joints go on to hold, and so do their limits. There must be as many turns as bones.
template <int D>
void drive_to_pose(World<D>& world, Ragdoll<D>& ragdoll, std::span<const Rotation<D>> pose,
                   const Muscles& muscles = {});

/// Lets it go limp.
template <int D>
void relax(World<D>& world, Ragdoll<D>& ragdoll);

}  // namespace carom
