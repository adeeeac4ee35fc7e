#pragma once

#include <optional>

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// Where the ray from `origin` to `origin` + `translation` enters the shape; see the public `cast_ray`. All
/// in the frame of the shape's body.
template <int D>
std::optional<CastHit<D>> cast_ray(const Shape<D>& shape, const Vec<D>& origin, const Vec<D>& translation);

}  // namespace carom::detail
