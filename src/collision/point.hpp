#pragma once

#include "geometry/shape.hpp"

namespace carom::detail {

/// The point of the shape that is nearest to `point`; `point` itself where it lies in the shape or on its
/// surface. All in the frame of the shape's body.
template <int D>
Vec<D> nearest_point(const Shape<D>& shape, const Vec<D>& point);

/// Is the point in the shape or on its surface?
template <int D>
bool holds(const Shape<D>& shape, const Vec<D>& point) {
    return nearest_point(shape, point) == point;
}

}  // namespace carom::detail
