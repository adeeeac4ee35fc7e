#include <algorithm>

#include "geometry/hull.hpp"

namespace carom::detail {
namespace {

/// Andrew 1979, Another efficient algorithm for convex hulls in two dimensions: the lower and the upper chain
/// over the points in order of x. Corners counter-clockwise.
std::vector<Vec2> monotone_chain(std::vector<Vec2> points) {
    const auto before = [](const Vec2& a, const Vec2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    std::vector<Vec2> hull;
    const auto add = [&hull](const Vec2& p, std::size_t first) {
        while (hull.size() >= first + 2 &&
               cross(hull.back() - hull[hull.size() - 2], p - hull[hull.size() - 2]) <= 0) {
            hull.pop_back();
        }
        hull.push_back(p);
    };
    for (const Vec2& p : points) add(p, 0);
    hull.pop_back();
    const std::size_t upper = hull.size();
    for (auto p = points.rbegin(); p != points.rend(); ++p) add(*p, upper);
    hull.pop_back();
    return hull;
}

/// Leaves out corners that lie within the tolerance of the straight line between those that stay.
std::vector<Vec2> simplified(const std::vector<Vec2>& ring, double tolerance) {
    // The corner furthest from another one is a true corner: start there.
    std::size_t start = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        if (length_squared(ring[i] - ring[0]) > length_squared(ring[start] - ring[0])) start = i;
    }
    const auto corner = [&](std::size_t i) -> const Vec2& { return ring[(start + i) % ring.size()]; };
    const auto is_straight = [&](std::size_t first, std::size_t last) {
        const Vec2 along = corner(last) - corner(first);
        for (std::size_t i = first + 1; i < last; ++i) {
            const Vec2 r = corner(i) - corner(first);
            const double beside = std::fabs(cross(along, r)), reach = length(along);
            if (beside > tolerance * reach || length(r) > reach + tolerance) return false;
        }
        return true;
    };
    std::vector<Vec2> kept;
    for (std::size_t first = 0; first < ring.size();) {
        kept.push_back(corner(first));
        std::size_t next = first + 1;
        while (next < ring.size() && is_straight(first, next + 1)) ++next;
        first = next;
    }
    return kept;
}

/// The smallest distance between two parallel lines with the polygon between them.
double width(const Polygon& polygon) {
    double narrowest = 1e300;
    for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
        double depth = 0;
        for (const Vec2& v : polygon.vertices) {
            depth = std::max(depth, dot(polygon.normals[i], polygon.vertices[i] - v));
        }
        narrowest = std::min(narrowest, depth);
    }
    return narrowest;
}

}  // namespace

Polygon convex_polygon(const std::vector<Vec2>& points) {
    check_points<2>(points);
    const double extent = extent_of<2>(points);
    Polygon polygon;
    if (extent > 0) polygon.vertices = simplified(monotone_chain(points), hull_tolerance * extent);
    const std::size_t count = polygon.vertices.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 along = polygon.vertices[(i + 1) % count] - polygon.vertices[i];
        polygon.normals.push_back(normalized(Vec2{along.y, -along.x}));
    }
    if (count < 3 || width(polygon) < thinnest_hull * extent) {
        throw Error("points: " + std::to_string(points.size()) + " points span no area");
    }
    return polygon;
}

}  // namespace carom::detail
