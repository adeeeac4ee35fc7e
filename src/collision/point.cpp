#include "collision/point.hpp"

#include <algorithm>

#include "collision/gjk.hpp"

namespace carom::detail {

namespace {

template <int D>
Vec<D> nearest_on_segment(const Vec<D>& from, const Vec<D>& to, const Vec<D>& p) {
    const Vec<D> along = to - from;
    const double whole = length_squared(along), part = dot(p - from, along);
    if (part <= 0) return from;
    return part >= whole ? to : from + part / whole * along;
}

/// The nearest point of a box without rounding; `p` itself, bit by bit, inside.
template <int D>
Vec<D> nearest_in_box(const Shape<D>& box, const Vec<D>& p) {
    const Vec<D> local = unrotate(box.rotation, p - box.a);
    Vec<D> nearest = local;
    for (int i = 0; i < D; ++i) nearest[i] = std::clamp(local[i], -box.b[i], box.b[i]);
    return nearest == local ? p : box.a + rotate(box.rotation, nearest);
}

bool in_core(const Polygon& core, const Vec2& p) {
    for (std::size_t i = 0; i < core.normals.size(); ++i)
        if (dot(core.normals[i], p - core.vertices[i]) > 0) return false;
    return true;
}
bool in_core(const Polyhedron& core, const Vec3& p) {
    for (std::size_t i = 0; i < core.normals.size(); ++i)
        if (dot(core.normals[i], p) > core.offsets[i]) return false;
    return true;
}

template <int D>
Vec<D> nearest_in_hull(const Shape<D>& hull, const Vec<D>& p) {
    if (in_core(*hull.core, p)) return p;
    Shape<D> point;
    point.a = p;
    const CoreDistance<D> found = core_distance(hull, point, Transform<D>{});
    return found.overlap ? p : found.on_a;
}

/// Cylinders and cones, in the half-plane of the distance from the axis and the height along it.
Vec3 nearest_in_revolved(const Shape<3>& shape, const Vec3& p) {
    const Vec3 from_center = p - shape.a;
    const double y = dot(from_center, shape.b), h = shape.half_height, r = shape.radius;
    const Vec3 outward = from_center - y * shape.b;
    const double x = length(outward);
    double nearest_x = std::min(x, r), nearest_y = std::clamp(y, -h, h);
    if (shape.kind == ShapeKind::cone && y >= -h) {
        // The slant runs from (r, −h) to (0, h); its normal is (2h, r).
        if (2 * h * (x - r) + r * (y + h) <= 0) return p;
        const double t = std::clamp(((r - x) * r + (y + h) * 2 * h) / (r * r + 4 * h * h), 0.0, 1.0);
        nearest_x = r * (1 - t);
        nearest_y = h * (2 * t - 1);
    }
    if (nearest_x == x && nearest_y == y) return p;
    return shape.a + nearest_y * shape.b + (x > 0 ? nearest_x / x * outward : Vec3{});
}

template <int D>
Vec<D> nearest_in_core(const Shape<D>& shape, const Vec<D>& p) {
    switch (shape.kind) {
        case ShapeKind::ball:
            return shape.a;
        case ShapeKind::capsule:
            return nearest_on_segment(shape.a, shape.b, p);
        case ShapeKind::box:
            return nearest_in_box(shape, p);
        case ShapeKind::hull:
            return nearest_in_hull(shape, p);
        case ShapeKind::plane:
            return p - std::max(dot(shape.a, p) - shape.offset, 0.0) * shape.a;
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            break;
    }
    if constexpr (D == 3) return nearest_in_revolved(shape, p);
    return p;
}

}  // namespace

template <int D>
Vec<D> nearest_point(const Shape<D>& shape, const Vec<D>& point) {
    const Vec<D> in_core = nearest_in_core(shape, point), way = point - in_core;
    const double square = length_squared(way), radius = core_radius(shape);
    if (square <= radius * radius) return point;
    return in_core + radius / std::sqrt(square) * way;
}

template Vec<2> nearest_point(const Shape<2>&, const Vec<2>&);
template Vec<3> nearest_point(const Shape<3>&, const Vec<3>&);

}  // namespace carom::detail
