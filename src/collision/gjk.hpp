#pragma once

#include <array>

#include "geometry/shape.hpp"

namespace carom::detail {

/// A point of the difference of two cores, a − b, and the two points that it comes from. All in a's frame.
template <int D>
struct SimplexVertex {
    Vec<D> on_a{};
    Vec<D> on_b{};
    Vec<D> difference{};  ///< on_a − on_b
};

/// What `core_distance` finds. All in a's frame.
template <int D>
struct CoreDistance {
    bool overlap =
        false;            ///< the cores overlap or touch within rounding; then `axis` and `distance` are zero
    double distance = 0;  ///< between the cores, m
    Vec<D> axis{};        ///< unit vector from a to b along the closest points
    Vec<D> on_a{};        ///< the point of a's core closest to b's
    Vec<D> on_b{};
    std::array<SimplexVertex<D>, D + 1> simplex{};  ///< the last simplex: its first `count` vertices
    int count = 0;                                  ///< when the cores overlap it holds the origin
};

/// The furthest point of the difference a − b of two cores along `direction` (in a's frame, not zero).
template <int D>
SimplexVertex<D> difference_support(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a,
                                    const Vec<D>& direction);

/// Distance and closest points of the cores of two shapes (see `core_support`; not for planes), by the
/// algorithm of Gilbert, Johnson and Keerthi (1988). The distance is right to about 1e-10 of the shapes'
/// size.
template <int D>
CoreDistance<D> core_distance(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a);

}  // namespace carom::detail
