#pragma once

#include "collision/manifold.hpp"

namespace carom::detail {

// The routines of the 2D shape-pair matrix.

/// Ball, capsule, box or hull against any of these.
std::optional<Separation<2>> separate_outlines(const Shape<2>& a, const Shape<2>& b,
                                               const Transform<2>& b_in_a);
/// Ball, capsule, box or hull against any of these: one point or two.
Manifold<2> collide_outlines(const Shape<2>& a, const Shape<2>& b, const Transform<2>& b_in_a, double reach,
                             const Vec2& axis);
/// Ball, capsule, box or hull against a plane.
std::optional<Separation<2>> separate_from_plane(const Shape<2>& a, const Shape<2>& plane,
                                                 const Transform<2>& plane_in_a);
Manifold<2> collide_with_plane(const Shape<2>& a, const Shape<2>& plane, const Transform<2>& plane_in_a,
                               double reach, const Vec2& axis);

/// Name of the contact of a corner of a and a corner of b, or of the edges that they end.
constexpr std::uint32_t feature_id(int corner_a, int corner_b) {
    return std::uint32_t(corner_a) << 16 | (std::uint32_t(corner_b) & 0xffffu);
}

}  // namespace carom::detail
