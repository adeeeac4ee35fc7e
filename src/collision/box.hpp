#pragma once

#include <algorithm>
#include <cmath>

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

/// Square of the distance from the point to the box, less what rounding may have added.
template <int D>
double distance_squared(const Aabb<D>& box, const Vec<D>& point) {
    constexpr double rounding = 1e-15;
    double sum = 0;
    for (int i = 0; i < D; ++i) {
        const double outside = std::max(box.lower[i] - point[i], point[i] - box.upper[i]);
        const double least = std::max(outside - rounding * std::fabs(point[i]), 0.0);
        sum += least * least;
    }
    return (1 - 4 * rounding) * sum;
}

/// The box grown by what coordinates of its size may be rounded.
template <int D>
Aabb<D> grown_by_rounding(Aabb<D> box) {
    constexpr double rounding = 1e-15;
    for (int i = 0; i < D; ++i) {
        box.lower[i] -= rounding * std::fabs(box.lower[i]);
        box.upper[i] += rounding * std::fabs(box.upper[i]);
    }
    return box;
}

/// When a box that moves in a straight line meets fixed ones. Its half lengths are taken to be larger by what
/// coordinates of the way's size may be rounded, so that no box is missed that holds a point of the way.
template <int D>
class SlabTest {
  public:
    SlabTest(const Vec<D>& origin, const Vec<D>& translation, const Vec<D>& half) {
        constexpr double rounding = 1e-15, shortest = 1e-250;
        for (int i = 0; i < D; ++i) {
            const double margin =
                half[i] + rounding * (std::fabs(origin[i]) + std::fabs(translation[i]) + half[i]);
            to_lower_[i] = origin[i] + margin;
            to_upper_[i] = origin[i] - margin;
            // Along an axis that it does not move along, it meets a slab at all times or never.
            per_length_[i] = std::fabs(translation[i]) > shortest ? 1 / translation[i] : 1 / shortest;
        }
    }

    /// The fraction of the way, at least 0, at which it enters the box; more than `limit` (and than 1) when
    /// it does not, or later than that.
    double enter(const Aabb<D>& box, double limit) const {
        double enter = 0, leave = limit;
        for (int i = 0; i < D; ++i) {
            const double a = (box.lower[i] - to_lower_[i]) * per_length_[i];
            const double b = (box.upper[i] - to_upper_[i]) * per_length_[i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave ? enter : 1e300;
    }

  private:
    Vec<D> to_lower_, to_upper_;  ///< the places where the moving box's sides would meet at the start
    Vec<D> per_length_;
};

}  // namespace carom::detail
