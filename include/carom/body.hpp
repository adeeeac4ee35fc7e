#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "carom/ids.hpp"
#include "carom/inertia.hpp"
#include "carom/mass.hpp"
#include "carom/shapes.hpp"

namespace carom {

/// How a body moves.
enum class BodyType : std::uint8_t {
    dynamic,    ///< by forces, impulses and collisions
    kinematic,  ///< by its velocity alone; pushes others and is not pushed
    fixed,      ///< not at all, unless the user places it anew
};

/// Directions in which a body cannot move or turn, along the axes of the world.
struct Locks {
    bool x = false, y = false, z = false;     ///< translation (z in 3D only)
    bool rx = false, ry = false, rz = false;  ///< rotation; in 2D `rz` alone has a meaning

    friend constexpr bool operator==(const Locks&, const Locks&) = default;
};

/// All that is needed to add a body. The defaults make a dynamic body at rest at the origin.
template <int D>
struct BodyDefinition {
    BodyType type = BodyType::dynamic;
    Vec<D> position{};              ///< of the body's frame (not of its centre of mass), m
    Rotation<D> rotation{};         ///< unit length
    Vec<D> velocity{};              ///< of the centre of mass, m/s
    Angular<D> angular_velocity{};  ///< rad/s, along the axes of the world
    std::vector<ShapeDefinition<D>> shapes{};

    std::optional<double> mass{};  ///< kg, positive; scales the inertia of the shapes unless that is given
    std::optional<Vec<D>> center_of_mass{};  ///< in the body's frame, m
    std::optional<Inertia<D>>
        inertia{};  ///< about the centre of mass, in the body's frame, kg·m², positive definite

    double gravity_scale = 1;
    double linear_damping = 0;   ///< 1/s, not negative: free velocity decays as exp(−damping · t)
    double angular_damping = 0;  ///< 1/s, not negative
    Locks locks{};
    bool can_sleep = true;
    bool bullet = false;          ///< asks for continuous collision against moving bodies too
    std::string name{};           ///< for messages, traces and replays
    std::uint64_t user_data = 0;  ///< yours
};

using BodyDefinition2 = BodyDefinition<2>;
using BodyDefinition3 = BodyDefinition<3>;
using BodyId2 = BodyId<2>;
using BodyId3 = BodyId<3>;

}  // namespace carom
