#include "collision/manifold/reduce.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/dim.hpp"

namespace carom::detail {

namespace {

/// The index of the point of greatest measure; the first of those that are nearly as great.
template <class Measure>
int greatest(std::span<const ManifoldPoint<3>> points, const Measure& measure) {
    double low = 1e300, high = -1e300;
    for (const ManifoldPoint<3>& point : points) {
        low = std::min(low, measure(point));
        high = std::max(high, measure(point));
    }
    const auto first = std::find_if(points.begin(), points.end(), [&](const ManifoldPoint<3>& point) {
        return measure(point) >= high - 1e-3 * (high - low);
    });
    return first == points.end() ? 0 : static_cast<int>(first - points.begin());
}

/// Is the deepest point so much deeper than those that were picked that one must make room for it? What is
/// left out of a plane patch is deeper only by what the patch is not plane.
bool is_deeper(double deepest, double lowest_picked, double extent) {
    return deepest < lowest_picked - std::max(0.01 * std::fabs(deepest), 5e-4 * extent);
}

/// Picks four points that keep the area of all, the deepest among them. The choice begins at a fixed
/// direction, not at the deepest point, which changes from step to step when all are nearly equally deep.
std::array<int, 4> pick_four(std::span<const ManifoldPoint<3>> points, const Vec3& normal) {
    // Askew, since sides along the axes are common and all points of such a side would be equally far.
    const auto [t, u] = tangents<3>(normal);
    const Vec3 across = 0.8 * t + 0.6 * u;
    const auto at = [&](int i) { return points[static_cast<std::size_t>(i)].position; };
    const auto area = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
        return dot(normal, cross(q - p, r - p));
    };

    std::array<int, 4> chosen{};
    chosen[0] = greatest(points, [&](const auto& p) { return dot(across, p.position - at(0)); });
    const Vec3 first = at(chosen[0]);
    chosen[1] = greatest(points, [&](const auto& p) { return length_squared(p.position - first); });
    const Vec3 second = at(chosen[1]);
    chosen[2] = greatest(points, [&](const auto& p) { return std::fabs(area(first, second, p.position)); });
    Vec3 third = at(chosen[2]), turn = second;
    if (area(first, second, third) < 0) std::swap(third, turn);
    chosen[3] = greatest(points, [&](const auto& p) {
        return -std::min(
            {area(first, turn, p.position), area(turn, third, p.position), area(third, first, p.position)});
    });

    int deepest = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (points[i].separation < points[static_cast<std::size_t>(deepest)].separation)
            deepest = static_cast<int>(i);
    }
    const auto separation = [&](int i) { return points[static_cast<std::size_t>(i)].separation; };
    const int lowest = *std::min_element(chosen.begin(), chosen.end(),
                                         [&](int i, int j) { return separation(i) < separation(j); });
    if (is_deeper(separation(deepest), separation(lowest), length(second - first))) {
        *std::min_element(chosen.begin(), chosen.end(), [&](int i, int j) {
            return length_squared(at(i) - at(deepest)) < length_squared(at(j) - at(deepest));
        }) = deepest;
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

/// The two outermost points, or one of them and the deepest where that lies between and is deeper.
std::array<int, 2> pick_two(std::span<const ManifoldPoint<2>> points, const Vec2& normal) {
    const Vec2 along{-normal.y, normal.x};
    const auto place = [&](int i) { return dot(along, points[static_cast<std::size_t>(i)].position); };
    const auto depth = [&](int i) { return points[static_cast<std::size_t>(i)].separation; };
    int low = 0, high = 0, deepest = 0;
    for (int i = 1; i < static_cast<int>(points.size()); ++i) {
        if (place(i) < place(low)) low = i;
        if (place(i) > place(high)) high = i;
        if (depth(i) < depth(deepest)) deepest = i;
    }
    if (is_deeper(depth(deepest), std::min(depth(low), depth(high)), place(high) - place(low)))
        (place(deepest) - place(low) < place(high) - place(deepest) ? low : high) = deepest;
    return {std::min(low, high), std::max(low, high)};
}

template <int D>
auto pick(std::span<const ManifoldPoint<D>> points, const Vec<D>& normal) {
    if constexpr (D == 2)
        return pick_two(points, normal);
    else
        return pick_four(points, normal);
}

}  // namespace

template <int D>
std::size_t merge_points(std::span<ManifoldPoint<D>> points, double snap) {
    std::size_t count = 0;
    for (const ManifoldPoint<D>& point : points) {
        const auto end = points.begin() + static_cast<std::ptrdiff_t>(count);
        const auto same = std::find_if(points.begin(), end, [&](const ManifoldPoint<D>& other) {
            return length_squared(other.position - point.position) <= snap * snap;
        });
        if (same == end) {
            points[count++] = point;
        } else if (point.separation < same->separation) {
            same->position = point.position;
            same->separation = point.separation;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (points[j].feature == points[i].feature) points[i].feature += 0x80;
        }
    }
    return count;
}

template <int D>
Manifold<D> manifold_of(std::span<const ManifoldPoint<D>> points, const Vec<D>& normal) {
    Manifold<D> manifold;
    manifold.normal = normal;
    const auto add = [&](std::size_t i) {
        manifold.points[static_cast<std::size_t>(manifold.count++)] = points[i];
    };
    if (points.size() <= Manifold<D>::capacity) {
        for (std::size_t i = 0; i < points.size(); ++i) add(i);
        return manifold;
    }
    int last = -1;
    for (const int i : pick<D>(points, normal)) {
        if (i != last) add(static_cast<std::size_t>(i));
        last = i;
    }
    return manifold;
}

template std::size_t merge_points(std::span<ManifoldPoint<2>>, double);
template std::size_t merge_points(std::span<ManifoldPoint<3>>, double);
template Manifold<2> manifold_of(std::span<const ManifoldPoint<2>>, const Vec2&);
template Manifold<3> manifold_of(std::span<const ManifoldPoint<3>>, const Vec3&);

}  // namespace carom::detail
