#pragma once

#include <cstdint>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// How a blast grows weaker with the distance d from its centre; with r the radius.
enum class Falloff : std::uint8_t {
    none,       ///< 1 up to r
    linear,     ///< 1 − d / r
    quadratic,  ///< (1 − d / r)²
};

/// A blow from a point outwards. A body gets the impulse pressure · A · falloff at its point that is nearest
/// to the centre, away from there, with A the cross-section of a ball of the same measure as its shapes; so
/// small things fly far and large ones shift a little.
template <int D>
struct Explosion {
    Vec<D> center{};         ///< m
    double radius = 5;       ///< m, positive: beyond it nothing happens
    double pressure = 1000;  ///< N·s/m² (N·s/m in the plane), not negative: impulse for each area
    Falloff falloff = Falloff::linear;  ///< with the distance of the nearest point
    bool shielded = true;               ///< what lies behind a fixed body feels nothing
    QueryFilter<D> filter{};            ///< which shapes are seen, as targets and as shields
};

/// Pushes the dynamic bodies around, at once, and wakes them. Returns them, in the order of their places.
/// Throws `Error` for what is no explosion.
template <int D>
std::vector<BodyId<D>> explode(World<D>& world, const Explosion<D>& explosion);

}  // namespace carom
