#pragma once

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// The closest points of two shapes; see the public `closest_points`. All in the frame of a's body.
template <int D>
ClosestPoints<D> closest_points(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a);

/// Do two shapes overlap or touch?
template <int D>
bool overlap_shapes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a);

/// Radius of a ball about the point `center` of the body that holds the core of the shape (see
/// `core_support`). Not for planes.
template <int D>
double core_reach(const Shape<D>& shape, const Vec<D>& center);

/// A length of the order of the shape's size, for tolerances; zero for a plane.
template <int D>
double size_of(const Shape<D>& shape);

}  // namespace carom::detail
