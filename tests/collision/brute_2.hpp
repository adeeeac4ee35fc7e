#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/shape.hpp"
#include "random.hpp"

namespace carom::test {

/// A placed 2D shape as the points whose convex hull, grown by the radius, it is. What is asked of it is
/// answered by trying all points and all pairs of points, which knows nothing of edges, normals or order.
struct Cloud {
    std::vector<Vec2> points;
    double radius = 0;

    Cloud(const ShapeDefinition2& definition, const Transform2& placed) {
        if (const auto* ball = std::get_if<Ball>(&definition.geometry)) {
            points = {Vec2{}};
            radius = ball->radius;
        } else if (const auto* capsule = std::get_if<Capsule2>(&definition.geometry)) {
            points = {capsule->from, capsule->to};
            radius = capsule->radius;
        } else if (const auto* box = std::get_if<Box2>(&definition.geometry)) {
            radius = box->rounding;
            const Vec2 half = 0.5 * box->size - Vec2{radius, radius};
            points = {half, {-half.x, half.y}, {half.x, -half.y}, -half};
        } else if (const auto* hull = std::get_if<Hull2>(&definition.geometry)) {
            // A hull leaves out corners that are all but in line with their neighbours.
            points = detail::convex_polygon(hull->points).vertices;
            radius = hull->rounding;
        }
        const Transform2 local{definition.center, definition.rotation};
        for (Vec2& point : points) point = apply(placed, apply(local, point));
    }

    double highest(const Vec2& u) const {
        double best = -std::numeric_limits<double>::infinity();
        for (const Vec2& point : points) best = std::max(best, dot(u, point));
        return best;
    }
};

inline double distance_to_segment(const Vec2& point, const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    const double whole = length_squared(along);
    const double share = whole > 0 ? std::clamp(dot(point - from, along) / whole, 0.0, 1.0) : 0.0;
    return length(point - from - share * along);
}

/// Gap of the two shapes along the unit vector from a to b.
inline double gap_along(const Cloud& a, const Cloud& b, const Vec2& u) {
    return -b.highest(-u) - a.highest(u) - a.radius - b.radius;
}

/// Distance of the shapes, or minus the depth.
inline double signed_distance(const Cloud& a, const Cloud& b) {
    // Depth: the least overlap along all directions across a pair of points.
    double depth = std::numeric_limits<double>::infinity();
    for (const Cloud* cloud : {&a, &b}) {
        for (const Vec2& p : cloud->points) {
            for (const Vec2& q : cloud->points) {
                const Vec2 across = normalized(Vec2{q.y - p.y, p.x - q.x});
                if (length_squared(across) > 0)
                    depth = std::min(depth, a.highest(across) + b.highest(-across));
            }
        }
    }
    if (depth > 1e-12 && depth < std::numeric_limits<double>::infinity()) return -depth - a.radius - b.radius;
    double distance = std::numeric_limits<double>::infinity();
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const Vec2& point : one->points)
            for (const Vec2& from : other->points)
                for (const Vec2& to : other->points)
                    distance = std::min(distance, distance_to_segment(point, from, to));
    return distance - a.radius - b.radius;
}

/// Distance of a point from the shape, or minus its depth in it.
inline double signed_distance(const Cloud& a, const Vec2& point) {
    Cloud single = a;
    single.points = {point};
    single.radius = 0;
    return signed_distance(a, single);
}

enum class Kind { ball, capsule, box, hull };
constexpr Kind round_kinds[] = {Kind::ball, Kind::capsule, Kind::box, Kind::hull};

/// A shape of that kind, `size` large, anywhere on its body.
inline ShapeDefinition2 random_shape(Kind kind, Random& random, double size) {
    ShapeDefinition2 shape;
    const double rounding = random.below(2) ? 0 : size * random.between(0.01, 0.3);
    switch (kind) {
        case Kind::ball:
            shape.geometry = Ball{size * random.between(0.1, 1)};
            break;
        case Kind::capsule:
            shape.geometry =
                Capsule2{random.in_cube<2>(size), random.in_cube<2>(size), size * random.between(0.05, 0.5)};
            break;
        case Kind::box: {
            const Vec2 core{size * random.between(0.05, 2), size * random.between(0.05, 2)};
            shape.geometry = Box2{core + Vec2{2 * rounding, 2 * rounding}, rounding};
            break;
        }
        case Kind::hull: {
            // A triangle that may be a sliver, and some points more.
            const Vec2 tip{size * random.between(-1, 1), size * std::pow(100, -random.unit())};
            Hull2 hull{{{-0.5 * size, 0}, {0.5 * size, 0}, tip}, rounding};
            for (int more = random.below(3) * random.below(4); more > 0; --more)
                hull.points.push_back(random.in_cube<2>(size));
            shape.geometry = hull;
            break;
        }
    }
    shape.center = random.in_cube<2>(size);
    shape.rotation = random.rotation<2>();
    return shape;
}

/// The same on a coarse grid and turned by right angles only, so that edges lie in one line, corners touch
/// and depths are equal in several directions, all exactly.
inline ShapeDefinition2 grid_shape(Kind kind, Random& random) {
    const auto grid = [&] { return 0.5 * (random.below(5) - 2); };
    const auto size = [&] { return 0.5 * (1 + random.below(4)); };
    const double rounding = 0.25 * random.below(2);
    ShapeDefinition2 shape;
    switch (kind) {
        case Kind::ball:
            shape.geometry = Ball{size()};
            break;
        case Kind::capsule:
            shape.geometry = Capsule2{{grid(), grid()}, {grid(), grid()}, size()};
            break;
        case Kind::box:
            shape.geometry = Box2{{size() + 2 * rounding, size() + 2 * rounding}, rounding};
            break;
        case Kind::hull: {
            const double left = grid(), low = grid();
            Hull2 hull{{{left, low}, {left + size(), low}, {left, low + size()}}, rounding};
            if (random.below(2)) hull.points.push_back({left + size(), low + size()});
            shape.geometry = hull;
            break;
        }
    }
    shape.center = {grid(), grid()};
    return shape;
}

inline Rotation2 right_angle(Random& random) {
    constexpr Rotation2 turns[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    return turns[random.below(4)];
}

}  // namespace carom::test
