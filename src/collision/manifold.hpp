#pragma once

#include <optional>

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

// Collision of two shapes, each in the frame of its body. Everything happens in the frame of a's body, in
// which b's body is placed by `b_in_a`: what matters is near the origin, wherever the bodies are in the
// world.

/// The contact manifold of two shapes in the frame of a's body: its normal points from a to b, a point lies
/// midway between the two surfaces, and `separation` is the gap there along the normal. It is empty when the
/// gap between the shapes is larger than `reach` (m, not negative) and for two of plane and terrain. The
/// kinds may come in either order; the feature ids of a pair of shapes are the same in both.
///
/// An `axis` that is not zero says along which direction, about a unit vector, the shapes were apart or
/// touched when they were last collided. If it still holds them apart, that is known at once. An empty
/// manifold may have a normal: the axis for next time; then the separation of its first point is the gap
/// along it.
template <int D>
Manifold<D> collide_shapes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, double reach,
                           const Vec<D>& axis = {});

/// The gap between two convex shapes along `axis` (of any length): they are at least so far apart. Minus
/// infinity for an axis of zero and for planes and terrains.
template <int D>
double gap_along(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, const Vec<D>& axis);

/// Where the shapes are apart: the direction from a to b between their closest points, and the gap. Where
/// they overlap: the direction in which b has the shortest way out of a, and minus the length of that way.
/// Nothing for two of plane and terrain, and for a shape that a terrain does not face.
template <int D>
std::optional<Separation<D>> separate_shapes(const Shape<D>& a, const Shape<D>& b,
                                             const Transform<D>& b_in_a);

/// The two questions above for one pair of kinds: an entry of the shape-pair matrix.
template <int D>
struct PairRoutines {
    Manifold<D> (*collide)(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, double reach,
                           const Vec<D>& axis);
    std::optional<Separation<D>> (*separate)(const Shape<D>& a, const Shape<D>& b,
                                             const Transform<D>& b_in_a);
};

/// The entry of the shape-pair matrix (matrix_2.cpp, matrix_3.cpp) for a <= b, the order of `ShapeKind`.
template <int D>
const PairRoutines<D>& pair_routines(ShapeKind a, ShapeKind b);
template <>
const PairRoutines<2>& pair_routines<2>(ShapeKind a, ShapeKind b);
template <>
const PairRoutines<3>& pair_routines<3>(ShapeKind a, ShapeKind b);

/// An empty manifold of shapes that are `gap` apart along the axis.
template <int D>
Manifold<D> apart_along(const Vec<D>& axis, double gap) {
    Manifold<D> manifold;
    manifold.normal = axis;
    manifold.points[0].separation = gap;
    return manifold;
}

/// The placement that undoes `t`.
template <int D>
constexpr Transform<D> inverse(const Transform<D>& t) {
    return relative(t, Transform<D>{});
}

/// The manifold carried from the frame that `t` places to the outer frame.
template <int D>
Manifold<D> moved(Manifold<D> manifold, const Transform<D>& t) {
    manifold.normal = rotate(t.rotation, manifold.normal);
    for (int i = 0; i < manifold.count; ++i)
        manifold.points[i].position = apply(t, manifold.points[i].position);
    return manifold;
}

/// The manifold of two shapes seen with the shapes exchanged, in the same frame.
template <int D>
Manifold<D> exchanged(Manifold<D> manifold) {
    manifold.normal = -manifold.normal;
    if (manifold.normal_of != NormalOf::neither)
        manifold.normal_of = manifold.normal_of == NormalOf::first ? NormalOf::second : NormalOf::first;
    return manifold;
}

}  // namespace carom::detail
