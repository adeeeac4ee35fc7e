#pragma once

#include <optional>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// How neighbouring links of a rope hang together.
enum class LinkKind : std::uint8_t {
    rope,   ///< round links on ball joints: it bends and twists every way
    chain,  ///< round links on hinges, each turned by 90° against the one before; in the plane as a rope
    bridge  ///< planks on level hinges
};

/// A rope, a chain or a bridge along a line of points.
template <int D>
struct RopeDefinition {
    std::vector<Vec<D>> path{};  ///< at least two points, no two in a row at the same place, m
    LinkKind kind = LinkKind::rope;
    double link_length = 0.25;     ///< about, m, positive: each stretch of the path becomes equal links
    double thickness = 0.06;       ///< m, positive and less than the links are long
    double width = 1;              ///< of planks in space, m, positive
    Material material{};           ///< of the links
    Filter filter{};               ///< neighbouring links do not touch each other in any case
    double friction = 0;           ///< greatest torque against bending at each joint, N·m, not negative
    double linear_damping = 0;     ///< of the links, 1/s, not negative
    double angular_damping = 0.1;  ///< the same
    double break_force = std::numeric_limits<double>::infinity();  ///< of each joint, N, positive
    bool hold_start = true;  ///< the first point is held by `start`, or by the world
    bool hold_end = false;   ///< the same for the last point
    std::optional<BodyId<D>> start{};
    std::optional<BodyId<D>> end{};
};

/// What a rope consists of, from its start on. Where an end is held, the first or last joint is that which
/// holds it.
template <int D>
struct Rope {
    std::vector<BodyId<D>> links;
    std::vector<JointId<D>> joints;
};

/// Adds the links and joints to the world. Throws `Error` that names the field; the world is then as before.
template <int D>
Rope<D> add_rope(World<D>& world, const RopeDefinition<D>& definition);

}  // namespace carom
