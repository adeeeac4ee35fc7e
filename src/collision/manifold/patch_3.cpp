#include "collision/manifold/patch_3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "collision/manifold/reduce.hpp"

namespace carom::detail {

namespace {

using Corners = std::pmr::vector<FacetCorner>;
using Points = std::pmr::vector<ManifoldPoint<3>>;

/// A face counts as facing the contact when its normal is within 2.5 degrees of the contact's, and two edges
/// count as parallel when they are within 3 degrees of each other.
constexpr double facing_cosine = 0.999;
constexpr double parallel_sine = 0.05;

/// Corners and crossings that are nearer to a side than this share of the smaller facet count as on it, so
/// that faces which fit each other keep their features while the bodies tremble.
constexpr double snap_share = 1e-4;

/// Room for the common case; larger facets spill to the heap.
struct Memory {
    alignas(std::max_align_t) std::array<std::byte, 24 * 1024> bytes;
    std::pmr::monotonic_buffer_resource resource{bytes.data(), bytes.size()};
};

/// Two facets that meet, and how far their surfaces lie above them.
struct Meeting {
    const Facet3& a;
    const Facet3& b;
    double radius_a, radius_b;
    const Nearest3& nearest;

    double snap() const { return snap_share * std::min(a.extent, b.extent); }
    /// Is the gap that a patch has found the one that was to be found?
    bool confirms(double gap) const {
        const double size = std::min(a.extent, b.extent);
        const double depth = std::fabs(nearest.distance - radius_a - radius_b);
        return std::fabs(gap - nearest.distance) <= 0.05 * depth + 1e-5 * std::min(size, 1e100);
    }
};

/// A source names a side of one of the two facets. A point of the patch is named by the facets and by the two
/// sides that cross there: both of one facet for its own corner, one of each for a crossing. So the name is
/// the same whichever of the two facets was clipped.
std::uint32_t source_of(bool of_b, std::uint32_t side) { return 2 * side + (of_b ? 1 : 0); }

std::uint32_t feature_of(const Meeting& meeting, std::uint32_t source, std::uint32_t other) {
    return (meeting.a.id & 0xffu) << 24 | (meeting.b.id & 0xffu) << 16 | (source & 0xffu) << 8 |
           (other & 0xffu);
}

/// A side of a face seen as a half-space: the height of a point outside it.
struct Side {
    Vec3 origin{}, out{};
    double height(const Vec3& p) const { return dot(out, p - origin); }
};

/// The side from corner i on; its `out` is zero when the two corners coincide.
Side side_of(const Facet3& face, std::size_t i) {
    const Vec3& from = face.corners[i].position;
    const Vec3& to = face.corners[(i + 1) % face.corners.size()].position;
    return {from, normalized(cross(to - from, face.normal))};
}

/// Cuts off what lies outside the side; corners within `snap` of it stay as they are.
void clip_polygon(const Corners& polygon, const Side& side, std::uint32_t source, double snap,
                  Corners& kept) {
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const FacetCorner& p = polygon[i];
        const FacetCorner& q = polygon[(i + 1) % polygon.size()];
        const double p_height = side.height(p.position), q_height = side.height(q.position);
        const bool p_inside = p_height <= snap, q_inside = q_height <= snap;
        const Vec3 crossing = p.position + (p_height / (p_height - q_height)) * (q.position - p.position);
        if (p_inside) kept.push_back(p);
        if (p_inside && !q_inside) {
            if (p_height < -snap) {
                kept.push_back({crossing, source});
            } else {
                kept.back().side = source;
            }
        }
        if (!p_inside && q_inside && q_height < -snap) kept.push_back({crossing, p.side});
    }
}

/// The part of `flat` (a polygon, or an edge) over the face `base`. The corners' sides become sources.
void clip(const Facet3& base, bool base_is_b, const Facet3& flat, double snap, Corners& kept,
          Corners& spare) {
    const std::size_t room = base.corners.size() + flat.corners.size() + 1;
    kept.reserve(room);
    spare.reserve(room);
    for (const FacetCorner& corner : flat.corners)
        kept.push_back({corner.position, source_of(!base_is_b, corner.side)});
    for (std::size_t i = 0; i < base.corners.size() && !kept.empty(); ++i) {
        const Side side = side_of(base, i);
        clip_polygon(kept, side, source_of(base_is_b, base.corners[i].side), snap, spare);
        std::swap(kept, spare);
    }
}

/// Does the disk lie over the face, but for what the polygons inscribed in them cut off?
bool lies_over(const Facet3& disk, const Facet3& base) {
    const double slack = 0.005 * disk.extent;
    for (std::size_t i = 0; i < base.corners.size(); ++i) {
        const Side side = side_of(base, i);
        for (std::size_t k = 0; k < disk.corners.size(); k += disk_corners / 4) {
            if (side.height(disk.corners[k].position) > slack) return false;
        }
    }
    return true;
}

/// The area over one of the two faces, or nothing when that face is not where the shapes are nearest.
bool face_patch(const Meeting& meeting, bool base_is_b, double reach, Manifold<3>& manifold) {
    const Facet3& base = base_is_b ? meeting.b : meeting.a;
    const Facet3& flat = base_is_b ? meeting.a : meeting.b;
    const bool flat_is_edge = flat.form == Facet3::Form::edge;
    const double snap = meeting.snap();

    Memory memory;
    Corners kept(&memory.resource), spare(&memory.resource);
    if (flat.form == Facet3::Form::disk && lies_over(flat, base)) {
        for (std::size_t i = 0; i < flat.corners.size(); i += disk_corners / 4)
            kept.push_back({flat.corners[i].position, source_of(!base_is_b, flat.corners[i].side)});
    } else {
        clip(base, base_is_b, flat, snap, kept, spare);
    }

    const double radii = meeting.radius_a + meeting.radius_b;
    const double lift = base_is_b ? meeting.radius_b - meeting.radius_a : meeting.radius_a - meeting.radius_b;
    double least = 1e300;
    Points points(&memory.resource);
    points.reserve(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const Vec3& p = kept[i].position;
        const double gap = dot(base.normal, p) - base.offset;
        least = std::min(least, gap);
        if (gap - radii > reach) continue;
        // The two faces run round the patch in opposite senses, so the order of the sides does not count;
        // that of an edge does, as its two corners have the same two.
        std::uint32_t before = kept[(i + kept.size() - 1) % kept.size()].side, after = kept[i].side;
        if (!flat_is_edge && before > after) std::swap(before, after);
        points.push_back(
            {p + (0.5 * (lift - gap)) * base.normal, gap - radii, feature_of(meeting, before, after)});
    }
    if (points.empty() || !meeting.confirms(least)) return false;
    points.resize(merge_points<3>(points, snap));
    manifold = manifold_of<3>(points, base_is_b ? -base.normal : base.normal);
    manifold.normal_of = base_is_b ? NormalOf::second : NormalOf::first;
    return true;
}

/// The two ends of an edge, or of the side of a face, that looks most along `direction`.
struct Line {
    Vec3 from, to;
    std::uint32_t side;
};

Line line_along(const Facet3& facet, const Vec3& direction) {
    const std::size_t count = facet.form == Facet3::Form::edge ? 1 : facet.corners.size();
    Line best{};
    double reached = -1e300;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3& from = facet.corners[i].position;
        const Vec3& to = facet.corners[(i + 1) % facet.corners.size()].position;
        if (dot(direction, from + to) > reached) {
            reached = dot(direction, from + to);
            best = {from, to, facet.corners[i].side};
        }
    }
    return best;
}

/// The ends of the line that two parallel edges share, or nothing when there is none.
bool edge_patch(const Meeting& meeting, double reach, Manifold<3>& manifold) {
    const Vec3& normal = meeting.nearest.normal;
    if (meeting.a.form == Facet3::Form::plane || meeting.b.form == Facet3::Form::plane) return false;
    const Line a = line_along(meeting.a, normal), b = line_along(meeting.b, -normal);
    const Vec3 u = a.to - a.from, v = b.to - b.from;
    const double u_length = length(u), v_length = length(v);
    if (std::fabs(dot(u, normal)) > parallel_sine * u_length ||
        std::fabs(dot(v, normal)) > parallel_sine * v_length ||
        length(cross(u, v)) > parallel_sine * u_length * v_length || u_length == 0 || v_length == 0) {
        return false;
    }
    const Vec3 along = u / u_length;
    const double start = dot(along, b.from - a.from), end = dot(along, b.to - a.from);
    const double low = std::max(0.0, std::min(start, end)), high = std::min(u_length, std::max(start, end));
    if (high - low <= meeting.snap()) return false;

    const double radii = meeting.radius_a + meeting.radius_b;
    manifold = {};
    manifold.normal = normal;
    double least = 1e300;
    for (const double place : {low, high}) {
        const Vec3 on_a = a.from + place * along;
        const Vec3 on_b = b.from + ((place - start) / (end - start)) * v;
        const double gap = dot(normal, on_b - on_a);
        least = std::min(least, gap);
        if (gap - radii > reach) continue;
        const Vec3 middle = 0.5 * (on_a + on_b + (meeting.radius_a - meeting.radius_b) * normal);
        const std::uint32_t feature = feature_of(meeting, source_of(false, a.side), source_of(true, b.side));
        manifold.points[static_cast<std::size_t>(manifold.count++)] = {
            middle, gap - radii, feature ^ (place == low ? 0u : 0x8080u)};
    }
    return meeting.confirms(least) && manifold.count > 0;
}

}  // namespace

Manifold<3> contact_point(const Pair3& pair, const Nearest3& nearest, double reach) {
    const double radius_a = core_radius(pair.a), radius_b = core_radius(pair.b);
    const double separation = nearest.distance - radius_a - radius_b;
    Manifold<3> manifold;
    manifold.normal = nearest.normal;
    if (separation > reach) return manifold;
    const Vec3 middle = 0.5 * (nearest.on_a + nearest.on_b + (radius_a - radius_b) * nearest.normal);
    manifold.points[0] = {middle, separation, 0};
    manifold.count = 1;
    return manifold;
}

namespace {

/// Does the facet look along `direction`? Two for a plane, which must be the base.
double facing(const Facet3& facet, const Vec3& direction) {
    if (facet.form == Facet3::Form::plane) return 2;
    return facet.form == Facet3::Form::edge ? -1 : dot(facet.normal, direction);
}

}  // namespace

std::optional<Manifold<3>> contact_patch(const Pair3& pair, const Nearest3& nearest, double reach) {
    if (pair.a.kind == ShapeKind::ball || pair.b.kind == ShapeKind::ball)
        return contact_point(pair, nearest, reach);

    Memory memory;
    Facet3 a(memory.resource), b(memory.resource);
    find_facet(pair.a, nearest.normal, a);
    find_facet(pair.b, unrotate(pair.b_in_a.rotation, -nearest.normal), b);
    move_facet(b, pair.b_in_a);

    const Meeting meeting{a, b, core_radius(pair.a), core_radius(pair.b), nearest};
    const double a_facing = facing(a, nearest.normal), b_facing = facing(b, -nearest.normal);
    // Parallel faces are told apart by rounding alone: then a's is the base, unless it is a disk within b's.
    const bool both = std::min(a_facing, b_facing) >= facing_cosine;
    const bool a_within = both && a.form == Facet3::Form::disk && lies_over(a, b);
    const bool b_first = a_within || b_facing > a_facing + 1e-10;
    Manifold<3> manifold;
    for (const bool base_is_b : {b_first, !b_first}) {
        if ((base_is_b ? b_facing : a_facing) < facing_cosine) continue;
        if (face_patch(meeting, base_is_b, reach, manifold)) return manifold;
    }
    if (!nearest.certain) return std::nullopt;
    return edge_patch(meeting, reach, manifold) ? manifold : contact_point(pair, nearest, reach);
}

}  // namespace carom::detail
