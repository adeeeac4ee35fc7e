#pragma once

#include <cstddef>
#include <span>

#include "carom/collide.hpp"

namespace carom::detail {

/// Lets points that coincide within `snap` be one, the deepest of them, and gives those that are left names
/// of their own (two sides that lie along each other cross twice, within the snap). Those that are left come
/// first; returns how many.
template <int D>
std::size_t merge_points(std::span<ManifoldPoint<D>> points, double snap);

/// A manifold of these points, or where they are too many, of those that keep the length (2D) or area (3D) of
/// all and the deepest of them.
template <int D>
Manifold<D> manifold_of(std::span<const ManifoldPoint<D>> points, const Vec<D>& normal);

}  // namespace carom::detail
