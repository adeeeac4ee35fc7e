#include <algorithm>
#include <cmath>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

SegmentPoints closest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
    // The quadratic |p + s·u − q − t·v|² at its least over the unit square (Ericson 2005, 5.1.9).
    const Vec3 r = p - q;
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
    const auto share = [](double part, double whole) {
        return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
    };
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 1e-14 * uu * vv ? share(uv * vr - ur * vv, determinant) : 0.0;
    double t = share(uv * s + vr, vv);
    s = share(uv * t - ur, uu);
    t = share(uv * s + vr, vv);
    return {s, t};
}

Nearest3 segment_segment(const Pair3& pair, const Search3&) {
    const Vec3 p = pair.a.a, u = pair.a.b - pair.a.a;
    const Vec3 q = apply(pair.b_in_a, pair.b.a), v = rotate(pair.b_in_a.rotation, pair.b.b - pair.b.a);
    const SegmentPoints at = closest_on_segments(p, u, q, v);
    const Vec3 on_a = p + at.s * u, on_b = q + at.t * v;
    const double distance = length(on_b - on_a), extent = length(u) + length(v);
    if (distance > 1e-9 * extent) return {(on_b - on_a) / distance, distance, on_a, on_b};

    // They cross: the way out is across both; where they run along each other, any direction across.
    const Vec3 across = cross(u, v);
    const Vec3 longer = length(u) >= length(v) ? u : v;
    Vec3 normal{0, 1, 0};
    if (length(across) > 1e-9 * length(u) * length(v)) {
        normal = normalized(across);
    } else if (length(longer) > 0) {
        normal = any_perpendicular(normalized(longer));
    }
    return {dot(normal, on_b - on_a) < 0 ? -normal : normal, distance, on_a, on_b};
}

namespace {

/// The widest gap along the normals of faces, and along those of pairs of edges, of a segment and a
/// polyhedron in whose frame everything is. A pair of edges counts where its normal lies between those of the
/// polyhedron's two faces (the Gauss map of a segment is a great circle).
Nearest3 widest_over_faces(const Polyhedron& core, const Vec3& from, const Vec3& to) {
    Nearest3 widest;
    widest.distance = -1e300;
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const double at_from = dot(core.normals[f], from) - core.offsets[f];
        const double at_to = dot(core.normals[f], to) - core.offsets[f];
        const double gap = std::min(at_from, at_to);
        if (gap <= widest.distance) continue;
        const Vec3& lower = at_from <= at_to ? from : to;
        widest = {core.normals[f], gap, lower - gap * core.normals[f], lower, false};
    }
    return widest;
}

Nearest3 widest_over_edges(const Polyhedron& core, const Vec3& from, const Vec3& to) {
    Nearest3 widest;
    widest.distance = -1e300;
    const Vec3 along = to - from;
    for (const Polyhedron::Edge& edge : core.edges) {
        const Vec3 &left = core.normals[edge.left], &right = core.normals[edge.right];
        if (dot(along, left) * dot(along, right) >= 0) continue;
        const Vec3& start = core.vertices[edge.from];
        const Vec3 direction = core.vertices[edge.to] - start;
        Vec3 normal = cross(direction, along);
        const double size = length(normal);
        if (size <= 1e-8 * length(direction) * length(along)) continue;
        normal = normal / (dot(normal, left + right) < 0 ? -size : size);
        const double gap = dot(normal, from - start);
        if (gap <= widest.distance) continue;
        const SegmentPoints at = closest_on_segments(start, direction, from, along);
        const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
        widest = {normal, gap, start + at.s * direction, from + at.t * along, gap <= 0 || inside};
    }
    return widest;
}

}  // namespace

Nearest3 segment_polyhedron(const Pair3& pair, const Search3& search) {
    const Vec3 from = apply_inverse(pair.b_in_a, pair.a.a), to = apply_inverse(pair.b_in_a, pair.a.b);
    Nearest3 widest = widest_over_faces(*pair.b.core, from, to);
    if (widest.distance > search.limit) return exchanged(widest, pair.b_in_a);
    const Nearest3 edges = widest_over_edges(*pair.b.core, from, to);
    if (edges.distance > widest.distance + advantage(pair, search, widest.distance, length(to - from)))
        widest = edges;
    return exchanged(widest, pair.b_in_a);
}

}  // namespace carom::detail
