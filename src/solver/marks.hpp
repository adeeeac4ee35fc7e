#pragma once

#include <array>
#include <cstddef>

#include "dynamics/body.hpp"
#include "math/dim.hpp"
#include "solver/contact_rows.hpp"

/// Manifolds that outlive a step, in lanes. As long as two bodies hardly move against each other, the points
/// found when their shapes were last collided are carried along with them (see dynamics/contact_cache.hpp).
namespace carom::detail {

/// The manifold as it was found, one contact a lane. Where the bodies lay is kept as a sum of two floats, so
/// that small differences of large coordinates are exact.
template <int D, class F>
struct ContactMarks {
    struct Point {
        Vec<D, F> on_a{}, on_b{};  ///< from either centre of mass, both in a's axes as they were then
        F separation{};
        F feature{};  ///< its number, where lanes have to know it and it is small enough for a float; else -1
    };

    Vec<D, F> place{}, place_rest{};     ///< of b's centre of mass, seen from a
    Rotation<D, F> turn{}, turn_rest{};  ///< of b, seen from a
    Vec<D, F> normal{};                  ///< in the axes of a, or of b if it is b's
    F is_of_b{};                         ///< 1 if the normal turns with b, else 0
    std::array<Point, max_points<D>> points{};
    F way_squared{};   ///< how far b may move against a before the manifold is to be made anew; < 0: at once
    F turn_squared{};  ///< how far it may turn
    F restitution{};
    F touching{};       ///< 1 if the contact touched when events were last reported, else 0
    F can_be_remade{};  ///< 1 if both shapes are for lanes, which then make the manifold anew; else 0
    F is_newer{};       ///< 1 if they have done so since the contact was written; else 0
};

/// Where a point is marked whose place on the bodies is not known: it is found again by its feature alone.
constexpr float unknown_place = 1e6f;

/// The separation of a point that is not there.
constexpr float no_separation = 1e30f;

/// Where a body is, as many of them as there are lanes.
template <int D, class F>
struct Pose {
    Vec<D, Wide<F>> position{};
    Rotation<D, Wide<F>> rotation{};
};

/// The states of all bodies as an array of doubles.
template <int D>
struct PoseView {
    static constexpr std::size_t stride = sizeof(BodyState<D>) / sizeof(double);
    static_assert(offsetof(BodyState<D>, position) == 0);
    static_assert(offsetof(BodyState<D>, rotation) == D * sizeof(double));
    static_assert(sizeof(BodyState<D>) % sizeof(double) == 0);

    const double* states = nullptr;
};

template <class F>
CAROM_INLINE Pose<2, F> gather_pose(const PoseView<2>& view, const std::uint32_t* bodies) {
    Pose<2, F> pose;
    gather_pairs(view.states, bodies, PoseView<2>::stride, pose.position.x, pose.position.y);
    gather_pairs(view.states + 2, bodies, PoseView<2>::stride, pose.rotation.c, pose.rotation.s);
    return pose;
}
template <class F>
CAROM_INLINE Pose<3, F> gather_pose(const PoseView<3>& view, const std::uint32_t* bodies) {
    Pose<3, F> pose;
    Wide<F> unused;
    gather_pairs(view.states, bodies, PoseView<3>::stride, pose.position.x, pose.position.y);
    gather_pairs(view.states + 2, bodies, PoseView<3>::stride, pose.position.z, pose.rotation.x);
    gather_pairs(view.states + 4, bodies, PoseView<3>::stride, pose.rotation.y, pose.rotation.z);
    gather_pairs(view.states + 6, bodies, PoseView<3>::stride, pose.rotation.w, unused);
    return pose;
}

template <class F>
CAROM_INLINE Rotation<2, Wide<F>> sum_of(const Rotation<2, F>& q, const Rotation<2, F>& rest) {
    using W = Wide<F>;
    return {W(q.c) + W(rest.c), W(q.s) + W(rest.s)};
}
template <class F>
CAROM_INLINE Rotation<3, Wide<F>> sum_of(const Rotation<3, F>& q, const Rotation<3, F>& rest) {
    using W = Wide<F>;
    return {W(q.x) + W(rest.x), W(q.y) + W(rest.y), W(q.z) + W(rest.z), W(q.w) + W(rest.w)};
}

/// The rotation vector of a small rotation to third order, and whether it is one. 2D: θ ≈ sin θ; 3D: θ ≈ 2
/// sin θ/2, either sign of the quaternion being the same rotation.
template <class F>
CAROM_INLINE auto small_turn(const Rotation<2, Wide<F>>& q, Angular<2, F>& angle) {
    angle = F(q.s);
    return F(q.c) > F(0);
}
template <class F>
CAROM_INLINE auto small_turn(const Rotation<3, Wide<F>>& q, Angular<3, F>& angle) {
    const F w(q.w), sign = select(F(0) > w, F(-2), F(2));
    angle = Vec<3, F>{F(q.x), F(q.y), F(q.z)} * sign;
    return fabs(w) > F(0.5f);
}

template <class F>
CAROM_INLINE Rotation<2, F> narrowed(const Rotation<2, Wide<F>>& q) {
    return {F(q.c), F(q.s)};
}
template <class F>
CAROM_INLINE Rotation<3, F> narrowed(const Rotation<3, Wide<F>>& q) {
    return {F(q.x), F(q.y), F(q.z), F(q.w)};
}

template <class Mask, class F>
CAROM_INLINE Rotation<2, F> selected(Mask mask, const Rotation<2, F>& yes, const Rotation<2, F>& no) {
    return {select(mask, yes.c, no.c), select(mask, yes.s, no.s)};
}
template <class Mask, class F>
CAROM_INLINE Rotation<3, F> selected(Mask mask, const Rotation<3, F>& yes, const Rotation<3, F>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z),
            select(mask, yes.w, no.w)};
}

/// How far the rotation vector θ moves the end of an arm: θ × r + ½ θ × (θ × r).
template <int D, class F>
CAROM_INLINE Vec<D, F> way_of(const Angular<D, F>& angle, const Vec<D, F>& arm) {
    const Vec<D, F> first = cross(angle, arm);
    return first + F(0.5f) * cross(angle, first);
}

/// Carries the points along to where the bodies are now. Points out of reach are left out. The result tells
/// the lanes for which that does not do: the bodies have moved too far, and the rows keep the impulses and
/// which points have some; or all points are out of reach.
template <int D, class F>
CAROM_INLINE auto refresh(ContactRows<D, F>& rows, const ContactMarks<D, F>& marks, const Pose<D, F>& a,
                          const Pose<D, F>& b, F reach) {
    using W = Wide<F>;
    const Vec<D, W> place = unrotate(a.rotation, Vec<D, W>(b.position - a.position));
    Vec<D, F> way;
    for (int i = 0; i < D; ++i) way[i] = F(place[i] - (W(marks.place[i]) + W(marks.place_rest[i])));
    Angular<D, F> angle{};
    const auto near_turn = small_turn<F>(
        (inverse(a.rotation) * b.rotation) * inverse(sum_of(marks.turn, marks.turn_rest)), angle);
    const auto holds = both(near_turn, both(!(dot(way, way) > marks.way_squared),
                                            !(angular_dot(angle, angle) > marks.turn_squared)));

    const Rotation<D, F> axes = narrowed<F>(a.rotation), axes_b = narrowed<F>(b.rotation);
    const auto of_b = marks.is_of_b > F(0.5f);
    const Vec<D, F> friction = along_tangents(rows, rows.friction_impulse);
    set_normal(rows, rotate(selected(of_b, axes_b, axes), marks.normal));
    const Vec<D, F> turned = unrotate(axes, rows.normal);
    ContactFrame<D, F> frame;  // in a's axes
    for (int i = 0; i < D; ++i) frame.normal[i] = select(of_b, turned[i], marks.normal[i]);
    if constexpr (D == 2) {
        frame.tangents = tangents<2>(frame.normal);
    } else {
        frame.tangents[0] = unrotate(axes, rows.tangent);
        frame.tangents[1] = cross(frame.normal, frame.tangents[0]);
    }
    const auto t = frame_of(rows).tangents;
    for (int i = 0; i < D - 1; ++i) {
        rows.friction_impulse[i] = dot(friction, t[i]);
        rows.total_friction[i] = F(0);
    }
    F most_used = F(0);
    std::array<Vec<D, F>, max_points<D>> arms_a, arms_b;
    for (int k = 0; k < max_points<D>; ++k) {
        const auto& mark = marks.points[k];
        NormalRow<D, F>& p = rows.points[k];
        const Vec<D, F> parted = way + way_of<D>(angle, mark.on_b);
        p.separation = mark.separation + dot(frame.normal, parted);
        arms_a[k] = mark.on_a + F(0.5f) * parted;
        arms_b[k] = mark.on_b - way + F(0.5f) * parted;
        const F used = select(p.separation > reach, F(0), F(1));
        most_used = maximum(most_used, used);
        p.mass = select(holds, used, p.mass);
        p.impulse = select(both(holds, F(0.5f) > used), F(0), p.impulse);
        p.total_impulse = F(0);
    }
    place_points(rows, frame, arms_a, arms_b);
    return !both(holds, most_used > F(0));
}

/// Shapes that touched go on touching until the gap is larger than this, so that what trembles at rest does
/// not report an end and a beginning every other step.
constexpr float parting_distance = 0.002f;  // m

/// Which contacts have begun or ended to touch: one begins when it carries an impulse or overlaps, and ends
/// when it has done neither and its gap is wide.
template <int D, class F>
CAROM_INLINE auto touch(const ContactRows<D, F>& rows, ContactMarks<D, F>& marks) {
    F held = F(0), near = F(0);
    for (const NormalRow<D, F>& p : rows.points) {
        const auto used = p.mass > F(0);
        held = select(p.total_impulse > F(0), F(1), select(both(used, !(p.separation > F(0))), F(1), held));
        near = select(both(used, !(p.separation > F(parting_distance))), F(1), near);
    }
    const F before = marks.touching;
    marks.touching = maximum(held, before * near);
    return fabs(marks.touching - before) > F(0);
}

}  // namespace carom::detail
