#pragma once

#include "solver/rows.hpp"

/// How bodies move through the sub-steps between the passes over the contacts. For any lane type.
namespace carom::detail {

/// What drives a body through the sub-steps.
template <int D, class F>
struct Drive {
    Vec<D, F> acceleration{};  ///< by outer forces
    Angular<D, F> spin_acceleration{};
    Vec<D, F> warm{};  ///< velocity that the constraints gave in the sub-step before
    Angular<D, F> warm_spin{};
    Vec<D, F> change{};  ///< whole change of velocity in the sub-step before
    Angular<D, F> spin_change{};
    Vec<D, F> start{};  ///< velocity at the start of this sub-step
    Angular<D, F> start_spin{};
    Vec<D, F> lost{}, lost_before{};  ///< what rounding cut off the velocity, now and before this sub-step
    Angular<D, F> lost_spin{}, lost_spin_before{};
    F damping{}, spin_damping{};  ///< share of the velocity that damping takes in a sub-step
};

/// Adds a change that is small beside the velocity. What rounding cuts off is kept for the next time, so that
/// a steady force is not lost bit by bit (Kahan 1965).
template <class V>
CAROM_INLINE V add_precisely(const V& start, const V& change, V& lost) {
    const V whole = change + lost;
    const V sum = start + whole;
    lost = whole - (sum - start);
    return sum;
}

/// The velocity after damping, outer forces and the given change by constraints.
template <int D, class F>
CAROM_INLINE void push_velocity(Motion<D, F>& m, Drive<D, F>& d, const Vec<D, F>& by,
                                const Angular<D, F>& spin_by, F h) {
    m.v = add_precisely(Vec<D, F>(d.start - d.start * d.damping), Vec<D, F>(h * d.acceleration + by), d.lost);
    m.w = add_precisely(Angular<D, F>(d.start_spin - d.start_spin * d.spin_damping),
                        Angular<D, F>(h * d.spin_acceleration + spin_by), d.lost_spin);
}

/// Takes the change of velocity that all kept impulses make together as that of the sub-step before. The
/// impulses act as one change of velocity a body: within the step the Jacobians are constant, so what the
/// constraints did in a sub-step is the difference of velocities, and warm starting the next needs no pass
/// over the constraints.
template <int D, class F>
CAROM_INLINE void begin_warm(const Motion<D, F>& impulses, Drive<D, F>& d, F h) {
    d.warm = impulses.v;
    d.warm_spin = impulses.w;
    d.change = d.warm + h * d.acceleration;
    d.spin_change = d.warm_spin + h * d.spin_acceleration;
}

template <int D, class F>
CAROM_INLINE void integrate_velocity(Motion<D, F>& m, Drive<D, F>& d, F h) {
    d.start = m.v;
    d.start_spin = m.w;
    d.lost_before = d.lost;
    d.lost_spin_before = d.lost_spin;
    push_velocity(m, d, d.warm, d.warm_spin, h);
}

template <int D, class F>
CAROM_INLINE void integrate_position(Motion<D, F>& m, F h) {
    m.moved += h * m.v;
    m.turned = m.turned + h * m.w;
}

/// The share of a change of velocity Δ that is steady: what this sub-step has in common with the one before.
/// It is all of Δ where Δ has not doubled since, as in free fall, sliding, rolling and swinging, and nothing
/// in a blow or at rest. From Δ · Δ and Δ · Δ(before).
template <class F>
CAROM_INLINE F steady_share(F squared, F with_before) {
    const auto some = squared > F(0);
    const F share = select(some, with_before / select(some, squared, F(1)), F(0));
    return maximum(minimum(F(2) * share, F(1)), F(0));
}

/// x += h v(new) is first order. With the steady part Δ of the change of velocity, x += h v − ½ h Δ is the
/// trapezoidal rule: exact under constant acceleration, so flight, sliding and rolling near contacts are
/// second order, while a blow or a push against overlap still acts through the whole sub-step.
template <int D, class F>
CAROM_INLINE void finish(Motion<D, F>& m, Drive<D, F>& d, F h) {
    const Vec<D, F> change = (m.v - d.start) + (d.lost - d.lost_before);
    const Angular<D, F> spin_change = (m.w - d.start_spin) + (d.lost_spin - d.lost_spin_before);
    d.warm = change - (h * d.acceleration - d.damping * d.start);
    d.warm_spin = spin_change - (h * d.spin_acceleration - d.spin_damping * d.start_spin);
    const F half = F(0.5f) * h;
    m.moved -= (half * steady_share(dot(change, change), dot(change, d.change))) * change;
    m.turned = m.turned - (half * steady_share(angular_dot(spin_change, spin_change),
                                               angular_dot(spin_change, d.spin_change))) *
                              spin_change;
    d.change = change;
    d.spin_change = spin_change;
}

}  // namespace carom::detail
