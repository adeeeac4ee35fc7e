#pragma once

#include "solver/marks.hpp"

/// Pairs of shapes that are near each other and do not touch: seen in lanes until they may.
namespace carom::detail {

/// What held two shapes apart when they were last looked at: a gap along an axis. Where the bodies lay is
/// kept as a sum of two floats.
template <int D, class F>
struct ApartMarks {
    Vec<D, F> place{}, place_rest{};     ///< of b's centre of mass, seen from a
    Rotation<D, F> turn{}, turn_rest{};  ///< of b, seen from a
    Vec<D, F> normal{};                  ///< in a's axes
    F gap{};                             ///< along it
    F radius_a{}, radius_b{};            ///< of balls about the centres of mass that hold the bodies
    F can_be_remade{};                   ///< 1 if both shapes are for lanes, which then look anew; else 0
};

/// How far pairs may go without a look.
template <class F>
struct ApartLimits {
    F reach;     ///< contacts have points from this gap on, m
    F slow_way;  ///< bodies that come less far against each other in a step do not meet within it unseen, m
    F dt;        ///< length of the step, s
    F falling;   ///< way that gravity may add in it, m
};

/// How fast bodies move, as many of them as there are lanes.
template <int D, class F>
struct Speeds {
    Vec<D, Wide<F>> velocity{};
    F turning{};  ///< rad/s
};

template <class F>
CAROM_INLINE Speeds<2, F> gather_speeds(const PoseView<2>& view, const std::uint32_t* bodies) {
    static_assert(offsetof(BodyState<2>, velocity) == 4 * sizeof(double));
    Speeds<2, F> speeds;
    Wide<F> spin, unused;
    gather_pairs(view.states + 4, bodies, PoseView<2>::stride, speeds.velocity.x, speeds.velocity.y);
    gather_pairs(view.states + 6, bodies, PoseView<2>::stride, spin, unused);
    speeds.turning = fabs(F(spin));
    return speeds;
}
template <class F>
CAROM_INLINE Speeds<3, F> gather_speeds(const PoseView<3>& view, const std::uint32_t* bodies) {
    static_assert(offsetof(BodyState<3>, velocity) == 7 * sizeof(double));
    Speeds<3, F> speeds;
    Vec<3, Wide<F>> spin;
    gather_pairs(view.states + 7, bodies, PoseView<3>::stride, speeds.velocity.x, speeds.velocity.y);
    gather_pairs(view.states + 9, bodies, PoseView<3>::stride, speeds.velocity.z, spin.x);
    gather_pairs(view.states + 11, bodies, PoseView<3>::stride, spin.y, spin.z);
    const Vec<3, F> turning{F(spin.x), F(spin.y), F(spin.z)};
    speeds.turning = square_root(dot(turning, turning));
    return speeds;
}

/// Sine of half the angle between two rotations, at least.
template <class F>
CAROM_INLINE F half_turn_between(const Rotation<2, Wide<F>>& q, const Rotation<2, Wide<F>>& r) {
    const F c(q.c - r.c), s(q.s - r.s);
    return F(0.5f) * square_root(c * c + s * s);
}
template <class F>
CAROM_INLINE F half_turn_between(const Rotation<3, Wide<F>>& q, const Rotation<3, Wide<F>>& r) {
    const Wide<F> cosine = q.x * r.x + q.y * r.y + q.z * r.z + q.w * r.w;
    return square_root(maximum(F(Wide<F>(1) - cosine * cosine), F(0)));
}

/// The lanes that are to be looked at: the shapes may be within reach (see `ContactCache::least_gap`), or
/// come there in the step at the speeds of its start.
template <int D, class F>
CAROM_INLINE auto may_touch(const ApartMarks<D, F>& marks, const Pose<D, F>& a, const Pose<D, F>& b,
                            const Speeds<D, F>& speed_a, const Speeds<D, F>& speed_b,
                            const ApartLimits<F>& limits) {
    using W = Wide<F>;
    const Vec<D, W> place = unrotate(a.rotation, Vec<D, W>(b.position - a.position));
    const Vec<D, W> velocity = unrotate(a.rotation, Vec<D, W>(speed_b.velocity - speed_a.velocity));
    Vec<D, F> way, speed;
    for (int i = 0; i < D; ++i) {
        way[i] = F(place[i] - (W(marks.place[i]) + W(marks.place_rest[i])));
        speed[i] = F(velocity[i]);
    }
    const F half_turn =
        half_turn_between<F>(inverse(a.rotation) * b.rotation, sum_of(marks.turn, marks.turn_rest));
    const F gap = marks.gap + dot(marks.normal, way) - F(2) * half_turn * marks.radius_b;
    const F turning =
        limits.dt * (speed_a.turning * marks.radius_a + speed_b.turning * marks.radius_b) + limits.falling;
    const F parting = limits.dt * dot(marks.normal, speed);
    const auto is_slow = !(limits.dt * square_root(dot(speed, speed)) + turning > limits.slow_way);
    const F least = select(is_slow, gap, gap - maximum(turning - parting, F(0)));
    return !(least > limits.reach);
}

}  // namespace carom::detail
