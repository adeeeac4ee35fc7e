#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include "collision/manifold/heights_3.hpp"
#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

constexpr std::size_t none = std::size_t(-1);
constexpr Nearest3 nothing{{}, -1e300, {}, {}};

/// The face of one polyhedron that another is furthest in front of, and the corner of that which is furthest
/// behind it. All in the frame of the face.
struct FaceGap {
    double gap;
    Vec3 corner;
    std::size_t face = none;
};

/// Corners of a polyhedron that are nearest to another one or deepest in it, each over some face.
struct NearCorners {
    static constexpr std::size_t most = 6;
    std::array<Vec3, most> places;
    std::size_t found = 0;  ///< if there were more than room for, the last ones are kept

    void add(const Vec3& corner) { places[found++ % most] = corner; }
    std::span<const Vec3> all() const { return std::span(places).first(std::min(found, most)); }
};

/// Looks for a wider gap than `best` has along the normals of a's faces, b's corners being placed in a's
/// frame by `b_in_a`. No gap is more than the height of any of b's points over the face (`heights` are those
/// of the first `best.corner`), which spares most faces the look at all of b's corners. The face over which
/// it is highest is looked at first: no other is likely to show a wider gap. Of equal ones the first counts;
/// heights are trusted but for rounding, so that the order makes no difference.
FaceGap widest_over_faces(const Polyhedron& a, const Polyhedron& b, const Transform3& b_in_a,
                          const Heights3& heights, FaceGap best, double limit, NearCorners& corners,
                          Memory3& memory) {
    const double rounding =
        1e-13 * (length(b_in_a.position) + length(a.middle) + a.extent + length(b.middle) + b.extent);
    std::pmr::vector<std::uint32_t> faces(a.normals.size(), &memory.resource);
    const std::size_t count = heights.list_above(best.gap - rounding, a.normals.size(), faces.data());
    std::size_t highest = 0;
    for (std::size_t i = 1; i < count; ++i) {
        if (heights[faces[i]] > heights[faces[highest]]) highest = i;
    }
    std::swap(faces[0], faces[highest]);
    for (std::size_t i = 0; i < count && best.gap <= limit; ++i) {
        const std::size_t f = faces[i];
        const Vec3& outwards = a.normals[f];
        const double needed = best.gap - rounding;
        const auto is_below = [&](const Vec3& corner) {
            return dot(outwards, corner) - a.offsets[f] < needed;
        };
        if (heights[f] < needed) continue;
        if (std::ranges::any_of(corners.all(), is_below)) continue;
        const Vec3 normal = unrotate(b_in_a.rotation, outwards);
        const Vec3& lowest = b.vertices[furthest_corner(b, -normal)];
        const double base = dot(outwards, b_in_a.position) - a.offsets[f];
        const double gap = base + dot(normal, lowest);
        const Vec3 corner = apply(b_in_a, lowest);
        corners.add(corner);
        if (gap > best.gap || (gap == best.gap && best.face != none && f < best.face))
            best = {gap, corner, f};
    }
    return best;
}

Nearest3 at_face(const Polyhedron& core, const FaceGap& found) {
    const Vec3& normal = core.normals[found.face];
    return {normal, found.gap, found.corner - found.gap * normal, found.corner, false};
}

/// An edge of a polyhedron with the normals of the faces on its left and right.
struct Arc {
    Vec3 start, along, left, right;
};
using Arcs = std::pmr::vector<Arc>;

/// Takes vectors to the frame in which `t` is placed, where many are to be.
class Carrier {
  public:
    explicit Carrier(const Transform3& t)
        : x_(rotate(t.rotation, {1, 0, 0})),
          y_(rotate(t.rotation, {0, 1, 0})),
          z_(rotate(t.rotation, {0, 0, 1})),
          origin_(t.position) {}
    Vec3 direction(const Vec3& v) const { return v.x * x_ + v.y * y_ + v.z * z_; }
    Vec3 point(const Vec3& v) const { return origin_ + direction(v); }

  private:
    Vec3 x_, y_, z_, origin_;
};
/// Leaves them as they are.
struct StaysHere {
    static const Vec3& direction(const Vec3& v) { return v; }
    static const Vec3& point(const Vec3& v) { return v; }
};

/// The edges, carried along, that can part the polyhedron by more than `gap` from another one, of which a
/// point has these heights over the faces and `corners` are some. Each corner spares far more pairs of edges
/// than it costs.
template <class Carry>
Arcs find_arcs(const Polyhedron& core, const Carry& carry, const Heights3& heights,
               const NearCorners& corners, double gap, Memory3& memory) {
    const double needed = std::min(gap, 0.0) - core.unevenness;
    std::pmr::vector<std::uint8_t> seen(core.normals.size(), &memory.resource);  // a bit a point
    std::uint8_t all = 0;
    const auto look_from = [&](const Heights3& over) {
        const int bit = all + 1;
        for (std::size_t f = 0; f < seen.size(); ++f)
            seen[f] = static_cast<std::uint8_t>(seen[f] | (over[f] >= needed ? bit : 0));
        all = static_cast<std::uint8_t>(all | bit);
    };
    look_from(heights);
    for (const Vec3& corner : corners.all()) look_from(Heights3(core, corner, memory));
    std::pmr::vector<const Polyhedron::Edge*> kept(core.edges.size(), &memory.resource);
    std::size_t count = 0;
    for (const Polyhedron::Edge& edge : core.edges) {
        kept[count] = &edge;
        count += (seen[edge.left] | seen[edge.right]) == all;
    }
    Arcs arcs(count, &memory.resource);
    for (std::size_t i = 0; i < count; ++i) {
        const Polyhedron::Edge& edge = *kept[i];
        const Vec3& from = core.vertices[edge.from];
        arcs[i] = {carry.point(from), carry.direction(core.vertices[edge.to] - from),
                   carry.direction(core.normals[edge.left]), carry.direction(core.normals[edge.right])};
    }
    return arcs;
}

/// Do the arcs of the Gauss map, from a's normal on the left to that on the right and between the opposites
/// of b's, cross? If not, the two edges make no face of the difference a − b. Along its left face's boundary
/// an edge runs in the direction of left × right, so the edges serve for the products of the normals
/// (Gregorius, The Separating Axis Test between Convex Polyhedra, 2013).
bool cross_on_gauss_map(const Arc& a, const Arc& b) {
    const double left_of_b = dot(b.left, a.along);
    if (left_of_b * dot(b.right, a.along) >= 0) return false;
    const double right_of_a = dot(a.right, b.along);
    return dot(a.left, b.along) * right_of_a < 0 && left_of_b * right_of_a < 0;
}

/// The widest gap across an edge of a and one of b. In a's frame.
Nearest3 widest_over_edges(const Arcs& arcs_a, const Arcs& arcs_b) {
    Nearest3 widest = nothing;
    for (const Arc& arc_a : arcs_a) {
        for (const Arc& arc_b : arcs_b) {
            if (!cross_on_gauss_map(arc_a, arc_b)) continue;
            Vec3 normal = cross(arc_a.along, arc_b.along);
            const double size = length(normal);
            if (size <= 1e-7 * length(arc_a.along) * length(arc_b.along)) continue;
            normal = normal / (dot(normal, arc_a.left + arc_a.right) < 0 ? -size : size);
            const double candidate = dot(normal, arc_b.start - arc_a.start);
            if (candidate <= widest.distance) continue;
            const SegmentPoints at = closest_on_segments(arc_a.start, arc_a.along, arc_b.start, arc_b.along);
            const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
            widest = {normal, candidate, arc_a.start + at.s * arc_a.along, arc_b.start + at.t * arc_b.along,
                      candidate <= 0 || inside};
        }
    }
    return widest;
}

/// A unit vector from a to b along which they may be nearest: as the search says, or between their middles.
Vec3 start_axis(const Pair3& pair, const Vec3& axis) {
    if (axis != Vec3{}) return normalized(axis);
    const Vec3 between = apply(pair.b_in_a, pair.b.core->middle) - pair.a.core->middle;
    return between != Vec3{} ? normalized(between) : Vec3{0, 1, 0};
}

/// Where the widest gap of all is at least `known`, the least that one may have and be preferred to it (see
/// `advantage`), with room for corners that stand out of their faces and for rounding. Shapes that are apart
/// are all treated as if they touched, since no face or edge may show more of the gap between two corners.
double least_of_interest(const Pair3& pair, double known) {
    const Polyhedron &a = *pair.a.core, &b = *pair.b.core;
    const double radii = core_radius(pair.a) + core_radius(pair.b);
    const double room = a.unevenness + b.unevenness + 1e-6 * std::max(a.extent, b.extent);
    return radii + (std::min(known, 0.0) - radii) / 0.95 - 2 * room;
}

}  // namespace

// The gap along any direction bounds the widest from below, and the heights of points of the one over faces
// of the other bound from above what can be found there. So with a good direction to begin with, few faces
// and edges are left to look at; the answer does not depend on it.
Nearest3 polyhedron_polyhedron(const Pair3& pair, const Search3& search) {
    const Polyhedron &a = *pair.a.core, &b = *pair.b.core;
    const Transform3& b_in_a = pair.b_in_a;
    const Transform3 a_in_b = inverse(b_in_a);
    const double extent = std::min(a.extent, b.extent);
    const Nearest3 start = gap_along(pair, start_axis(pair, search.axis));
    if (start.distance > search.limit) return start;
    const double least = least_of_interest(pair, start.distance);

    Memory3 memory;
    const Heights3 over_a(a, start.on_b, memory);
    NearCorners of_b_near_a, of_a_near_b;
    const FaceGap of_a =
        widest_over_faces(a, b, b_in_a, over_a, {least, start.on_b}, search.limit, of_b_near_a, memory);
    if (of_a.gap > search.limit) return at_face(a, of_a);
    const Vec3 near_a = apply(a_in_b, start.on_a);
    const Heights3 over_b(b, near_a, memory);
    const FaceGap of_b =
        widest_over_faces(b, a, a_in_b, over_b, {of_a.gap, near_a}, search.limit, of_a_near_b, memory);
    if (of_b.gap > search.limit) return exchanged(at_face(b, of_b), b_in_a);

    // A face of a is favoured if no other gap is wider by more than the advantage, or else a face of b.
    const auto favoured_up_to = [&](const FaceGap& found) {
        return found.face == none ? -1e300 : found.gap + advantage(pair, search, found.gap, extent);
    };
    const double up_to_a = favoured_up_to(of_a), up_to_b = favoured_up_to(of_b);
    const bool a_leads = up_to_a >= of_b.gap;
    const double needed = std::max(of_b.gap, a_leads ? up_to_a : up_to_b);
    const Arcs arcs_a = find_arcs(a, StaysHere{}, over_a, of_b_near_a, needed, memory);
    Nearest3 of_edges = nothing;
    if (!arcs_a.empty())
        of_edges =
            widest_over_edges(arcs_a, find_arcs(b, Carrier(b_in_a), over_b, of_a_near_b, needed, memory));
    if (a_leads && up_to_a >= of_edges.distance) return at_face(a, of_a);
    return up_to_b >= of_edges.distance ? exchanged(at_face(b, of_b), b_in_a) : of_edges;
}

Nearest3 made_certain(const Pair3& pair, const Nearest3& found) {
    if (found.certain) return found;
    // Cores that overlap are first moved apart along the normal: then their closest points face each other
    // along it.
    const double extent = core_extent(pair.a) + core_extent(pair.b);
    const Vec3 shift = found.distance > 0 ? Vec3{} : (1e-3 * extent - found.distance) * found.normal;
    const Transform3 moved{pair.b_in_a.position + shift, pair.b_in_a.rotation};
    const CoreDistance<3> closest = core_distance<3>(pair.a, pair.b, moved);
    Nearest3 result = found;
    result.certain = true;
    if (closest.overlap) return result;
    result.on_a = closest.on_a;
    result.on_b = closest.on_b - shift;
    // Rounding blurs the direction between closest points that all but touch: then it shows less of a gap.
    if (found.distance > 0 && closest.distance > found.distance + 1e-9 * extent &&
        gap_along(pair, closest.axis).distance > found.distance) {
        result.normal = closest.axis;
        result.distance = closest.distance;
    }
    return result;
}

double core_extent(const Shape<3>& shape) {
    switch (shape.kind) {
        case ShapeKind::capsule:
            return length(shape.b - shape.a);
        case ShapeKind::box:
            return length(shape.b);
        case ShapeKind::hull:
        case ShapeKind::facet:
            return shape.core->extent;
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return shape.radius + shape.half_height;
        case ShapeKind::ball:
        case ShapeKind::plane:
        case ShapeKind::terrain:
            return 0;
    }
    return 0;
}

}  // namespace carom::detail
