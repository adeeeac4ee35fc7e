#pragma once

#include <cstddef>

#include "solver/body_records.hpp"
#include "solver/drive.hpp"
#include "solver/marks.hpp"

/// Bodies taken up by the solver and put down again, many at once. For any lane type.
namespace carom::detail {

/// Where the solver finds the bodies of its slots, and leaves them.
template <int D>
struct BodySource {
    BodyState<D>* states = nullptr;
    const BodyMass<D>* masses = nullptr;
    const Load<D>* loads = nullptr;
    const std::uint32_t* bodies = nullptr;  ///< by slot
    float* present = nullptr;               ///< by slot: 1 if its body is to be taken up so, else 0

    /// May the body be taken up so? It can be pushed and turned in all directions, turns steadily by itself,
    /// and nothing damps it.
    static bool is_plain(const BodyMass<D>& mass) {
        return mass.inverse_mass != 0 && mass.linear_damping == 0 && mass.angular_damping == 0 &&
               (D == 2 || mass.isotropic) && mass.locks == Locks{};
    }
};

/// Bodies that are plain, as the solver needs them.
template <int D, class F>
struct PlainBody {
    Vec<D, Wide<F>> velocity{}, force{};
    Angular<D, Wide<F>> spin{}, torque{};
    Wide<F> inverse_mass{};
    Inertia<D, Wide<F>> inverse_inertia{};
};

template <class F>
CAROM_INLINE PlainBody<2, F> gather_plain(const BodySource<2>& from, const std::uint32_t* bodies) {
    static_assert(offsetof(BodyState<2>, velocity) == 4 * sizeof(double));
    static_assert(offsetof(BodyState<2>, angular_velocity) == 6 * sizeof(double));
    static_assert(offsetof(BodyMass<2>, inverse_mass) == 1 * sizeof(double));
    static_assert(offsetof(BodyMass<2>, inverse_inertia) == 5 * sizeof(double));
    constexpr std::size_t mass_stride = sizeof(BodyMass<2>) / sizeof(double), load_stride = 3;
    static_assert(sizeof(Load<2>) == load_stride * sizeof(double));
    const auto* states = reinterpret_cast<const double*>(from.states);
    const auto* masses = reinterpret_cast<const double*>(from.masses);
    const auto* loads = reinterpret_cast<const double*>(from.loads);
    PlainBody<2, F> body;
    Wide<F> unused;
    gather_pairs(states + 4, bodies, PoseView<2>::stride, body.velocity.x, body.velocity.y);
    gather_pairs(states + 6, bodies, PoseView<2>::stride, body.spin, unused);
    gather_pairs(masses, bodies, mass_stride, unused, body.inverse_mass);
    gather_pairs(masses + 4, bodies, mass_stride, unused, body.inverse_inertia);
    gather_pairs(loads, bodies, load_stride, body.force.x, body.force.y);
    gather_pairs(loads + 1, bodies, load_stride, unused, body.torque);
    return body;
}

template <class F>
CAROM_INLINE PlainBody<3, F> gather_plain(const BodySource<3>& from, const std::uint32_t* bodies) {
    static_assert(offsetof(BodyState<3>, velocity) == 7 * sizeof(double));
    static_assert(offsetof(BodyState<3>, angular_velocity) == 10 * sizeof(double));
    static_assert(offsetof(BodyMass<3>, inverse_mass) == 1 * sizeof(double));
    static_assert(offsetof(BodyMass<3>, inverse_inertia) == 11 * sizeof(double));
    constexpr std::size_t mass_stride = sizeof(BodyMass<3>) / sizeof(double), load_stride = 6;
    static_assert(sizeof(Load<3>) == load_stride * sizeof(double));
    const auto* states = reinterpret_cast<const double*>(from.states);
    const auto* masses = reinterpret_cast<const double*>(from.masses);
    const auto* loads = reinterpret_cast<const double*>(from.loads);
    PlainBody<3, F> body;
    Wide<F> unused;
    auto& i = body.inverse_inertia;
    gather_pairs(states + 7, bodies, PoseView<3>::stride, body.velocity.x, body.velocity.y);
    gather_pairs(states + 9, bodies, PoseView<3>::stride, body.velocity.z, body.spin.x);
    gather_pairs(states + 11, bodies, PoseView<3>::stride, body.spin.y, body.spin.z);
    gather_pairs(masses, bodies, mass_stride, unused, body.inverse_mass);
    gather_pairs(masses + 11, bodies, mass_stride, i.xx, i.yy);
    gather_pairs(masses + 13, bodies, mass_stride, i.zz, i.xy);
    gather_pairs(masses + 15, bodies, mass_stride, i.xz, i.yz);
    gather_pairs(loads, bodies, load_stride, body.force.x, body.force.y);
    gather_pairs(loads + 2, bodies, load_stride, body.force.z, body.torque.x);
    gather_pairs(loads + 4, bodies, load_stride, body.torque.y, body.torque.z);
    return body;
}

/// Rounded, and zero in the lanes that are not wanted.
template <class F, class Mask>
CAROM_INLINE F rounded(const Wide<F>& value, Mask wanted) {
    return select(wanted, F(value), F(0));
}
template <class F, class Mask>
CAROM_INLINE Vec<2, F> rounded(const Vec<2, Wide<F>>& v, Mask wanted) {
    return {rounded<F>(v.x, wanted), rounded<F>(v.y, wanted)};
}
template <class F, class Mask>
CAROM_INLINE Vec<3, F> rounded(const Vec<3, Wide<F>>& v, Mask wanted) {
    return {rounded<F>(v.x, wanted), rounded<F>(v.y, wanted), rounded<F>(v.z, wanted)};
}
template <class F, class Mask>
CAROM_INLINE Symmetric3<F> rounded(const Symmetric3<Wide<F>>& i, Mask wanted) {
    return {rounded<F>(i.xx, wanted), rounded<F>(i.yy, wanted), rounded<F>(i.zz, wanted),
            rounded<F>(i.xy, wanted), rounded<F>(i.xz, wanted), rounded<F>(i.yz, wanted)};
}

template <class F>
CAROM_INLINE Wide<F> widened(F value) {
    return Wide<F>(value);
}
template <class F>
CAROM_INLINE Vec<2, Wide<F>> widened(const Vec<2, F>& v) {
    return {Wide<F>(v.x), Wide<F>(v.y)};
}
template <class F>
CAROM_INLINE Vec<3, Wide<F>> widened(const Vec<3, F>& v) {
    return {Wide<F>(v.x), Wide<F>(v.y), Wide<F>(v.z)};
}

/// The record is given no velocity yet: first it collects what the kept impulses make (see `begin_warm`).
/// Lanes that are not wanted are left without mass and at rest.
template <int D, class F, class Mask>
CAROM_INLINE void take_up(const PlainBody<D, F>& from, Mask wanted, Body<D, F>& body, Drive<D, F>& drive) {
    drive = {};
    body = {};
    drive.start = rounded<F>(from.velocity, wanted);
    drive.start_spin = rounded<F>(from.spin, wanted);
    drive.lost = rounded<F>(Vec<D, Wide<F>>(from.velocity - widened(drive.start)), wanted);
    drive.lost_spin = rounded<F>(Angular<D, Wide<F>>(from.spin - widened(drive.start_spin)), wanted);
    drive.acceleration = rounded<F>(Vec<D, Wide<F>>(from.force * from.inverse_mass), wanted);
    // Nothing is added, so that a zero is the one that a sum has.
    drive.spin_acceleration =
        rounded<F>(Angular<D, Wide<F>>(from.inverse_inertia * from.torque + Angular<D, Wide<F>>{}), wanted);
    body.inverse_mass = rounded<F>(from.inverse_mass, wanted);
    body.weight.inertia = rounded<F>(from.inverse_inertia, wanted);
}

/// Turns by far less than what `exp_small` is for, and in the plane not past ±π, where whole turns are
/// counted.
template <class F>
CAROM_INLINE auto is_plain_turn(const F& turned, const Rotation<2, Wide<F>>& before,
                                const Rotation<2, Wide<F>>& after) {
    const F from(before.s), to(after.s);
    const auto same_side = either(both(from > F(0), to > F(0)), both(F(0) > from, F(0) > to));
    return both(F(0.75f) > fabs(turned), either(F(after.c) > F(0), same_side));
}
template <class F>
CAROM_INLINE auto is_plain_turn(const Vec<3, F>& turned, const Rotation<3, Wide<F>>&,
                                const Rotation<3, Wide<F>>&) {
    return F(2) > dot(turned, turned);
}

template <class W>
CAROM_INLINE void write_states(double* states, const std::uint32_t* bodies, auto wanted, const Vec<2, W>& p,
                               const Rotation<2, W>& q, const Vec<2, W>& v, const W& w) {
    const W all[7] = {p.x, p.y, q.c, q.s, v.x, v.y, w};
    scatter_some(states, bodies, PoseView<2>::stride, wanted, all);
}
template <class W>
CAROM_INLINE void write_states(double* states, const std::uint32_t* bodies, auto wanted, const Vec<3, W>& p,
                               const Rotation<3, W>& q, const Vec<3, W>& v, const Vec<3, W>& w) {
    const W all[13] = {p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z};
    scatter_some(states, bodies, PoseView<3>::stride, wanted, all);
}

/// Brings the states of plain bodies to the end of the step. Returns for which lanes that was done: of those
/// that are wanted, all that turned but a little.
template <int D, class F, class Mask>
CAROM_INLINE Mask put_down(const BodySource<D>& to, const std::uint32_t* bodies, const Motion<D, F>& m,
                           const Drive<D, F>& drive, Mask wanted) {
    using W = Wide<F>;
    auto* states = reinterpret_cast<double*>(to.states);
    const Pose<D, F> pose = gather_pose<F>(PoseView<D>{states}, bodies);
    const Rotation<D, W> after = normalized(exp_small(widened(m.turned)) * pose.rotation);
    const Mask done = both(wanted, is_plain_turn(m.turned, pose.rotation, after));
    write_states(states, bodies, done, Vec<D, W>(pose.position + widened(m.moved)), after,
                 Vec<D, W>(widened(m.v) + widened(drive.lost)),
                 Angular<D, W>(widened(m.w) + widened(drive.lost_spin)));
    return done;
}

}  // namespace carom::detail
