#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/facet.hpp"
#include "collision/manifold/heights_3.hpp"
#include "collision/manifold/patch_3.hpp"
#include "geometry/hull.hpp"

namespace carom::detail {

namespace {

/// An edge of the triangle, and an arc of normals round it: from the front (or the edge's own side) on the
/// left to its side (or the back) on the right. See `Polyhedron::Edge`.
struct Arc {
    Vec3 start, along, left, right;
};

/// A triangle in the frame of the shape that it meets, also as a flat polyhedron.
class Triangle {
  public:
    /// The triangle as a shape is made anew in the same place each time, so that nothing is allocated.
    Triangle(const Facet<3>& facet, const Vec3& front, const Transform3& placed)
        : two_sided(facet.two_sided), normal(unrotate(placed.rotation, front)) {
        thread_local const std::shared_ptr<Polyhedron> core = std::make_shared<Polyhedron>();
        core->vertices.clear();
        for (const Vec3& p : facet.points) core->vertices.push_back(apply_inverse(placed, p));
        const std::vector<Vec3>& v = core->vertices;
        core->normals.assign({normal});
        core->offsets.assign({dot(normal, v[0])});
        core->indices.assign({0, 1, 2});
        core->first.assign({0, 3});
        if (two_sided) {
            core->normals.push_back(-normal);
            core->offsets.push_back(-core->offsets[0]);
            core->indices.insert(core->indices.end(), {0, 2, 1});
            core->first.push_back(6);
        }
        measure(*core);
        shape.kind = ShapeKind::facet;
        shape.a = (v[0] + v[1] + v[2]) / 3;
        shape.core = core;
    }

    const Vec3& corner(std::size_t i) const { return shape.core->vertices[i % 3]; }
    double height(const Vec3& p) const { return dot(normal, p) - shape.core->offsets[0]; }
    /// Out of the triangle across the edge from corner i on.
    Vec3 side(std::size_t i) const { return normalized(cross(corner(i + 1) - corner(i), normal)); }
    bool looks_back(const Vec3& n) const { return !two_sided && dot(n, normal) < -backward_slack; }

    /// The arcs between front and side, and a little further; those between side and back.
    Arc front_arc(std::size_t i) const {
        return {corner(i), corner(i + 1) - corner(i), normal, side(i) - backward_slack * normal};
    }
    Arc back_arc(std::size_t i) const {
        return {corner(i), corner(i + 1) - corner(i), side(i) + backward_slack * normal, -normal};
    }

    bool two_sided;
    Vec3 normal;
    Shape<3> shape;
};

/// The widest gap found so far, and what is only known to part the two.
class Widest {
  public:
    explicit Widest(const Triangle& triangle) : triangle_(triangle) {
        best_.distance = -std::numeric_limits<double>::infinity();
    }

    void offer(const Nearest3& candidate, double advantage = 0) {
        if (triangle_.looks_back(candidate.normal)) {
            // Shapes that are apart do not overlap, even if what parts them is not a way out.
            if (candidate.distance > 0) parted_ = candidate;
        } else if (candidate.distance > best_.distance + advantage) {
            best_ = candidate;
        }
    }
    double distance() const { return best_.distance; }
    Nearest3 result() const {
        if (best_.distance > 0 || !(parted_.distance > 0)) return best_;
        Nearest3 parted = parted_;
        parted.certain = false;
        return parted;
    }

  private:
    const Triangle& triangle_;
    Nearest3 best_, parted_;
};

/// The gap across an edge of the triangle and an edge of the other shape that makes a pair with it.
Nearest3 across(const Arc& arc, const Vec3& start, const Vec3& along) {
    Nearest3 nothing;
    nothing.distance = -std::numeric_limits<double>::infinity();
    Vec3 normal = cross(arc.along, along);
    const double size = length(normal);
    if (size <= 1e-8 * length(arc.along) * length(along)) return nothing;
    normal = normal / (dot(normal, arc.left + arc.right) < 0 ? -size : size);
    const double gap = dot(normal, start - arc.start);
    const SegmentPoints at = closest_on_segments(arc.start, arc.along, start, along);
    const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
    return {normal, gap, arc.start + at.s * arc.along, start + at.t * along, gap <= 0 || inside};
}

Nearest3 triangle_point(const Triangle& triangle, const Vec3& p) {
    const double height = triangle.height(p);
    std::array<bool, 3> outside;
    for (std::size_t i = 0; i < 3; ++i)
        outside[i] = dot(cross(triangle.corner(i + 1) - triangle.corner(i), triangle.normal),
                         p - triangle.corner(i)) > 0;
    if (!outside[0] && !outside[1] && !outside[2]) {
        const Vec3 normal = height < 0 ? -triangle.normal : triangle.normal;
        return {normal, std::fabs(height), p - height * triangle.normal, p};
    }
    Vec3 closest{};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        if (!outside[i]) continue;
        const Vec3 along = triangle.corner(i + 1) - triangle.corner(i);
        const double share = std::clamp(dot(p - triangle.corner(i), along) / length_squared(along), 0.0, 1.0);
        const Vec3 q = triangle.corner(i) + share * along;
        if (length_squared(p - q) >= least) continue;
        least = length_squared(p - q);
        closest = q;
    }
    // A point on the edge has no direction from it but for rounding.
    const double distance = std::sqrt(least);
    const bool touching =
        distance <= 1e-12 * (length(p) + length(closest)) + 1e-10 * core_extent(triangle.shape);
    const Vec3 normal = touching ? triangle.normal : (p - closest) / distance;
    return {normal, distance, closest, p};
}

Nearest3 triangle_segment(const Triangle& triangle, const Shape<3>& capsule, const Pair3& pair,
                          const Search3& search) {
    const Vec3 &from = capsule.a, &to = capsule.b, along = to - from;
    Widest widest(triangle);
    for (const double side : {1.0, -1.0}) {
        const double at_from = side * triangle.height(from), at_to = side * triangle.height(to);
        const Vec3& lower = at_from <= at_to ? from : to;
        const double gap = std::min(at_from, at_to);
        widest.offer({side * triangle.normal, gap, lower - side * gap * triangle.normal, lower, false});
    }
    if (widest.distance() > search.limit) return widest.result();
    const double favoured = advantage(pair, search, widest.distance(), length(along));
    Widest of_edges(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        for (const Arc& arc : {triangle.front_arc(i), triangle.back_arc(i)}) {
            if (dot(along, arc.left) * dot(along, arc.right) < 0) of_edges.offer(across(arc, from, along));
        }
    }
    widest.offer(of_edges.result(), favoured);
    return widest.result();
}

/// Along the triangle's normals.
void offer_normals(Widest& widest, const Triangle& triangle, const Polyhedron& core) {
    std::size_t lowest = 0, highest = 0;
    for (std::size_t i = 1; i < core.vertices.size(); ++i) {
        const double height = dot(triangle.normal, core.vertices[i]);
        if (height < dot(triangle.normal, core.vertices[lowest])) lowest = i;
        if (height > dot(triangle.normal, core.vertices[highest])) highest = i;
    }
    const Vec3 &low = core.vertices[lowest], &high = core.vertices[highest];
    const double above = triangle.height(low), below = -triangle.height(high);
    widest.offer({triangle.normal, above, low - above * triangle.normal, low, false});
    widest.offer({-triangle.normal, below, high + below * triangle.normal, high, false});
}

/// How far the triangle's corners lie above the faces of the polyhedron.
using CornerHeights = std::array<Heights3, 3>;

/// Along the normals of the polyhedron's faces.
void offer_faces(Widest& widest, const Triangle& triangle, const Polyhedron& core,
                 const CornerHeights& heights) {
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const double gap = std::min({heights[0][f], heights[1][f], heights[2][f]});
        const Vec3& n = core.normals[f];
        if (gap <= widest.distance() && !triangle.looks_back(-n)) continue;
        const std::size_t deepest = heights[0][f] == gap ? 0 : heights[1][f] == gap ? 1 : 2;
        widest.offer({-n, gap, triangle.corner(deepest), triangle.corner(deepest) - gap * n, false});
    }
}

/// Across edges of both whose arcs of the Gauss map cross (see `polyhedron_polyhedron`), unless the gap there
/// is known to be less than `least`.
void offer_edges(Widest& widest, const std::array<Arc, 3>& arcs, const Polyhedron& core,
                 const CornerHeights& heights, double least) {
    const double needed = std::min(least, 0.0) - core.unevenness;
    for (const Polyhedron::Edge& edge : core.edges) {
        if (heights[0].hides(edge, needed) || heights[1].hides(edge, needed) ||
            heights[2].hides(edge, needed))
            continue;
        const Vec3 &left = core.normals[edge.left], &right = core.normals[edge.right];
        const Vec3& start = core.vertices[edge.from];
        const Vec3 along = core.vertices[edge.to] - start;
        for (const Arc& arc : arcs) {
            const double left_of = dot(left, arc.along);
            if (left_of * dot(right, arc.along) >= 0) continue;
            const double right_of = dot(arc.right, along);
            if (dot(arc.left, along) * right_of >= 0 || left_of * right_of >= 0) continue;
            widest.offer(across(arc, start, along));
        }
    }
}

Nearest3 triangle_polyhedron(const Triangle& triangle, const Shape<3>& shape, const Pair3& pair,
                             const Search3& search) {
    const Polyhedron& core = *shape.core;
    const double extent = std::min(core_extent(pair.a), core_extent(shape));
    const auto favoured = [&](const Widest& so_far) {
        return advantage(pair, search, so_far.distance(), extent);
    };
    Widest widest(triangle), of_faces(triangle), of_edges(triangle);
    offer_normals(widest, triangle, core);
    if (widest.distance() > search.limit) return widest.result();
    Memory3 memory;
    const CornerHeights heights{Heights3(core, triangle.corner(0), memory),
                                Heights3(core, triangle.corner(1), memory),
                                Heights3(core, triangle.corner(2), memory)};
    offer_faces(of_faces, triangle, core, heights);
    widest.offer(of_faces.result(), favoured(widest));
    if (widest.result().distance > search.limit) return widest.result();
    const double least = widest.distance();
    offer_edges(of_edges, {triangle.front_arc(0), triangle.front_arc(1), triangle.front_arc(2)}, core,
                heights, least);
    if (triangle.two_sided || std::max(widest.distance(), of_edges.distance()) <= 0)
        offer_edges(of_edges, {triangle.back_arc(0), triangle.back_arc(1), triangle.back_arc(2)}, core,
                    heights, least);
    widest.offer(of_edges.result(), favoured(widest));
    return widest.result();
}

/// Cylinder and cone. Where the shortest way out leads backwards, the likely ones that do not are compared.
/// What only touches an edge from behind, as far as a search can tell, does not overlap, however it was
/// searched.
Nearest3 triangle_revolved(const Triangle& triangle, const Shape<3>& shape, const Pair3& pair,
                           const Search3& search) {
    const Nearest3 free = core_revolved(pair, search);
    const double touching = 1e-7 * std::min(core_extent(pair.a), core_extent(pair.b));
    if (free.distance > -touching || !triangle.looks_back(free.normal)) return free;
    Widest widest(triangle);
    const auto offer = [&](const Vec3& direction) {
        if (length_squared(direction) <= 1e-12) return;
        widest.offer(gap_along(pair, normalized(direction)));
        widest.offer(gap_along(pair, -normalized(direction)));
    };
    widest.offer(gap_along(pair, triangle.normal));
    offer(shape.b);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 along = triangle.corner(i + 1) - triangle.corner(i);
        const Vec3 from_middle = triangle.corner(i) - shape.a;
        offer(triangle.side(i));
        offer(cross(along, shape.b));
        offer(from_middle - dot(from_middle, shape.b) * shape.b);
    }
    Nearest3 result = widest.result();
    result.certain = false;
    return result;
}

Nearest3 nearest_to(const Triangle& triangle, const Pair3& pair, const Search3& search) {
    switch (pair.b.kind) {
        case ShapeKind::ball:
            return triangle_point(triangle, pair.b.a);
        case ShapeKind::capsule:
            return triangle_segment(triangle, pair.b, pair, search);
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return triangle_revolved(triangle, pair.b, pair, search);
        default:
            return triangle_polyhedron(triangle, pair.b, pair, search);
    }
}

/// Is the middle of the shape behind the facet, whose front looks along `front`?
bool is_behind(const Facet<3>& facet, const Vec3& front, const Vec3& middle) {
    return !facet.two_sided && dot(front, middle - facet.points[0]) < 0;
}

}  // namespace

template <>
Manifold<3> collide_facet(const Shape<3>& convex, const Facet<3>& facet, const Transform3& placed,
                          double reach, const Vec3& axis) {
    // Most facets near a shape are apart from it along the axis of last time, or in front of it.
    const Vec3 front = facet.normal();
    constexpr double same_cosine = 1 - 1e-6;
    if (dot(axis, front) < same_cosine) {
        const double last_gap = gap_along(convex, facet, placed, axis);
        if (last_gap > reach) return apart_along(axis, last_gap);
    }
    if (is_behind(facet, front, apply(placed, middle_of(convex)))) return {};
    const double height = gap_along(convex, facet, placed, front);
    if (height > reach) return apart_along(front, height);

    const Triangle triangle(facet, front, placed);
    const Transform3 here{};
    const Pair3 pair{triangle.shape, convex, here};
    const double radius = core_radius(convex), limit = reach + radius;
    const auto apart = [&](const Nearest3& found) {
        return apart_along(rotate(placed.rotation, found.normal), found.distance - radius);
    };
    Nearest3 found = nearest_to(triangle, pair, {limit, true, {}});
    if (found.distance > limit) return apart(found);
    std::optional<Manifold<3>> patch;
    if (!triangle.looks_back(found.normal)) patch = contact_patch(pair, found, reach);
    // The normal of the patch's face may lead back where what was found does not.
    if (!patch || triangle.looks_back(patch->normal)) {
        found = made_certain(pair, nearest_to(triangle, pair, {limit, false, {}}));
        if (found.distance > limit) return apart(found);
        if (triangle.looks_back(found.normal)) return {};
        patch = contact_patch(pair, found, reach);
        if (triangle.looks_back(patch->normal)) patch = contact_point(pair, found, reach);
    }
    return moved(*patch, placed);
}

template <>
std::optional<Separation<3>> separate_facet(const Shape<3>& convex, const Facet<3>& facet,
                                            const Transform3& placed) {
    const Vec3 front = facet.normal();
    if (is_behind(facet, front, apply(placed, middle_of(convex)))) return std::nullopt;
    const Triangle triangle(facet, front, placed);
    const Transform3 here{};
    const Pair3 pair{triangle.shape, convex, here};
    const auto answer = [&](const Vec3& normal, double distance) {
        const Separation<3> found{rotate(placed.rotation, normal), distance - core_radius(convex)};
        return triangle.looks_back(normal) ? std::nullopt : std::optional(found);
    };
    // Closest points take less time than all pairs of edges, but rounding blurs the direction between those
    // that all but touch.
    if (convex.core) {
        const CoreDistance<3> closest = core_distance<3>(pair.a, pair.b, here);
        const bool clear = closest.distance > 1e-4 * (core_extent(pair.a) + core_extent(convex));
        if (clear) return answer(closest.axis, closest.distance);
    }
    Nearest3 found = nearest_to(triangle, pair, {std::numeric_limits<double>::infinity(), false, {}});
    if (found.distance > 0) found = made_certain(pair, found);
    return answer(found.normal, found.distance);
}

}  // namespace carom::detail
