#include "collision/closest.hpp"

#include <algorithm>

#include "collision/gjk.hpp"
#include "collision/manifold.hpp"

namespace carom::detail {

namespace {

template <int D>
ClosestPoints<D> exchanged(const ClosestPoints<D>& found, const Transform<D>& b_in_a) {
    return {apply(b_in_a, found.on_b), apply(b_in_a, found.on_a), -rotate(b_in_a.rotation, found.axis),
            found.distance};
}

template <int D>
ClosestPoints<D> meeting_at(const Vec<D>& point) {
    return {point, point, {}, 0};
}

template <int D>
ClosestPoints<D> from_plane(const Shape<D>& plane, const Shape<D>& b, const Transform<D>& b_in_a) {
    const Vec<D> deepest = apply(b_in_a, core_support(b, unrotate(b_in_a.rotation, -plane.a)));
    const Vec<D> on_b = deepest - core_radius(b) * plane.a;
    const double distance = dot(plane.a, on_b) - plane.offset;
    if (!(distance > 0)) return meeting_at<D>(on_b);
    return {on_b - distance * plane.a, on_b, plane.a, distance};
}

/// Two half-spaces meet unless they look at each other across a gap.
template <int D>
ClosestPoints<D> between_planes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a) {
    const Vec<D> b_normal = rotate(b_in_a.rotation, b.a);
    const double b_offset = b.offset + dot(b_normal, b_in_a.position);
    const Vec<D> on_a = a.offset * a.a;
    const double gap = dot(b_normal, on_a) - b_offset;
    if (gap <= 0) return meeting_at<D>(on_a);
    const Vec<D> within_a = b_normal - dot(b_normal, a.a) * a.a;
    const double slope = length_squared(within_a);
    if (slope >= 1e-24) return meeting_at<D>(on_a - gap / slope * within_a);
    // Parallel: they look the same way, or away from each other.
    if (dot(a.a, b_normal) > 0) return meeting_at<D>(on_a - gap * b_normal);
    return {on_a, on_a - gap * b_normal, a.a, gap};
}

}  // namespace

template <int D>
ClosestPoints<D> closest_points(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a) {
    const bool a_plane = a.kind == ShapeKind::plane, b_plane = b.kind == ShapeKind::plane;
    if (a_plane && b_plane) return between_planes(a, b, b_in_a);
    if (a_plane) return from_plane(a, b, b_in_a);
    if (b_plane) return exchanged(from_plane(b, a, inverse(b_in_a)), b_in_a);

    const CoreDistance<D> cores = core_distance(a, b, b_in_a);
    if (cores.overlap) return meeting_at<D>(cores.on_a);
    const double a_radius = core_radius(a), gap = cores.distance - a_radius - core_radius(b);
    // On the way from one core to the other both rounded shapes hold what lies between their surfaces.
    if (!(gap > 0)) return meeting_at<D>(cores.on_a + std::min(a_radius, cores.distance) * cores.axis);
    const Vec<D> on_a = cores.on_a + a_radius * cores.axis;
    return {on_a, on_a + gap * cores.axis, cores.axis, gap};
}

template <int D>
bool overlap_shapes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a) {
    const auto found = separate_shapes(a, b, b_in_a);
    if (found) return found->distance <= 0;
    const bool planes = a.kind == ShapeKind::plane && b.kind == ShapeKind::plane;
    return planes && closest_points(a, b, b_in_a).distance <= 0;
}

template <int D>
double core_reach(const Shape<D>& shape, const Vec<D>& center) {
    switch (shape.kind) {
        case ShapeKind::ball:
            return length(shape.a - center);
        case ShapeKind::capsule:
            return std::max(length(shape.a - center), length(shape.b - center));
        case ShapeKind::box:
        case ShapeKind::hull: {
            double square = 0;
            for (const Vec<D>& vertex : shape.core->vertices)
                square = std::max(square, length_squared(vertex - center));
            return std::sqrt(square);
        }
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return length(shape.a - center) +
                   std::sqrt(shape.radius * shape.radius + shape.half_height * shape.half_height);
        case ShapeKind::plane:
            break;
    }
    return 0;
}

template <int D>
double size_of(const Shape<D>& shape) {
    if (shape.kind == ShapeKind::plane) return 0;
    Vec<D> along{};
    along.x = 1;
    return core_reach(shape, core_support(shape, along)) + core_radius(shape);
}

template ClosestPoints<2> closest_points(const Shape<2>&, const Shape<2>&, const Transform<2>&);
template ClosestPoints<3> closest_points(const Shape<3>&, const Shape<3>&, const Transform<3>&);
template bool overlap_shapes(const Shape<2>&, const Shape<2>&, const Transform<2>&);
template bool overlap_shapes(const Shape<3>&, const Shape<3>&, const Transform<3>&);
template double core_reach(const Shape<2>&, const Vec<2>&);
template double core_reach(const Shape<3>&, const Vec<3>&);
template double size_of(const Shape<2>&);
template double size_of(const Shape<3>&);

}  // namespace carom::detail
