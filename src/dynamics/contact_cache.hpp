#pragma once

#include <array>
#include <cstdint>

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
    Vec<D, float> normal{};  ///< in a's axes
    std::array<Point, Manifold<D>::capacity> points{};
    float roundness_a = 0, roundness_b = 0;
    int count = 0;
    float way = -1;  ///< how far b may move against a before the manifold must be made anew, m; < 0: at once

    void forget() { way = -1; }
    bool holds(const RelativePose<D>& now) const;
};

/// What a manifold outlives: a way of this share of the smaller body's radius, and a turn by this angle.
constexpr double reuse_share = 2e-3;
constexpr double reuse_turn = 1e-3;  // rad

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

}  // namespace carom::detail
