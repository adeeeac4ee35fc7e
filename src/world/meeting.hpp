#pragma once

#include <cmath>
#include <optional>

#include "collision/facet.hpp"
#include "collision/manifold.hpp"
#include "dynamics/body.hpp"

namespace carom::detail {

/// Shapes nearer than this are given contact points before they touch, so that the solver can let them come
/// together without overlap.
constexpr double speculative_distance = 0.02;

/// A core of a shape that comes no further within a step than this share of its radius passes through
/// nothing.
constexpr double seen_share = 0.25;

/// From this restitution on, what is struck within a step is followed to what it strikes in the same step.
/// Blows that bounce less are not passed on far, and a crowd of dull things should not pay for that.
constexpr double lively_restitution = 0.3;

/// Speed of the body's outermost point about its centre of mass.
template <int D>
double turning_speed(const BodyState<D>& s, const BodyMass<D>& m) {
    return std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity)) * m.radius;
}

/// Manifold and gap of two shapes (see manifold.hpp), of which one may be a terrain: then of its facet. What
/// the one has for a normal is the `axis` for the next.
template <int D>
Manifold<D> manifold_between(const Shape<D>& a, const Shape<D>& b, std::uint32_t facet,
                             const Transform<D>& b_in_a, double reach, const Vec<D>& axis = {}) {
    if (a.kind == ShapeKind::terrain)
        return collide_facet<D>(b, a.terrain->facet(facet), b_in_a, reach, axis);
    if (b.kind != ShapeKind::terrain) return collide_shapes<D>(a, b, b_in_a, reach, axis);
    const Manifold<D> seen = collide_facet<D>(a, b.terrain->facet(facet), inverse(b_in_a), reach,
                                              -unrotate(b_in_a.rotation, axis));
    return moved(exchanged(seen), b_in_a);
}
/// How far they are apart at least, as `axis` shows.
template <int D>
double least_gap_between(const Shape<D>& a, const Shape<D>& b, std::uint32_t facet,
                         const Transform<D>& b_in_a, const Vec<D>& axis) {
    if (a.kind == ShapeKind::terrain) return gap_along<D>(b, a.terrain->facet(facet), b_in_a, axis);
    if (b.kind != ShapeKind::terrain) return gap_along<D>(a, b, b_in_a, axis);
    return gap_along<D>(a, b.terrain->facet(facet), inverse(b_in_a), -unrotate(b_in_a.rotation, axis));
}
template <int D>
std::optional<Separation<D>> gap_between(const Shape<D>& a, const Shape<D>& b, std::uint32_t facet,
                                         const Transform<D>& b_in_a) {
    if (a.kind == ShapeKind::terrain) return separate_facet<D>(b, a.terrain->facet(facet), b_in_a);
    if (b.kind != ShapeKind::terrain) return separate_shapes<D>(a, b, b_in_a);
    auto gap = separate_facet<D>(a, b.terrain->facet(facet), inverse(b_in_a));
    if (gap) gap->axis = -rotate(b_in_a.rotation, gap->axis);
    return gap;
}

}  // namespace carom::detail
