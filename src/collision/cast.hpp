#pragma once

#include <optional>

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// Where b, placed in the frame of a's body and moved by `translation`, first touches a; see the public
/// `cast_shape`. The hit is one of a.
template <int D>
std::optional<CastHit<D>> cast_shape(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a,
                                     const Vec<D>& translation);

/// The impact of two shapes; see the public `time_of_impact`.
template <int D>
std::optional<CastHit<D>> time_of_impact(const Shape<D>& a, const Sweep<D>& a_sweep, const Shape<D>& b,
                                         const Sweep<D>& b_sweep, double tolerance);

}  // namespace carom::detail
