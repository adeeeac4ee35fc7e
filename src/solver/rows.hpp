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
    F total_impulse{};  ///< sum over the sub-steps
    F lever{};          ///< 3D: distance from the centre of friction, at which friction resists twisting
};

/// A contact between two bodies: a row a point along the normal, and one patch of friction in the middle.
template <int D, class F>
struct ContactRows {
    static constexpr int capacity = max_points<D>;

    Vec<D, F> normal{};
    std::array<NormalRow<D, F>, capacity> points{};
    Softness<F> soft{};
    F lead{};  ///< how much less a gap closes in a sub-step than h · speed, because the speed is still
               ///< growing

    std::array<Vec<D, F>, D - 1> tangents{};
    Vec<D, F> arm_a{}, arm_b{};  ///< of the patch
    std::array<F, D == 2 ? 1 : 3>
        patch_mass{};  ///< 2D: effective mass; 3D: inverse of the 2×2 system (xx, xy, yy)
    std::array<F, D - 1> friction_impulse{};
    std::array<F, D - 1> total_friction{};  ///< sum over the sub-steps
    F roundness_a{}, roundness_b{};
    Vec<D, F> surface_velocity{};  ///< of b's surface against a's, across the normal
    F friction{};
    F twist_mass{}, twist_impulse{};  ///< 3D
    Inertia<D, F> rolling_mass{};
    Angular<D, F> rolling_impulse{};
    F rolling{};
};

template <int D, class F>
Vec<D, F> each(const Vec<D, F>& a, const Vec<D, F>& b) {
    Vec<D, F> r;
    for (int i = 0; i < D; ++i) r[i] = a[i] * b[i];
    return r;
}

/// Inverse of the effective mass that an impulse along `n` meets at the two arms.
template <int D, class F>
F compliance(const Vec<D, F>& n, const Vec<D, F>& arm_a, const Vec<D, F>& arm_b, const Weight<D, F>& a,
             const Weight<D, F>& b) {
    const Angular<D, F> ra = cross(arm_a, n), rb = cross(arm_b, n);
    return dot(n, each(a.mass + b.mass, n)) + angular_dot(ra, a.inertia * ra) +
           angular_dot(rb, b.inertia * rb);
}

/// Velocity of b against a at the arms.
template <int D, class F>
Vec<D, F> relative_velocity(const Motion<D, F>& a, const Motion<D, F>& b, const Vec<D, F>& arm_a,
                            const Vec<D, F>& arm_b) {
    return (b.v + cross(b.w, arm_b)) - (a.v + cross(a.w, arm_a));
}

/// Impulse `p` on b at its arm, and −p on a.
template <int D, class F>
void push(Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa, const Weight<D, F>& wb,
          const Vec<D, F>& arm_a, const Vec<D, F>& arm_b, const Vec<D, F>& p) {
    a.v -= each(wa.mass, p);
    a.w = a.w - wa.inertia * cross(arm_a, p);
    b.v += each(wb.mass, p);
    b.w = b.w + wb.inertia * cross(arm_b, p);
}

/// Angular impulse `l` on b, and −l on a.
template <int D, class F>
void twist(Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa, const Weight<D, F>& wb,
           const Angular<D, F>& l) {
    a.w = a.w - wa.inertia * l;
    b.w = b.w + wb.inertia * l;
}

/// How far the end of an arm has come: the body's way, and the arm turned by θ to second order,
/// θ × r + ½ θ × (θ × r).
template <int D, class F>
Vec<D, F> way_of(const Motion<D, F>& m, const Vec<D, F>& arm) {
    const Vec<D, F> once = cross(m.turned, arm);
    return m.moved + once + F(0.5f) * cross(m.turned, once);
}

/// |θ|² of a rotation vector without its part about the normal.
template <class F>
F tilt_squared(const Vec<2, F>&, F turned) {
    return turned * turned;
}
template <class F>
F tilt_squared(const Vec<3, F>& normal, const Vec<3, F>& turned) {
    const F about = dot(normal, turned);
    return dot(turned, turned) - about * about;
}

/// What the second-order term of `way_of` opens too much where a shape is round: a ball that rolls presents
/// new points at the same height, so the term belongs to the arm that ends at the centre of the curvature, a
/// radius ρ further in: n · θ × (θ × ρn) = −ρ |θ|² (θ across n).
template <int D, class F>
F roundness(const ContactRows<D, F>& c, const Motion<D, F>& a, const Motion<D, F>& b) {
    return F(0.5f) * (c.roundness_a * tilt_squared(c.normal, a.turned) +
                      c.roundness_b * tilt_squared(c.normal, b.turned));
}

/// Gap at a point now. The normal is that of the step's start.
template <int D, class F>
F gap(const ContactRows<D, F>& c, const NormalRow<D, F>& p, const Motion<D, F>& a, const Motion<D, F>& b) {
    return p.separation + dot(c.normal, way_of(b, p.arm_b) - way_of(a, p.arm_a)) - roundness(c, a, b);
}

/// What all contacts of a sub-step share.
template <class F>
struct SubStep {
    F inverse_length{};  ///< 1 / s
    F push_speed{};      ///< the fastest that overlap is pushed apart, m/s
};

/// One pass over the normal rows. A gap is left to close by itself (the bias lets the bodies approach just so
/// far), an overlap is pushed apart softly if `biased`.
template <bool biased, int D, class F>
void solve_normals(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                   const Weight<D, F>& wb, const SubStep<F>& sub) {
    for (NormalRow<D, F>& p : c.points) {
        const F now = gap(c, p, a, b);
        // Before positions are integrated the lead lies ahead; after it, the way still lacks the lead.
        const F next_gap = now + c.lead;
        const auto apart = (biased ? now : next_gap) > F(0);
        F bias, scale, keep = F(0);
        if constexpr (biased) {
            const F push = maximum(c.soft.mass_scale * c.soft.bias_rate * now, -sub.push_speed);
            bias = select(apart, next_gap * sub.inverse_length, push);
            scale = select(apart, F(1), c.soft.mass_scale);
            keep = select(apart, F(0), c.soft.impulse_scale);
        } else {
            // A gap that is still open after this sub-step is the business of the next one.
            scale = select(apart, select(p.impulse > F(0), F(1), F(0)), F(1));
            bias = select(apart, scale * next_gap * sub.inverse_length, F(0));
        }
        const F speed = dot(c.normal, relative_velocity(a, b, p.arm_a, p.arm_b));
        const F next = maximum(p.impulse - p.mass * (scale * speed + bias) - keep * p.impulse, F(0));
        const F change = next - p.impulse;
        p.impulse = next;
        push(a, b, wa, wb, p.arm_a, p.arm_b, change * c.normal);
    }
}

/// Coulomb friction in the middle of the contact: |tangential impulse| ≤ μ · normal impulse. In 3D the two
/// tangential components are solved together and cut back to the circle, so friction is a cone.
template <class F>
void solve_patch(ContactRows<2, F>& c, Motion<2, F>& a, Motion<2, F>& b, const Weight<2, F>& wa,
                 const Weight<2, F>& wb, F normal_impulse) {
    const F speed = dot(c.tangents[0], relative_velocity(a, b, c.arm_a, c.arm_b) + c.surface_velocity);
    const F limit = c.friction * normal_impulse;
    const F old = c.friction_impulse[0];
    const F next = maximum(-limit, minimum(limit, old - c.patch_mass[0] * speed));
    c.friction_impulse[0] = next;
    push(a, b, wa, wb, c.arm_a, c.arm_b, (next - old) * c.tangents[0]);
}

template <class F>
void solve_patch(ContactRows<3, F>& c, Motion<3, F>& a, Motion<3, F>& b, const Weight<3, F>& wa,
                 const Weight<3, F>& wb, F normal_impulse) {
    const Vec<3, F> v = relative_velocity(a, b, c.arm_a, c.arm_b) + c.surface_velocity;
    const F v1 = dot(c.tangents[0], v), v2 = dot(c.tangents[1], v);
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
    push(a, b, wa, wb, c.arm_a, c.arm_b, (next1 - old1) * c.tangents[0] + (next2 - old2) * c.tangents[1]);

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
void solve_rolling(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                   const Weight<D, F>& wb, F normal_impulse) {
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
void solve_friction(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                    const Weight<D, F>& wb) {
    F normal_impulse = F(0);
    for (const NormalRow<D, F>& p : c.points) normal_impulse = normal_impulse + p.impulse;
    solve_rolling(c, a, b, wa, wb, normal_impulse);
    solve_patch(c, a, b, wa, wb, normal_impulse);
}

/// Applies the impulses that the rows hold.
template <int D, class F>
void warm_start(const ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                const Weight<D, F>& wb) {
    for (const NormalRow<D, F>& p : c.points) push(a, b, wa, wb, p.arm_a, p.arm_b, p.impulse * c.normal);
    Vec<D, F> friction{};
    for (int i = 0; i < D - 1; ++i) friction += c.friction_impulse[i] * c.tangents[i];
    push(a, b, wa, wb, c.arm_a, c.arm_b, friction);
    twist(a, b, wa, wb, c.rolling_impulse);
    if constexpr (D == 3) twist(a, b, wa, wb, c.twist_impulse * c.normal);
}

}  // namespace carom::detail
