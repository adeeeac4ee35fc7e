#pragma once

#include "geometry/shape.hpp"

/// Exact integrals over a convex polytope grown by a radius (its Minkowski sum with a ball), for density 1.
namespace carom::detail {

MassProperties2 polytope_mass(const Polygon& core, double radius);
MassProperties3 polytope_mass(const Polyhedron& core, double radius);

}  // namespace carom::detail
