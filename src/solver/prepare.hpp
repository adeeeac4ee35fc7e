#pragma once

#include "solver/contact_rows.hpp"
#include "solver/marks.hpp"

/// What the rows of a contact need beside what the narrow phase found: effective masses and the patch of
/// friction. For any lane type, like solver/rows.hpp.
namespace carom::detail {

template <class F>
CAROM_INLINE F inverse_or_zero(F k) {
    const auto some = k > F(0);
    return select(some, F(1) / select(some, k, F(1)), F(0));
}
template <class F>
CAROM_INLINE Symmetric3<F> inverse_or_zero(const Symmetric3<F>& k) {
    return adjugate(k) * inverse_or_zero(determinant(k));
}

/// Inverse of the effective masses of the patch, which is symmetric, between its two tangents. The inertias
/// are those in the frame.
template <class F>
CAROM_INLINE void weigh_patch(ContactRows<2, F>& c, const Vec<2, F>& mass, const F& inertia_a,
                              const F& inertia_b) {
    const Vec<2, F> t = tangents<2>(c.normal)[0];
    c.patch_mass[0] = inverse_or_zero(
        dot(t, each(mass, t)) + (c.arm_a.x * c.arm_a.x * inertia_a + c.arm_b.x * c.arm_b.x * inertia_b));
}
template <class F>
CAROM_INLINE void weigh_patch(ContactRows<3, F>& c, const Vec<3, F>& mass, const Symmetric3<F>& inertia_a,
                              const Symmetric3<F>& inertia_b) {
    const auto [t1, t2] = frame_of(c).tangents;
    const F zero(0), one(1);
    const Vec<3, F> a1 = torque_across(c.arm_a, one, zero), a2 = torque_across(c.arm_a, zero, one);
    const Vec<3, F> b1 = torque_across(c.arm_b, one, zero), b2 = torque_across(c.arm_b, zero, one);
    const Vec<3, F> turn_a1 = inertia_a * a1, turn_b1 = inertia_b * b1;
    const F k11 = dot(t1, each(mass, t1)) + dot(a1, turn_a1) + dot(b1, turn_b1);
    const F k12 = dot(t2, each(mass, t1)) + dot(a2, turn_a1) + dot(b2, turn_b1);
    const F k22 = dot(t2, each(mass, t2)) + dot(a2, inertia_a * a2) + dot(b2, inertia_b * b2);
    const F k = inverse_or_zero(k11 * k22 - k12 * k12);
    c.patch_mass = {k22 * k, -k12 * k, k11 * k};
    c.twist_mass = inverse_or_zero(inertia_a.xx + inertia_b.xx);
    for (NormalRow<3, F>& p : c.points)
        p.lever = select(p.mass > F(0), square_root(dot(p.place, p.place)), F(0));
}

/// On entry the mass of a point is positive where the point is used and zero where not.
template <int D, class F>
CAROM_INLINE void weigh_rows(ContactRows<D, F>& c, const Weight<D, F>& a, const Weight<D, F>& b,
                             Extras extras) {
    const ContactFrame<D, F> frame = frame_of(c);
    const Inertia<D, F> inertia_a = inertia_to_frame(frame, a.inertia),
                        inertia_b = inertia_to_frame(frame, b.inertia);
    weigh_patch(c, Vec<D, F>(a.mass + b.mass), inertia_a, inertia_b);
    const Response<D, F> response = response_of(c, a, b, inertia_a, inertia_b);
    if constexpr (D == 3) c.response = response;
    for (NormalRow<D, F>& p : c.points) {
        const Tilt<D, F> l = lever(p.place);
        const F softness = response.straight + tilt_dot(response.mixed, l) +
                           tilt_dot(l, Tilt<D, F>(response.mixed + response.turning * l));
        p.mass = select(p.mass > F(0), inverse_or_zero(softness), F(0));
    }
    const auto moves = [](const Weight<D, F>& w) {
        return maximum(w.mass[0], maximum(w.mass[1], w.mass[D - 1]));
    };
    c.firm = select(minimum(moves(a), moves(b)) > F(0), F(0), F(1));
    if (extras.rolling) {
        const Inertia<D, F> mass = inverse_or_zero(a.inertia + b.inertia);
        c.rolling_mass = mass * select(c.rolling > F(0), F(1), F(0));
    }
}

/// In a sub-step of length h a gap s changes by h v + ½ h² a, with v the speed at its end and a = −Δv/h (see
/// `finish`): with v alone, bodies in flight would seem to meet too early. The lead −½ h Δv is what the
/// steady change of the relative speed makes, and no more than what the outer forces alone would: none at
/// rest. `change` is Δv of b against a in the sub-step before, `acceleration` what outer forces make of it.
template <int D, class F>
CAROM_INLINE void look_ahead(ContactRows<D, F>& c, const Vec<D, F>& change, const Vec<D, F>& acceleration,
                             F h) {
    const F outer = F(-0.5f) * h * h * dot(c.normal, acceleration);
    const F steady = F(-0.5f) * h * dot(c.normal, change);
    c.lead = select(is_in_flight(c), maximum(F(0), minimum(outer, steady)), F(0));
}

/// Is any point used, and are all that are open?
template <int D, class F>
CAROM_INLINE auto is_in_flight(const ContactRows<D, F>& c) {
    constexpr float touching = 1e-5f;  // m: nearer things are not in flight
    constexpr float far = no_separation;
    F nearest = F(far);
    for (const NormalRow<D, F>& p : c.points)
        nearest = minimum(nearest, select(p.mass > F(0), p.separation, F(far)));
    return both(nearest > F(touching), F(far) > nearest);
}

template <int D, class F>
CAROM_INLINE auto some_used(const ContactRows<D, F>& c) {
    F most = F(0);
    for (const NormalRow<D, F>& p : c.points) most = maximum(most, p.mass);
    return most > F(0);
}

/// Does any point push?
template <int D, class F>
CAROM_INLINE auto pushes(const ContactRows<D, F>& c) {
    F most = F(0);
    for (const NormalRow<D, F>& p : c.points) most = maximum(most, p.impulse);
    return most > F(0);
}

/// Adds what the rows hold now to the sums over the sub-steps.
template <int D, class F>
CAROM_INLINE void tally(ContactRows<D, F>& c) {
    for (NormalRow<D, F>& p : c.points) p.total_impulse = p.total_impulse + p.impulse;
    for (int k = 0; k < D - 1; ++k) c.total_friction[k] = c.total_friction[k] + c.friction_impulse[k];
}

}  // namespace carom::detail
