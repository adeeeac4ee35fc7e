#pragma once

#include <algorithm>

#include "carom/transform.hpp"

namespace carom::detail {

/// The smallest box around two boxes.
template <int D>
constexpr Aabb<D> merged(Aabb<D> a, const Aabb<D>& b) {
    for (int i = 0; i < D; ++i) {
        a.lower[i] = std::min(a.lower[i], b.lower[i]);
        a.upper[i] = std::max(a.upper[i], b.upper[i]);
    }
    return a;
}

/// Do two boxes have a point in common?
template <int D>
constexpr bool overlaps(const Aabb<D>& a, const Aabb<D>& b) {
    bool result = true;
    for (int i = 0; i < D; ++i) result &= a.lower[i] <= b.upper[i] && b.lower[i] <= a.upper[i];
    return result;
}

/// Does `outer` hold all of `inner`?
template <int D>
constexpr bool contains(const Aabb<D>& outer, const Aabb<D>& inner) {
    bool result = true;
    for (int i = 0; i < D; ++i)
        result &= outer.lower[i] <= inner.lower[i] && inner.upper[i] <= outer.upper[i];
    return result;
}

/// Half of the perimeter (2D) or of the surface (3D): how likely a random line is to hit the box. Infinite
/// extents count as 1e100, so that sums and differences of costs stay finite.
template <int D>
constexpr double half_surface(const Aabb<D>& box) {
    Vec<D> size = box.upper - box.lower;
    for (int i = 0; i < D; ++i) size[i] = std::min(size[i], 1e100);
    if constexpr (D == 2)
        return size.x + size.y;
    else
        return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace carom::detail
