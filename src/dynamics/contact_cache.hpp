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
/// The normal turns with the body whose face gives it, so the gap of a corner over a face is exact. What is
/// wrong by no more than the way is the edge of the patch; and where two edges or corners meet, a gap by no
/// more than the way times the turn, so that less of both is allowed there. Nothing adds up from step to
/// step, as the comparison is always with the pose at which the shapes were collided.
template <int D>
struct ContactCache {
    struct Point {
        Vec<D> on_a{}, on_b{};  ///< from the centres of mass, in the bodies' axes; a fixed body may be large
        float separation = 0;
        std::uint32_t feature = 0;
    };

    RelativePose<D> pose{};
    Vec<D, float> normal{};  ///< in a's axes; where there are no points, what may hold the shapes apart
    NormalOf normal_of = NormalOf::neither;  ///< with whom it turns; with a where it is neither's
    std::array<Point, Manifold<D>::capacity> points{};
    float roundness_a = 0, roundness_b = 0;
    int count = 0;
    float gap = 0;   ///< where there are no points and `normal` is not zero: the gap along it, m
    float way = -1;  ///< how far b may move against a before the manifold must be made anew, m; < 0: at once
    float turn = 0;  ///< and how far it may turn, rad

    void forget() { way = -1; }
    /// Is it known what holds the shapes apart?
    bool tells_of_gap() const { return count == 0 && way >= 0 && normal != Vec<D, float>{}; }
    bool holds(const RelativePose<D>& now) const;
    /// How far apart the shapes are at least: all points of b are within `radius_b` (0: infinite) of its
    /// centre, so they have come nearer along the normal by no more than it did and its turn adds. Minus
    /// infinity where that is not known.
    double least_gap(const RelativePose<D>& now, double radius_b) const;
};

/// What a manifold outlives: a way of this share of the smaller body's radius, and the turn that moves the
/// body's outermost point as far. Points that were left out were beyond reach (`speculative_distance`) by the
/// way at least, so none of them can have come to overlap as long as that is no more than the reach.
constexpr double reuse_share = 0.03;
constexpr double reuse_way = 0.02;  // m, at most
/// Of these, the share that is allowed where the normal is nobody's.
constexpr float reuse_without_face = 1.0f / 6;

template <int D>
bool ContactCache<D>::holds(const RelativePose<D>& now) const {
    const Vec<D> way_gone = now.position - pose.position;
    if (way < 0 || dot(way_gone, way_gone) > double{way} * way) return false;
    if constexpr (D == 2) {
        const double sine = now.rotation.s * pose.rotation.c - now.rotation.c * pose.rotation.s;
        const double cosine = now.rotation.c * pose.rotation.c + now.rotation.s * pose.rotation.s;
        return cosine > 0 && std::fabs(sine) <= double{turn};
    } else {
        // q · q₀ = cos of half the angle between them, whatever their signs.
        const Rotation<3>&q = now.rotation, &r = pose.rotation;
        const double cosine = q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w;
        return cosine * cosine >= 1 - 0.25 * double{turn} * turn;
    }
}

template <int D>
double ContactCache<D>::least_gap(const RelativePose<D>& now, double radius_b) const {
    if (!tells_of_gap() || radius_b == 0) return -std::numeric_limits<double>::infinity();
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
