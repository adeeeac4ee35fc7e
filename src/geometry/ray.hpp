#pragma once

#include <algorithm>
#include <cmath>

#include "carom/transform.hpp"

namespace carom::detail {

/// The way of a point, or of a box with these half lengths, from `origin` to `origin` + `translation`.
template <int D>
struct Ray {
    Vec<D> origin{};
    Vec<D> translation{};
    Vec<D> half{};
};

/// What `entry` answers for a box that is missed.
constexpr double missed = 1e300;

/// The fraction of the ray at which it enters the box, 0 where it begins inside, `missed` where it misses it
/// or enters it after `max_fraction` only. Rounding may let it hit a box that it passes by a hair, and enter
/// a hair too early, but never the other way round.
template <int D>
double entry(const Ray<D>& ray, const Aabb<D>& box, double max_fraction) {
    double enter = 0, leave = max_fraction;
    for (int i = 0; i < D; ++i) {
        // A hundred times the rounding of all that is computed here.
        const double slack = ray.half[i] + 1e-13 * (std::fabs(ray.origin[i]) + std::fabs(ray.translation[i]) +
                                                    std::fabs(box.lower[i]) + std::fabs(box.upper[i]));
        const double to_lower = box.lower[i] - slack - ray.origin[i];
        const double to_upper = box.upper[i] + slack - ray.origin[i];
        if (ray.translation[i] == 0) {
            if (to_lower > 0 || to_upper < 0) return missed;
            continue;
        }
        const double first = to_lower / ray.translation[i], second = to_upper / ray.translation[i];
        enter = std::max(enter, std::min(first, second));
        leave = std::min(leave, std::max(first, second));
    }
    return enter <= leave ? enter : missed;
}

}  // namespace carom::detail
