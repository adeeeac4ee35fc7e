#pragma once

#include <optional>

#include "collision/manifold.hpp"
#include "geometry/terrain.hpp"

namespace carom::detail {

// Collision of a convex shape (anything but a plane or a terrain) with terrain. What happens here happens in
// the frame of the terrain's body, in which the shape's body is placed by `placed`, and normals point from
// the facet to the shape. A facet that is not two-sided meets only shapes whose centre is not behind it, and
// only from its front: where they overlap, the way out is the shortest of those that do not lead backwards,
// and where they meet along a direction that does lead backwards, they do not meet. How far backwards still
// counts as sideways:
constexpr double backward_slack = 1e-6;

/// The contact manifold of a shape and one facet (see `collide_shapes`). Its features name a corner, edge or
/// face of each of the two.
template <int D>
Manifold<D> collide_facet(const Shape<D>& convex, const Facet<D>& facet, const Transform<D>& placed,
                          double reach, const Vec<D>& axis = {});

/// The gap between the facet and a shape along `axis` (see `gap_along`).
template <int D>
double gap_along(const Shape<D>& convex, const Facet<D>& facet, const Transform<D>& placed,
                 const Vec<D>& axis);

/// Gap or depth of a shape and one facet (see `separate_shapes`), and the direction from the facet to the
/// shape. Nothing when the facet does not meet the shape, however near it may be.
template <int D>
std::optional<Separation<D>> separate_facet(const Shape<D>& convex, const Facet<D>& facet,
                                            const Transform<D>& placed);

/// Entries of the shape-pair matrix: those of the facet that is nearest to the shape, or overlaps it most;
/// of equals, the one that the terrain names first.
template <int D>
Manifold<D> collide_terrain(const Shape<D>& a, const Shape<D>& terrain, const Transform<D>& terrain_in_a,
                            double reach, const Vec<D>& axis);
template <int D>
std::optional<Separation<D>> separate_from_terrain(const Shape<D>& a, const Shape<D>& terrain,
                                                   const Transform<D>& terrain_in_a);

}  // namespace carom::detail
