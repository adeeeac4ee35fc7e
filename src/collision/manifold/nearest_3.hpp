#pragma once

#include "collision/gjk.hpp"
#include "collision/manifold.hpp"
#include "math/dim.hpp"

namespace carom::detail {

// Collision in space goes in two steps. First a routine for the pair of kinds finds along which direction,
// and by how much, the cores of the two shapes are nearest to being apart. Then contact_patch (patch_3.hpp),
// which knows shapes only by their faces and edges, makes the manifold across that direction.

/// Two shapes; the second stands in the frame of the first.
struct Pair3 {
    const Shape<3>& a;
    const Shape<3>& b;
    const Transform<3>& b_in_a;
};

/// What the answer is for.
struct Search3 {
    double limit;  ///< a gap between the cores beyond which the answer no longer matters
    bool steady;   ///< among directions of nearly equal gap, prefer faces to edges and a's faces to b's
    Vec3 axis;     ///< from a to b, about a unit vector, where the answer may lie near; or zero
};

/// Along which direction two cores are nearest to being apart. All in a's frame.
struct Nearest3 {
    Vec3 normal{};        ///< unit vector from a to b
    double distance = 0;  ///< gap between the cores along it; negative where they overlap
    Vec3 on_a{};          ///< points of the cores that face each other there
    Vec3 on_b{};
    /// False where only the direction is known: the points may lie beside each other, and cores that are
    /// apart may be further apart than along any face's normal.
    bool certain = true;
};

using NearestRoutine3 = Nearest3 (*)(const Pair3&, const Search3&);

// The routines, by the form of the cores: a ball's is a point, a capsule's a segment, that of a box or hull a
// polyhedron; a cylinder or cone is a body of revolution.
Nearest3 point_point(const Pair3& pair, const Search3& search);
Nearest3 point_segment(const Pair3& pair, const Search3& search);
Nearest3 point_box(const Pair3& pair, const Search3& search);
Nearest3 point_polyhedron(const Pair3& pair, const Search3& search);
Nearest3 point_revolved(const Pair3& pair, const Search3& search);
Nearest3 segment_segment(const Pair3& pair, const Search3& search);
Nearest3 segment_polyhedron(const Pair3& pair, const Search3& search);
Nearest3 box_box(const Pair3& pair, const Search3& search);
Nearest3 polyhedron_polyhedron(const Pair3& pair, const Search3& search);
Nearest3 core_revolved(const Pair3& pair, const Search3& search);
Nearest3 core_plane(const Pair3& pair, const Search3& search);

/// Makes an answer certain that was found over the normals of faces and pairs of edges.
Nearest3 made_certain(const Pair3& pair, const Nearest3& found);

/// The gap between the cores along the unit vector `normal`, with the points that bound it.
inline Nearest3 gap_along(const Pair3& pair, const Vec3& normal) {
    const SimplexVertex<3> extreme = difference_support<3>(pair.a, pair.b, pair.b_in_a, normal);
    return {normal, -dot(normal, extreme.difference), extreme.on_a, extreme.on_b};
}

/// What was found in b's frame with the shapes exchanged, as seen from a.
inline Nearest3 exchanged(const Nearest3& found, const Transform<3>& b_in_a) {
    return {-rotate(b_in_a.rotation, found.normal), found.distance, apply(b_in_a, found.on_b),
            apply(b_in_a, found.on_a), found.certain};
}

/// How much longer a gap must be to be preferred to one that is favoured.
inline double advantage(const Pair3& pair, const Search3& search, double distance, double extent) {
    if (!search.steady) return 1e-12 * extent;
    const double radii = core_radius(pair.a) + core_radius(pair.b);
    return 0.05 * std::fabs(distance - radii) + 1e-6 * extent;
}

/// A length of the order of the core's size; zero for a point.
double core_extent(const Shape<3>& shape);

/// A unit vector across the unit vector `v`. It turns without a jump near the axes of the frame.
inline Vec3 any_perpendicular(const Vec3& v) { return tangents<3>(v)[0]; }

/// The points of two segments p + s·u and q + t·v, 0 ≤ s, t ≤ 1, that are closest to each other.
struct SegmentPoints {
    double s, t;
};
SegmentPoints closest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v);

}  // namespace carom::detail
