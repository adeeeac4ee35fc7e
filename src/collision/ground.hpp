#pragma once

#include <optional>

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

// Queries of terrain, which has no inside: what counts is its segments or triangles. The nearest point is
// that of either side. What moves meets a facet that is not two-sided from its front alone.

/// See `cast_ray`.
template <int D>
std::optional<CastHit<D>> cast_ray_at_ground(const Shape<D>& ground, const Vec<D>& origin,
                                             const Vec<D>& translation);

/// See `nearest_point`.
template <int D>
Vec<D> nearest_on_ground(const Shape<D>& ground, const Vec<D>& point);

/// See `closest_points`; the frame is the ground's.
template <int D>
ClosestPoints<D> closest_to_ground(const Shape<D>& ground, const Shape<D>& b, const Transform<D>& b_placed);

/// See `cast_shape`; the hit is one of the ground.
template <int D>
std::optional<CastHit<D>> cast_at_ground(const Shape<D>& ground, const Shape<D>& b,
                                         const Transform<D>& b_placed, const Vec<D>& translation);

/// See `time_of_impact`; the hit is one of the ground, whatever the order.
template <int D>
std::optional<CastHit<D>> impact_with_ground(const Shape<D>& ground, const Sweep<D>& ground_sweep,
                                             const Shape<D>& b, const Sweep<D>& b_sweep, double tolerance);

}  // namespace carom::detail
