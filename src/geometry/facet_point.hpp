#pragma once

#include <algorithm>

#include "geometry/terrain.hpp"

namespace carom::detail {

/// The point of the segment nearest to p.
inline Vec2 nearest_point(const Facet<2>& segment, const Vec2& p) {
    const Vec2 along = segment.points[1] - segment.points[0];
    const double share = dot(p - segment.points[0], along) / dot(along, along);
    return segment.points[0] + std::clamp(share, 0.0, 1.0) * along;
}

/// The point of the triangle nearest to p: by the regions of its corners, sides and face (C. Ericson,
/// Real-Time Collision Detection, 2005, section 5.1.5).
inline Vec3 nearest_point(const Facet<3>& triangle, const Vec3& p) {
    const auto& [a, b, c] = triangle.points;
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3) return b;
    const double beyond_ab = d1 * d4 - d3 * d2;
    if (beyond_ab <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
    const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6) return c;
    const double beyond_ac = d5 * d2 - d1 * d6;
    if (beyond_ac <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
    const double beyond_bc = d3 * d6 - d5 * d4;
    if (beyond_bc <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
    const double sum = beyond_ab + beyond_ac + beyond_bc;
    return a + (beyond_ac / sum) * ab + (beyond_ab / sum) * ac;
}

template <int D>
double distance_to_facet(const Facet<D>& facet, const Vec<D>& p) {
    return length(p - nearest_point(facet, p));
}

}  // namespace carom::detail
