#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "geometry/shape.hpp"

/// Mass properties of a convex solid by quadrature over rays from a point inside it: with the distance ρ(u)
/// to the surface along each direction u, the volume is ⅓ ∫ ρ³ du, and so on. Knows nothing of the closed
/// forms.
namespace carom::test {

/// The distance to the surface along a unit vector.
template <int D>
using Exit = std::function<double(const Vec<D>&)>;

inline MassProperties2 by_rays(const Vec2& inside, const Exit<2>& exit, int count) {
    double size = 0, second = 0;
    Vec2 first{};
    const double share = 2 * std::numbers::pi / count;
    for (int i = 0; i < count; ++i) {
        const double angle = (i + 0.5) * share;
        const Vec2 u{std::cos(angle), std::sin(angle)};
        const double r = exit(u);
        size += share * r * r / 2;
        first += share * r * r * r / 3 * u;
        second += share * r * r * r * r / 4;
    }
    const Vec2 center = first / size;
    return {size, inside + center, second - size * dot(center, center)};
}

/// Directions on a spiral that covers the sphere evenly (Fibonacci's lattice).
inline MassProperties3 by_rays(const Vec3& inside, const Exit<3>& exit, int count) {
    double size = 0;
    Vec3 first{};
    Symmetric3<double> second{};
    const double share = 4 * std::numbers::pi / count, turn = std::numbers::pi * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, across = std::sqrt(1 - z * z);
        const Vec3 u{across * std::cos(i * turn), across * std::sin(i * turn), z};
        const double r = exit(u), r3 = share * r * r * r;
        size += r3 / 3;
        first += r3 * r / 4 * u;
        second =
            second + Symmetric3<double>{u.x * u.x, u.y * u.y, u.z * u.z, u.x * u.y, u.x * u.z, u.y * u.z} *
                         (r3 * r * r / 5);
    }
    const Vec3 c = first / size;
    second =
        second - Symmetric3<double>{c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.x * c.z, c.y * c.z} * size;
    // About the x axis ∫ y² + z², and so on.
    return {size,
            inside + c,
            {second.yy + second.zz, second.zz + second.xx, second.xx + second.yy, -second.xy, -second.xz,
             -second.yz}};
}

constexpr double never = -std::numeric_limits<double>::infinity();

/// Where the ray o + t u, u of any length, leaves the ball around `center`; never when it misses it.
template <int D>
double leaves_ball(const Vec<D>& o, const Vec<D>& u, const Vec<D>& center, double radius) {
    const Vec<D> d = o - center;
    const double a = dot(u, u), b = dot(u, d), c = dot(d, d) - radius * radius, root = b * b - a * c;
    return root >= 0 && a > 0 ? (std::sqrt(root) - b) / a : never;
}

template <int D>
double leaves_capsule(const Vec<D>& o, const Vec<D>& u, const Vec<D>& from, const Vec<D>& to, double radius) {
    double last = std::max(leaves_ball(o, u, from, radius), leaves_ball(o, u, to, radius));
    const Vec<D> along = to - from;
    const double square = dot(along, along);
    if (square > 0) {
        // The cylinder around the segment, seen along its axis.
        const auto across = [&](const Vec<D>& v) { return v - along * (dot(along, v) / square); };
        const double t = leaves_ball(across(o - from), across(u), Vec<D>{}, radius);
        const double place = dot(o + t * u - from, along) / square;
        if (t > 0 && place >= 0 && place <= 1) last = std::max(last, t);
    }
    return last;
}

/// A polytope by its corners, its edges as pairs of corners, and its faces as loops of corners with normals.
template <int D>
struct Rounded {
    struct Face {
        Vec<D> normal;
        std::vector<Vec<D>> loop;
    };
    std::vector<std::pair<Vec<D>, Vec<D>>> edges;
    std::vector<Face> faces;
    double radius = 0;

    double leaves(const Vec<D>& o, const Vec<D>& u) const {
        double last = never;
        if (radius > 0) {
            for (const auto& [from, to] : edges)
                last = std::max(last, leaves_capsule(o, u, from, to, radius));
        }
        for (const Face& face : faces) {
            const double speed = dot(face.normal, u);
            if (speed <= 0) continue;
            const double t = (dot(face.normal, face.loop[0] - o) + radius) / speed;
            if (covers(face, o + t * u)) last = std::max(last, t);
        }
        return last;
    }

    static bool covers(const Face& face, const Vec<D>& p) {
        const std::size_t count = face.loop.size();
        if constexpr (D == 2) {
            const Vec2 along = face.loop[1] - face.loop[0];
            return dot(p - face.loop[0], along) >= 0 && dot(p - face.loop[1], along) <= 0;
        } else {
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3 along = face.loop[(i + 1) % count] - face.loop[i];
                if (dot(cross(along, p - face.loop[i]), face.normal) < -1e-12) return false;
            }
            return true;
        }
    }
};

inline Rounded<2> rounded(const detail::Polygon& polygon, double radius) {
    Rounded<2> result;
    result.radius = radius;
    for (std::size_t i = 0; i < polygon.vertices.size(); ++i) {
        const Vec2 &a = polygon.vertices[i], &b = polygon.vertices[(i + 1) % polygon.vertices.size()];
        result.edges.push_back({a, b});
        result.faces.push_back({polygon.normals[i], {a, b}});
    }
    return result;
}

inline Rounded<3> rounded(const detail::Polyhedron& polyhedron, double radius) {
    Rounded<3> result;
    result.radius = radius;
    for (const auto& edge : polyhedron.edges) {
        result.edges.push_back({polyhedron.vertices[edge.from], polyhedron.vertices[edge.to]});
    }
    for (std::size_t f = 0; f < polyhedron.normals.size(); ++f) {
        Rounded<3>::Face face{polyhedron.normals[f], {}};
        for (auto i = polyhedron.first[f]; i < polyhedron.first[f + 1]; ++i) {
            face.loop.push_back(polyhedron.vertices[polyhedron.indices[i]]);
        }
        result.faces.push_back(face);
    }
    return result;
}

}  // namespace carom::test
