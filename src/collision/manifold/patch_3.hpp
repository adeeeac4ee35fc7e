#pragma once

#include <optional>

#include "collision/manifold/facet_3.hpp"
#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

/// The contact manifold of two shapes whose cores are nearest as `nearest` says: where the faces or edges
/// that meet there lie nearly parallel, the corners of the area or the ends of the line that they share (by
/// clipping, Sutherland and Hodgman 1974); otherwise the one point of contact. Points with a gap above
/// `reach` are left out. Nothing when that point would be needed but `nearest` is not certain.
std::optional<Manifold<3>> contact_patch(const Pair3& pair, const Nearest3& nearest, double reach);

/// The one point where the surfaces are nearest.
Manifold<3> contact_point(const Pair3& pair, const Nearest3& nearest, double reach);

}  // namespace carom::detail
