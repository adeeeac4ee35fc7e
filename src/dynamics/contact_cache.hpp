#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "carom/collide.hpp"
#include "dynamics/body.hpp"
#include "math/dim.hpp"

namespace carom::detail {

/// How b lies relative to a: its centre of mass and its rotation as seen from a.
template <int D>
struct RelativePose {
    Vec<D> position{};
    Rotation<D> rotation{};

    RelativePose() = default;
    RelativePose(const BodyState<D>& a, const BodyState<D>& b)
        : position(unrotate(a.rotation, b.position - a.position)),
          rotation(inverse(a.rotation) * b.rotation) {}
};

/// The manifold of two shapes as it was when it was last worked out, each point marked on both bodies. While
/// the bodies hardly move against each other, the same points, carried along, are the manifold still.
///
/// The error is bounded: the marks of a point part by no more than the way and the turn allowed below, so a
/// gap is wrong by at most their product with the angle between the two faces, and the edge of the patch by
/// the way itself. Nothing adds up from step to step, as the comparison is always with the pose at which the
/// shapes were collided.
template <int D>
struct ContactCache {
    struct Point {
        Vec<D> on_a{}, on_b{};  ///< from the centres of mass, in the bodies' axes; a fixed body may be large
        float separation = 0;
        std::uint32_t feature = 0;
    };

    RelativePose<D> pose{};
    Vec<D, float> normal{};  ///< in a's axes; where there are no points, what may hold the shapes apart
    std::array<Point, Manifold<D>::capacity> points{};
    float roundness_a = 0, roundness_b = 0;
    int count = 0;
    float gap = 0;   ///< where there are no points and `normal` is not zero: the gap along it, m
    float way = -1;  ///< how far b may move against a before the manifold must be made anew, m; < 0: at once

    void forget() { way = -1; }
    bool holds(const RelativePose<D>& now) const;
    /// How far apart the shapes are at least: all points of b are within `radius_b` (0: infinite) of its
    /// centre, so they have come nearer along the normal by no more than it did and its turn adds. Minus
    /// infinity where that is not known.
    double least_gap(const RelativePose<D>& now, double radius_b) const;
};

/// What a manifold outlives: a way of this share of the smaller body's radius, and a turn by this angle.
constexpr double reuse_share = 5e-3;
constexpr double reuse_turn = 5e-3;  // rad

template <int D>
bool ContactCache<D>::holds(const RelativePose<D>& now) const {
    const Vec<D> way_gone = now.position - pose.position;
    if (way < 0 || dot(way_gone, way_gone) > double{way} * way) return false;
    if constexpr (D == 2) {
        const double sine = now.rotation.s * pose.rotation.c - now.rotation.c * pose.rotation.s;
        const double cosine = now.rotation.c * pose.rotation.c + now.rotation.s * pose.rotation.s;
        return cosine > 0 && std::fabs(sine) <= reuse_turn;
    } else {
        // q · q₀ = cos of half the angle between them, whatever their signs.
        const Rotation<3>&q = now.rotation, &r = pose.rotation;
        const double cosine = q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w;
        return cosine * cosine >= 1 - 0.25 * reuse_turn * reuse_turn;
    }
}

template <int D>
double ContactCache<D>::least_gap(const RelativePose<D>& now, double radius_b) const {
    if (count > 0 || way < 0 || normal == Vec<D, float>{} || radius_b == 0)
        return -std::numeric_limits<double>::infinity();
    const double along = dot(narrow<double>(normal), now.position - pose.position);
    double half_turn;  // sine of half the angle, at least
    if constexpr (D == 2) {
        half_turn = 0.5 * length(Vec2{now.rotation.c - pose.rotation.c, now.rotation.s - pose.rotation.s});
    } else {
        const Rotation<3>&q = now.rotation, &r = pose.rotation;
        const double cosine = q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w;
        half_turn = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    }
    return gap + along - 2 * half_turn * radius_b;
}

}  // namespace carom::detail
