#pragma once

#include <array>

#include "math/dim.hpp"
#include "simd/scalar.hpp"

/// What the rows of contacts and joints share: bodies as they see them, and impulses on these. Written once
/// for both dimensions and for any lane type `F`: `float`, or several floats side by side. Nothing here
/// branches on a value; lanes are chosen by `select`.
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

/// What all contacts of a sub-step share.
template <class F>
struct SubStep {
    F inverse_length{};  ///< 1 / s
    F push_speed{};      ///< the fastest that overlap is pushed apart, m/s
    Softness<F> soft{}, firm{};
};

}  // namespace carom::detail
