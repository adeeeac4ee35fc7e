#include "geometry/curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace carom::detail {

template <int D>
Curve<D>::Curve(std::vector<Vec<D>> points, bool loop, bool smooth)
    : points_(std::move(points)),
      loop_(loop),
      smooth_(smooth),
      pieces_(loop ? points_.size() : points_.size() - 1) {
    ways_.push_back(0);
    for (std::size_t i = 0; i < pieces_ * parts; ++i) {
        const double from = static_cast<double>(i) / parts;
        ways_.push_back(ways_.back() + way_within(from, from + 1.0 / parts));
    }
}

/// Beyond the ends of an open curve the outermost pieces go on straight.
template <int D>
const Vec<D>& Curve<D>::point(std::ptrdiff_t index) const {
    const auto count = static_cast<std::ptrdiff_t>(points_.size());
    if (loop_) return points_[static_cast<std::size_t>((index % count + count) % count)];
    return points_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, count - 1))];
}

template <int D>
double Curve<D>::into_range(double place) const {
    const double last = last_place();
    if (!loop_) return std::clamp(place, 0.0, last);
    const double turned = place - last * std::floor(place / last);
    return turned < last ? turned : 0;
}

template <int D>
auto Curve<D>::look(double place) const -> Derivatives {
    const auto piece = std::min(static_cast<std::ptrdiff_t>(place), static_cast<std::ptrdiff_t>(pieces_) - 1);
    const double t = place - static_cast<double>(piece);
    const Vec<D>&p = point(piece), &q = point(piece + 1);
    if (!smooth_) return {p + t * (q - p), q - p, {}};
    const bool first = !loop_ && piece == 0,
               last = !loop_ && piece + 1 == static_cast<std::ptrdiff_t>(pieces_);
    const Vec<D> m = first ? q - p : 0.5 * (q - point(piece - 1));
    const Vec<D> n = last ? q - p : 0.5 * (point(piece + 2) - p);
    // The cubic with these ends and these directions there (Hermite).
    const Vec<D> c = 3 * (q - p) - 2 * m - n, d = 2 * (p - q) + m + n;
    return {p + t * (m + t * (c + t * d)), m + t * (2 * c + (3 * t) * d), 2 * c + (6 * t) * d};
}

/// Gauss's rule with three points.
template <int D>
double Curve<D>::way_within(double from, double to) const {
    const double half = 0.5 * (to - from), middle = 0.5 * (from + to);
    constexpr double outer = 0.7745966692414834;
    const auto speed = [&](double at) { return carom::length(look(at).first); };
    return half * (8 * speed(middle) + 5 * (speed(middle - outer * half) + speed(middle + outer * half))) / 9;
}

template <int D>
CurvePlace<D> Curve<D>::at(double place) const {
    const double u = into_range(place);
    const Derivatives d = look(u);
    const double squared = std::max(dot(d.first, d.first), 1e-30);
    CurvePlace<D> found;
    found.point = d.point;
    found.tangent = d.first / std::sqrt(squared);
    found.bend = (d.second - dot(d.second, found.tangent) * found.tangent) / squared;
    const auto part = std::min(static_cast<std::size_t>(u * parts), pieces_ * parts - 1);
    found.way = ways_[part] + way_within(static_cast<double>(part) / parts, u);
    return found;
}

/// Newton's method for the place where the way to the point is across the curve; kept from going uphill.
template <int D>
double Curve<D>::refined(const Vec<D>& target, double place) const {
    for (int round = 0; round < 8; ++round) {
        const Derivatives d = look(place);
        const Vec<D> way = target - d.point;
        const double slope = dot(d.first, d.first) - dot(way, d.second);
        const double step = dot(way, d.first) / std::max(slope, 0.25 * dot(d.first, d.first));
        const double next = into_range(place + std::clamp(step, -0.25, 0.25));
        const bool there = std::fabs(next - place) < 1e-12;
        place = next;
        if (there) break;
    }
    return place;
}

/// On straight pieces. Who has passed the end of one is on the next, at the corner itself where that leads
/// away.
template <int D>
double Curve<D>::nearest_on_lines(const Vec<D>& target, double near) const {
    const auto piece = std::min(static_cast<std::ptrdiff_t>(near), static_cast<std::ptrdiff_t>(pieces_) - 1);
    const auto part = [&](std::ptrdiff_t i) {
        const Vec<D> way = point(i + 1) - point(i);
        return dot(target - point(i), way) / dot(way, way);
    };
    const double own = part(piece), start = static_cast<double>(piece);
    const bool is_first = !loop_ && piece == 0,
               is_last = !loop_ && piece + 1 == static_cast<std::ptrdiff_t>(pieces_);
    if (own > 1 && !is_last) return into_range(start + 1 + std::clamp(part(piece + 1), 0.0, 1 - 1e-9));
    if (own < 0 && !is_first) return into_range(start - 1 + std::clamp(part(piece - 1), 0.0, 1 - 1e-9));
    return start + std::clamp(own, 0.0, is_last ? 1.0 : 1 - 1e-9);
}

template <int D>
double Curve<D>::nearest(const Vec<D>& target, double near) const {
    if (!smooth_) return nearest_on_lines(target, into_range(near));
    constexpr int tries = 4;  // to either side
    double best = into_range(near), best_square = length_squared(look(best).point - target);
    for (int i = -tries; i <= tries; ++i) {
        const double place = into_range(near + static_cast<double>(i) / tries);
        const double square = length_squared(look(place).point - target);
        if (square < best_square) {
            best = place;
            best_square = square;
        }
    }
    return refined(target, best);
}

template <int D>
double Curve<D>::nearest(const Vec<D>& target) const {
    double best = 0, best_square = length_squared(look(0).point - target);
    for (std::size_t i = 0; i <= pieces_ * parts; ++i) {
        const double place = into_range(static_cast<double>(i) / parts);
        const double square = length_squared(look(place).point - target);
        if (square < best_square) {
            best = place;
            best_square = square;
        }
    }
    return smooth_ ? refined(target, best) : nearest_on_lines(target, best);
}

template class Curve<2>;
template class Curve<3>;

}  // namespace carom::detail
