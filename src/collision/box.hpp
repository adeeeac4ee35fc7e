#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "carom/transform.hpp"
#include "math/dim.hpp"

namespace carom::detail {

/// The largest `float` that is not greater than the number, or the smallest that is not less.
inline float rounded_down(double x) {
    constexpr float most = std::numeric_limits<float>::max();
    if (x > most) return most;
    if (x < -most) return -std::numeric_limits<float>::infinity();
    const auto f = static_cast<float>(x);
    if (f <= x) return f;
    const auto bits = std::bit_cast<std::uint32_t>(f);
    if (f > 0) return std::bit_cast<float>(bits - 1);
    return f < 0 ? std::bit_cast<float>(bits + 1) : -std::numeric_limits<float>::denorm_min();
}
inline float rounded_up(double x) { return -rounded_down(-x); }

/// A box in single precision that holds a given one: half as large to keep, and larger by a few millionths of
/// its coordinates.
template <int D>
struct OuterBox {
    Vec<D, float> lower{}, upper{};

    OuterBox() = default;
    OuterBox(const Aabb<D>& box) {
        for (int i = 0; i < D; ++i) {
            lower[i] = rounded_down(box.lower[i]);
            upper[i] = rounded_up(box.upper[i]);
        }
    }
    friend bool operator==(const OuterBox&, const OuterBox&) = default;
};

/// A box that holds nothing and overlaps nothing that has an end; see `overlapped`.
template <int D>
OuterBox<D> no_box() {
    OuterBox<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = std::numeric_limits<float>::infinity();
        box.upper[i] = -std::numeric_limits<float>::infinity();
    }
    return box;
}

/// The same box.
template <int D>
Aabb<D> widened(const OuterBox<D>& box) {
    return {narrow<double>(box.lower), narrow<double>(box.upper)};
}

/// The smallest box around two boxes.
template <template <int> class Box, int D>
constexpr Box<D> merged(Box<D> a, const Box<D>& b) {
    for (int i = 0; i < D; ++i) {
        a.lower[i] = std::min(a.lower[i], b.lower[i]);
        a.upper[i] = std::max(a.upper[i], b.upper[i]);
    }
    return a;
}

/// Do two boxes have a point in common?
template <template <int> class Box, template <int> class Other, int D>
constexpr bool overlaps(const Box<D>& a, const Other<D>& b) {
    bool result = true;
    for (int i = 0; i < D; ++i) result &= a.lower[i] <= b.upper[i] && b.lower[i] <= a.upper[i];
    return result;
}

/// Does `outer` hold all of `inner`?
template <template <int> class Box, template <int> class Other, int D>
constexpr bool contains(const Box<D>& outer, const Other<D>& inner) {
    bool result = true;
    for (int i = 0; i < D; ++i)
        result &= outer.lower[i] <= inner.lower[i] && inner.upper[i] <= outer.upper[i];
    return result;
}

/// Half of the perimeter (2D) or of the surface (3D): how likely a random line is to hit the box. Infinite
/// extents count as 1e100, so that sums and differences of costs stay finite.
template <template <int> class Box, int D>
constexpr double half_surface(const Box<D>& box) {
    Vec<D> size{};
    for (int i = 0; i < D; ++i)
        size[i] = std::min(static_cast<double>(box.upper[i]) - static_cast<double>(box.lower[i]), 1e100);
    if constexpr (D == 2)
        return size.x + size.y;
    else
        return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Square of the distance from the point to the box, less what rounding may have added.
template <template <int> class Box, int D>
double distance_squared(const Box<D>& box, const Vec<D>& point) {
    constexpr double rounding = 1e-15;
    double sum = 0;
    for (int i = 0; i < D; ++i) {
        const double outside = std::max<double>(box.lower[i] - point[i], point[i] - box.upper[i]);
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
    template <template <int> class Box>
    double enter(const Box<D>& box, double limit) const {
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
