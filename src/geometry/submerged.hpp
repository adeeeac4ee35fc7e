#pragma once

#include "geometry/shape.hpp"

namespace carom::detail {

/// The part of a shape that lies in a half-space.
template <int D>
struct Submerged {
    double volume = 0;  ///< m³ (2D: area, m²)
    Vec<D> center{};    ///< its centre of volume; without a meaning where there is none
};

/// The part of a convex shape where up · x ≤ surface, in the frame of the shape's body; `up` is a unit
/// vector. It is exact to rounding: what is no closed form is integrated by Gauss's quadrature over pieces on
/// which the integrand is analytic. Nothing for planes and terrains.
template <int D>
Submerged<D> submerged(const Shape<D>& shape, const Vec<D>& up, double surface);

/// The same for a capsule, cylinder or cone.
Submerged<3> submerged_revolved(const Shape<3>& shape, const Vec3& up, double surface);

}  // namespace carom::detail
