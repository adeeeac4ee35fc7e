#include <algorithm>
#include <cmath>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

/// The widest gap along the normals of a's faces, b's vertices being placed in a's frame by `b_in_a`.
Nearest3 widest_over_faces(const Polyhedron& a, const Polyhedron& b, const Transform3& b_in_a, double limit) {
    Nearest3 widest;
    widest.distance = -1e300;
    for (std::size_t f = 0; f < a.normals.size(); ++f) {
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

/// Do the arcs of the Gauss map, from a's normal `left` to `right` and between the opposites of b's, cross?
/// If not, the two edges make no face of the difference a − b. Along its left face's boundary an edge runs in
/// the direction of left × right, so the edges serve for the products of the normals (Gregorius, The
/// Separating Axis Test between Convex Polyhedra, 2013).
bool arcs_cross(const Vec3& edge_a, const Vec3& left_a, const Vec3& right_a, const Vec3& edge_b,
                const Vec3& left_b, const Vec3& right_b) {
    const double left_of_b = dot(left_b, edge_a);
    if (left_of_b * dot(right_b, edge_a) >= 0) return false;
    const double right_of_a = dot(right_a, edge_b);
    return dot(left_a, edge_b) * right_of_a < 0 && left_of_b * right_of_a < 0;
}

/// The widest gap across an edge of a and one of b, in b's frame.
Nearest3 widest_over_edges(const Polyhedron& a, const Polyhedron& b, const Transform3& a_in_b) {
    Nearest3 widest;
    widest.distance = -1e300;
    for (const Polyhedron::Edge& of_a : a.edges) {
        const Vec3 start_a = apply(a_in_b, a.vertices[of_a.from]);
        const Vec3 edge_a = rotate(a_in_b.rotation, a.vertices[of_a.to] - a.vertices[of_a.from]);
        const Vec3 left_a = rotate(a_in_b.rotation, a.normals[of_a.left]);
        const Vec3 right_a = rotate(a_in_b.rotation, a.normals[of_a.right]);
        for (const Polyhedron::Edge& of_b : b.edges) {
            const Vec3& start_b = b.vertices[of_b.from];
            const Vec3 edge_b = b.vertices[of_b.to] - start_b;
            if (!arcs_cross(edge_a, left_a, right_a, edge_b, b.normals[of_b.left], b.normals[of_b.right]))
                continue;
            Vec3 normal = cross(edge_a, edge_b);
            const double size = length(normal);
            if (size <= 1e-7 * length(edge_a) * length(edge_b)) continue;
            normal = normal / (dot(normal, left_a + right_a) < 0 ? -size : size);
            const double gap = dot(normal, start_b - start_a);
            if (gap <= widest.distance) continue;
            const SegmentPoints at = closest_on_segments(start_a, edge_a, start_b, edge_b);
            const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
            widest = {normal, gap, start_a + at.s * edge_a, start_b + at.t * edge_b, gap <= 0 || inside};
        }
    }
    return widest;
}

/// What was found in b's frame, in a's.
Nearest3 seen_from_a(const Nearest3& found, const Transform3& b_in_a) {
    return {rotate(b_in_a.rotation, found.normal), found.distance, apply(b_in_a, found.on_a),
            apply(b_in_a, found.on_b), found.certain};
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
    const Nearest3 of_edges = widest_over_edges(a, b, a_in_b);
    return preferred(of_edges, nearest) ? seen_from_a(of_edges, pair.b_in_a) : nearest;
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
            return length(shape.core->vertices.back() - shape.core->vertices.front());
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return shape.radius + shape.half_height;
        case ShapeKind::ball:
        case ShapeKind::plane:
            return 0;
    }
    return 0;
}

}  // namespace carom::detail
