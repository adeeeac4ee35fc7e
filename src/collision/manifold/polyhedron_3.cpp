#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

/// A point inside.
Vec3 middle_of(const Polyhedron& core) {
    Vec3 sum{};
    for (const Vec3& vertex : core.vertices) sum += vertex;
    return sum / double(core.vertices.size());
}

/// The widest gap along the normals of a's faces, b's vertices being placed in a's frame by `b_in_a`. A gap
/// is less than the height of b's middle over the face, which spares most faces the look at all of b's
/// vertices.
Nearest3 widest_over_faces(const Polyhedron& a, const Polyhedron& b, const Transform3& b_in_a, double limit) {
    const Vec3 middle = apply(b_in_a, middle_of(b));
    Nearest3 widest;
    widest.distance = -1e300;
    for (std::size_t f = 0; f < a.normals.size(); ++f) {
        if (dot(a.normals[f], middle) - a.offsets[f] <= widest.distance) continue;
        const Vec3 normal = unrotate(b_in_a.rotation, a.normals[f]);
        const double base = dot(a.normals[f], b_in_a.position) - a.offsets[f];
        double gap = 1e300;
        std::size_t lowest = 0;
        for (std::size_t i = 0; i < b.vertices.size(); ++i) {
            const double height = base + dot(normal, b.vertices[i]);
            if (height < gap) {
                gap = height;
                lowest = i;
            }
        }
        if (gap <= widest.distance) continue;
        const Vec3 on_b = apply(b_in_a, b.vertices[lowest]);
        widest = {a.normals[f], gap, on_b - gap * a.normals[f], on_b, false};
        if (gap > limit) break;
    }
    return widest;
}

/// An edge of a polyhedron with the normals of the faces on its left and right.
struct Arc {
    Vec3 start, along, left, right;
};
using Arcs = std::pmr::vector<Arc>;

/// The edges, placed by `t`, that can part the polyhedron from another one by more than `gap`, if that has a
/// point at `other` (in the polyhedron's frame). An edge's normals lie between those of its two faces; where
/// `other` is below both faces by more than −gap, so it is along any of them.
void find_arcs(const Polyhedron& core, const Transform3& t, const Vec3& other, double gap, Arcs& arcs) {
    const double needed = std::min(gap, 0.0);
    const auto height = [&](std::uint32_t f) { return dot(core.normals[f], other) - core.offsets[f]; };
    for (const Polyhedron::Edge& edge : core.edges) {
        if (height(edge.left) < needed && height(edge.right) < needed) continue;
        const Vec3& from = core.vertices[edge.from];
        arcs.push_back({apply(t, from), rotate(t.rotation, core.vertices[edge.to] - from),
                        rotate(t.rotation, core.normals[edge.left]),
                        rotate(t.rotation, core.normals[edge.right])});
    }
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

/// The widest gap across an edge of a and one of b, if it is more than `gap`. In a's frame.
Nearest3 widest_over_edges(const Polyhedron& a, const Polyhedron& b, const Transform3& b_in_a, double gap) {
    std::array<std::byte, 16 * 1024> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    Arcs arcs_a(&memory), arcs_b(&memory);
    find_arcs(a, {}, apply(b_in_a, middle_of(b)), gap, arcs_a);
    find_arcs(b, b_in_a, apply_inverse(b_in_a, middle_of(a)), gap, arcs_b);

    Nearest3 widest;
    widest.distance = -1e300;
    for (const Arc& of_a : arcs_a) {
        for (const Arc& of_b : arcs_b) {
            if (!cross_on_gauss_map(of_a, of_b)) continue;
            Vec3 normal = cross(of_a.along, of_b.along);
            const double size = length(normal);
            if (size <= 1e-7 * length(of_a.along) * length(of_b.along)) continue;
            normal = normal / (dot(normal, of_a.left + of_a.right) < 0 ? -size : size);
            const double candidate = dot(normal, of_b.start - of_a.start);
            if (candidate <= widest.distance) continue;
            const SegmentPoints at = closest_on_segments(of_a.start, of_a.along, of_b.start, of_b.along);
            const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
            widest = {normal, candidate, of_a.start + at.s * of_a.along, of_b.start + at.t * of_b.along,
                      candidate <= 0 || inside};
        }
    }
    return widest;
}

}  // namespace

Nearest3 polyhedron_polyhedron(const Pair3& pair, const Search3& search) {
    const Polyhedron &a = *pair.a.core, &b = *pair.b.core;
    const Transform3 a_in_b = inverse(pair.b_in_a);
    const double extent = std::min(core_extent(pair.a), core_extent(pair.b));
    const auto preferred = [&](const Nearest3& over, const Nearest3& favoured) {
        return over.distance > favoured.distance + advantage(pair, search, favoured.distance, extent);
    };

    Nearest3 nearest = widest_over_faces(a, b, pair.b_in_a, search.limit);
    if (nearest.distance > search.limit) return nearest;
    const Nearest3 of_b = exchanged(widest_over_faces(b, a, a_in_b, search.limit), pair.b_in_a);
    if (preferred(of_b, nearest)) nearest = of_b;
    if (nearest.distance > search.limit) return nearest;
    const Nearest3 of_edges = widest_over_edges(a, b, pair.b_in_a, nearest.distance);
    return preferred(of_edges, nearest) ? of_edges : nearest;
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
    if (found.distance > 0 && closest.distance > found.distance + 1e-9 * extent) {
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
            return length(shape.core->vertices.back() - shape.core->vertices.front());
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
