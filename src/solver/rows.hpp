#pragma once

#include <array>

#include "math/dim.hpp"
#include "simd/scalar.hpp"

/// The arithmetic of a contact, written once for both dimensions and for any lane type `F`: `float`, or
/// several floats side by side. Nothing here branches on a value; lanes are chosen by `select`.
///
/// The scheme is the soft step (E. Catto, "Solver2D", 2024): each sub-step integrates velocities, solves
/// every row once with a soft bias, integrates positions and relaxes, solving again without bias.
namespace carom::detail {

/// How a body moves inside the step: velocities, and how far it has come since the step began.
template <int D, class F>
struct Motion {
    Vec<D, F> v{};
    Angular<D, F> w{};
    Vec<D, F> moved{};
    Angular<D, F> turned{};  ///< rotation vector
};

/// Inverse mass, per axis because axes may be locked, and inverse inertia in the world's axes.
template <int D, class F>
struct Weight {
    Vec<D, F> mass{};
    Inertia<D, F> inertia{};
};

/// Constraint softness: a spring and damper that stay stable at any frequency. With ω = 2π · hertz and the
/// implicit Euler step h, a₁ = 2ζ + hω, a₂ = hω a₁, a₃ = 1 / (1 + a₂): bias rate ω / a₁, mass scale a₂ a₃ and
/// impulse scale a₃ (E. Catto, "Soft Constraints", 2011).
template <class F>
struct Softness {
    F bias_rate{}, mass_scale{}, impulse_scale{};
};

template <int D, class F>
struct NormalRow {
    Vec<D, F> arm_a{}, arm_b{};
    F separation{};  ///< at the start of the step
    F mass{};        ///< effective mass; zero for a row that is not used
    F impulse{};
    F lever{};          ///< 3D: distance from the centre of friction, at which friction resists twisting
    F total_impulse{};  ///< sum over the sub-steps
};

/// A contact between two bodies: a row a point along the normal, and one patch of friction in the middle.
/// All members are lanes, so that a contact is one lane of an array of them.
template <int D, class F>
struct ContactRows {
    static constexpr int capacity = max_points<D>;

    Vec<D, F> normal{};
    std::array<NormalRow<D, F>, capacity> points{};
    F firm{};  ///< 1 where one of the bodies cannot be moved, so that overlap is pushed apart faster; else 0
    F lead{};  ///< how much less a gap closes in a sub-step than h · speed, because the speed is still
               ///< growing

    Vec<D, F> tangent{};         ///< the first; in 3D the second is normal × tangent
    Vec<D, F> arm_a{}, arm_b{};  ///< of the patch
    std::array<F, D == 2 ? 1 : 3>
        patch_mass{};  ///< 2D: effective mass; 3D: inverse of the 2×2 system (xx, xy, yy)
    std::array<F, D - 1> friction_impulse{};
    std::array<F, D - 1>
        surface_speed{};  ///< along the tangents, of b's surface against a's beside the bodies' motion
    F friction{};
    F twist_mass{}, twist_impulse{};        ///< 3D
    std::array<F, D - 1> total_friction{};  ///< sum over the sub-steps

    // Last, what only some contacts have (see `Extras`).
    F roundness_a{}, roundness_b{};
    F rolling{};
    Angular<D, F> rolling_impulse{};
    Inertia<D, F> rolling_mass{};
};

/// Terms that only some contacts have; a pass over contacts without them leaves them out.
struct Extras {
    bool roundness = false, rolling = false;
};

template <class F>
CAROM_INLINE std::array<Vec<2, F>, 1> tangents_of(const ContactRows<2, F>& c) {
    return {c.tangent};
}
template <class F>
CAROM_INLINE std::array<Vec<3, F>, 2> tangents_of(const ContactRows<3, F>& c) {
    return {c.tangent, cross(c.normal, c.tangent)};
}

template <int D, class F>
CAROM_INLINE Vec<D, F> each(const Vec<D, F>& a, const Vec<D, F>& b) {
    Vec<D, F> r;
    for (int i = 0; i < D; ++i) r[i] = a[i] * b[i];
    return r;
}

/// Inverse of the effective mass that an impulse along `n` meets at the two arms.
template <int D, class F>
CAROM_INLINE F compliance(const Vec<D, F>& n, const Vec<D, F>& arm_a, const Vec<D, F>& arm_b,
                          const Weight<D, F>& a, const Weight<D, F>& b) {
    const Angular<D, F> ra = cross(arm_a, n), rb = cross(arm_b, n);
    return dot(n, each(a.mass + b.mass, n)) + angular_dot(ra, a.inertia * ra) +
           angular_dot(rb, b.inertia * rb);
}

/// Velocity of b against a at the arms.
template <int D, class F>
CAROM_INLINE Vec<D, F> relative_velocity(const Motion<D, F>& a, const Motion<D, F>& b, const Vec<D, F>& arm_a,
                                         const Vec<D, F>& arm_b) {
    return (b.v + cross(b.w, arm_b)) - (a.v + cross(a.w, arm_a));
}

/// Impulse `p` on b at its arm, and −p on a.
template <int D, class F>
CAROM_INLINE void push(Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa, const Weight<D, F>& wb,
                       const Vec<D, F>& arm_a, const Vec<D, F>& arm_b, const Vec<D, F>& p) {
    a.v -= each(wa.mass, p);
    a.w = a.w - wa.inertia * cross(arm_a, p);
    b.v += each(wb.mass, p);
    b.w = b.w + wb.inertia * cross(arm_b, p);
}

/// Angular impulse `l` on b, and −l on a.
template <int D, class F>
CAROM_INLINE void twist(Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa, const Weight<D, F>& wb,
                        const Angular<D, F>& l) {
    a.w = a.w - wa.inertia * l;
    b.w = b.w + wb.inertia * l;
}

/// A rotation vector θ as the contacts of a body need it.
template <int D, class F>
struct Turn {
    Angular<D, F> angle{};
    F about{};    ///< its part along the normal
    F squared{};  ///< |θ|²

    Turn(const Vec<D, F>& normal, const Angular<D, F>& turned)
        : angle(turned), squared(angular_dot(turned, turned)) {
        if constexpr (D == 3) about = dot(normal, turned);
    }
    /// |θ|² without its part about the normal.
    F tilt_squared() const { return squared - about * about; }
};

/// How far the end of an arm has come along the normal n as the arm r turned by θ, to second order:
/// n · (θ × r + ½ θ × (θ × r)) = θ · (r × n) + ½ ((θ · n)(θ · r) − θ² (n · r)). `lever` is r × n.
template <int D, class F>
CAROM_INLINE F rise(const Turn<D, F>& turn, const Vec<D, F>& normal, const Vec<D, F>& arm,
                    const Angular<D, F>& lever) {
    F second = turn.squared * dot(normal, arm);
    if constexpr (D == 3) second = second - turn.about * dot(turn.angle, arm);
    return angular_dot(turn.angle, lever) - F(0.5f) * second;
}

/// What the second-order term of `rise` opens too much where a shape is round: a ball that rolls presents
/// new points at the same height, so the term belongs to the arm that ends at the centre of the curvature, a
/// radius ρ further in: n · θ × (θ × ρn) = −ρ |θ|² (θ across n).
template <int D, class F>
CAROM_INLINE F roundness(const ContactRows<D, F>& c, const Turn<D, F>& a, const Turn<D, F>& b) {
    return F(0.5f) * (c.roundness_a * a.tilt_squared() + c.roundness_b * b.tilt_squared());
}

/// Gap at a point now. The normal is that of the step's start.
template <int D, class F>
CAROM_INLINE F gap(const ContactRows<D, F>& c, const NormalRow<D, F>& p, const Motion<D, F>& a,
                   const Motion<D, F>& b) {
    const Turn<D, F> ta(c.normal, a.turned), tb(c.normal, b.turned);
    return p.separation + (dot(c.normal, b.moved - a.moved) - roundness(c, ta, tb)) +
           (rise(tb, c.normal, p.arm_b, cross(p.arm_b, c.normal)) -
            rise(ta, c.normal, p.arm_a, cross(p.arm_a, c.normal)));
}

/// A gap that counts as closed, m.
constexpr float closed_gap = 1e-5f;

/// What all contacts of a sub-step share.
template <class F>
struct SubStep {
    F inverse_length{};  ///< 1 / s
    F push_speed{};      ///< the fastest that overlap is pushed apart, m/s
    Softness<F> soft{}, firm{};
};

/// One pass over the normal rows. A gap is left to close by itself (the bias lets the bodies approach just so
/// far), an overlap is pushed apart softly if `biased`.
template <bool biased, int D, class F>
CAROM_INLINE void solve_normals(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                const Weight<D, F>& wa, const Weight<D, F>& wb, const SubStep<F>& sub,
                                Extras extras = {true, true}) {
    const Vec<D, F> n = c.normal;
    const Turn<D, F> ta(n, a.turned), tb(n, b.turned);
    F parted = dot(n, b.moved - a.moved);
    if (extras.roundness) parted = parted - roundness(c, ta, tb);
    const Vec<D, F> push_a = each(wa.mass, n), push_b = each(wb.mass, n);
    const auto firm = c.firm > F(0);
    const F push_rate =
        select(firm, sub.firm.mass_scale * sub.firm.bias_rate, sub.soft.mass_scale * sub.soft.bias_rate);
    const F mass_scale = select(firm, sub.firm.mass_scale, sub.soft.mass_scale);
    const F impulse_scale = select(firm, sub.firm.impulse_scale, sub.soft.impulse_scale);
    for (NormalRow<D, F>& p : c.points) {
        const Angular<D, F> lever_a = cross(p.arm_a, n), lever_b = cross(p.arm_b, n);
        const F now = p.separation + parted + (rise(tb, n, p.arm_b, lever_b) - rise(ta, n, p.arm_a, lever_a));
        // Before positions are integrated the lead lies ahead; after it, the way still lacks the lead.
        const F next_gap = now + c.lead;
        const auto apart = (biased ? now : next_gap) > F(0);
        const F old = p.impulse;
        F bias, scale, keep = F(0);
        if constexpr (biased) {
            bias = select(apart, next_gap * sub.inverse_length, maximum(push_rate * now, -sub.push_speed));
            scale = select(apart, F(1), mass_scale);
            keep = select(apart, F(0), impulse_scale);
        } else {
            // A gap that is still open after this sub-step is the business of the next one, unless it is as
            // small as rounding leaves it: of a face that lands flat, all corners are to stop together.
            scale = select(next_gap > F(closed_gap), select(old > F(0), F(1), F(0)), F(1));
            bias = select(apart, scale * next_gap * sub.inverse_length, F(0));
        }
        const F speed = dot(n, b.v - a.v) + (angular_dot(b.w, lever_b) - angular_dot(a.w, lever_a));
        F next = old - p.mass * (scale * speed + bias);
        if constexpr (biased) next = next - keep * old;
        next = maximum(next, F(0));
        const F change = next - old;
        p.impulse = next;
        a.v -= change * push_a;
        a.w = a.w - (wa.inertia * lever_a) * change;
        b.v += change * push_b;
        b.w = b.w + (wb.inertia * lever_b) * change;
    }
}

/// Coulomb friction in the middle of the contact: |tangential impulse| ≤ μ · normal impulse. It works towards
/// the speed at which the surfaces move along with one another. In 3D the two
/// tangential components are solved together and cut back to the circle, so friction is a cone.
template <class F>
CAROM_INLINE void solve_patch(ContactRows<2, F>& c, Motion<2, F>& a, Motion<2, F>& b, const Weight<2, F>& wa,
                              const Weight<2, F>& wb, F normal_impulse) {
    const F speed = dot(c.tangent, relative_velocity(a, b, c.arm_a, c.arm_b)) + c.surface_speed[0];
    const F limit = c.friction * normal_impulse;
    const F old = c.friction_impulse[0];
    const F next = maximum(-limit, minimum(limit, old - c.patch_mass[0] * speed));
    c.friction_impulse[0] = next;
    push(a, b, wa, wb, c.arm_a, c.arm_b, (next - old) * c.tangent);
}

template <class F>
CAROM_INLINE void solve_patch(ContactRows<3, F>& c, Motion<3, F>& a, Motion<3, F>& b, const Weight<3, F>& wa,
                              const Weight<3, F>& wb, F normal_impulse) {
    const auto [t1, t2] = tangents_of(c);
    const Vec<3, F> v = relative_velocity(a, b, c.arm_a, c.arm_b);
    const F v1 = dot(t1, v) + c.surface_speed[0], v2 = dot(t2, v) + c.surface_speed[1];
    const F old1 = c.friction_impulse[0], old2 = c.friction_impulse[1];
    F next1 = old1 - (c.patch_mass[0] * v1 + c.patch_mass[1] * v2);
    F next2 = old2 - (c.patch_mass[1] * v1 + c.patch_mass[2] * v2);
    const F limit = c.friction * normal_impulse;
    const F squared = next1 * next1 + next2 * next2;
    const auto slips = squared > limit * limit;
    const F cut = select(slips, limit / square_root(select(slips, squared, F(1))), F(1));
    next1 = next1 * cut;
    next2 = next2 * cut;
    c.friction_impulse = {next1, next2};
    push(a, b, wa, wb, c.arm_a, c.arm_b, (next1 - old1) * t1 + (next2 - old2) * t2);

    // Friction against twisting about the normal: each point resists at its lever.
    F limit_twist = F(0);
    for (const NormalRow<3, F>& p : c.points) limit_twist = limit_twist + p.lever * p.impulse;
    limit_twist = c.friction * limit_twist;
    const F spin = dot(c.normal, b.w - a.w);
    const F old = c.twist_impulse;
    c.twist_impulse = maximum(-limit_twist, minimum(limit_twist, old - c.twist_mass * spin));
    twist(a, b, wa, wb, (c.twist_impulse - old) * c.normal);
}

/// Rolling resistance: the angular impulse that stops the relative spin, at most rolling · normal impulse.
template <int D, class F>
CAROM_INLINE void solve_rolling(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                const Weight<D, F>& wa, const Weight<D, F>& wb, F normal_impulse) {
    const Angular<D, F> old = c.rolling_impulse;
    Angular<D, F> next = old - c.rolling_mass * (b.w - a.w);
    const F limit = c.rolling * normal_impulse;
    const F squared = angular_dot(next, next);
    const auto over = squared > limit * limit;
    next = next * select(over, limit / square_root(select(over, squared, F(1))), F(1));
    c.rolling_impulse = next;
    twist(a, b, wa, wb, Angular<D, F>(next - old));
}

/// Friction and rolling resistance, after the normal rows.
template <int D, class F>
CAROM_INLINE void solve_friction(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                 const Weight<D, F>& wa, const Weight<D, F>& wb,
                                 Extras extras = {true, true}) {
    F normal_impulse = F(0);
    for (const NormalRow<D, F>& p : c.points) normal_impulse = normal_impulse + p.impulse;
    if (extras.rolling) solve_rolling(c, a, b, wa, wb, normal_impulse);
    solve_patch(c, a, b, wa, wb, normal_impulse);
}

/// The vector with these components along the tangents.
template <int D, class F>
CAROM_INLINE Vec<D, F> along_tangents(const ContactRows<D, F>& c, const std::array<F, D - 1>& components) {
    const auto t = tangents_of(c);
    Vec<D, F> sum = components[0] * t[0];
    if constexpr (D == 3) sum += components[1] * t[1];
    return sum;
}

/// Applies the impulses that the rows hold.
template <int D, class F>
CAROM_INLINE void warm_start(const ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                             const Weight<D, F>& wa, const Weight<D, F>& wb, Extras extras = {true, true}) {
    for (const NormalRow<D, F>& p : c.points) push(a, b, wa, wb, p.arm_a, p.arm_b, p.impulse * c.normal);
    push(a, b, wa, wb, c.arm_a, c.arm_b, along_tangents(c, c.friction_impulse));
    if (extras.rolling) twist(a, b, wa, wb, c.rolling_impulse);
    if constexpr (D == 3) twist(a, b, wa, wb, c.twist_impulse * c.normal);
}

}  // namespace carom::detail
