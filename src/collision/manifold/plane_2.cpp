#include "collision/manifold/outline_2.hpp"
#include "collision/manifold/pairs_2.hpp"

namespace carom::detail {

namespace {

/// A half-plane in the frame of the shape that it meets.
struct HalfPlane {
    Vec2 normal;
    double offset;

    HalfPlane(const Shape<2>& plane, const Transform<2>& placed)
        : normal(rotate(placed.rotation, plane.a)), offset(plane.offset + dot(normal, placed.position)) {}

    double height(const Vec2& point) const { return dot(normal, point) - offset; }
};

}  // namespace

std::optional<Separation<2>> separate_from_plane(const Shape<2>& a, const Shape<2>& plane,
                                                 const Transform<2>& plane_in_a) {
    const Outline outline(a, {});
    const HalfPlane half(plane, plane_in_a);
    const Vec2 deepest = outline.corner(outline.furthest(-half.normal));
    return Separation<2>{-half.normal, half.height(deepest) - outline.radius()};
}

Manifold<2> collide_with_plane(const Shape<2>& a, const Shape<2>& plane, const Transform<2>& plane_in_a,
                               double reach, const Vec2&) {
    const Outline outline(a, {});
    const HalfPlane half(plane, plane_in_a);
    Manifold<2> result;
    result.normal = -half.normal;
    result.normal_of = NormalOf::second;
    const auto add = [&](int corner) {
        const double height = half.height(outline.corner(corner));
        const double separation = height - outline.radius();
        if (separation > reach) return;
        const Vec2 middle = outline.corner(corner) - 0.5 * (height + outline.radius()) * half.normal;
        result.points[result.count++] = {middle, separation, feature_id(corner, 0)};
    };
    const int deepest = outline.furthest(-half.normal);
    if (!outline.has_edges()) {
        add(deepest);
    } else {
        const int edge = facing_edge(outline, deepest, half.normal);
        add(edge);
        add(outline.next(edge));
    }
    return result;
}

}  // namespace carom::detail
