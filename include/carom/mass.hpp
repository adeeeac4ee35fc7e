#pragma once

#include <span>

#include "carom/inertia.hpp"
#include "carom/shapes.hpp"

namespace carom {

/// Mass, centre of mass and moment of inertia of a rigid body.
template <int D>
struct MassProperties {
    double mass = 0;       ///< kg
    Vec<D> center{};       ///< centre of mass in the body's frame, m
    Inertia<D> inertia{};  ///< about the centre of mass, along the axes of the body's frame, kg·m²
};

using MassProperties2 = MassProperties<2>;
using MassProperties3 = MassProperties<3>;

/// Mass properties of one shape of uniform density, in the frame of its body, in closed form. A plane has
/// none (all zero), nor have chains, meshes and height fields, which are not looked at. Throws `Error` for
/// another shape that cannot exist (see `Geometry`).
template <int D>
MassProperties<D> mass_properties(const ShapeDefinition<D>& shape);

/// The sum of several parts: the centre is the mean weighted by mass, and the inertia follows from the
/// parallel-axis theorem (Steiner): I = Σ Iᵢ + mᵢ (|dᵢ|² 1 − dᵢ dᵢᵀ), dᵢ from the common centre.
template <int D>
MassProperties<D> combine(std::span<const MassProperties<D>> parts);

/// Area (2D, m²) or volume (3D, m³) of a shape, in closed form; zero for planes, chains, meshes and height
/// fields.
template <int D>
double measure(const Geometry<D>& geometry);

}  // namespace carom
