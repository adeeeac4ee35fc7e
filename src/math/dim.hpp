#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "carom/inertia.hpp"
#include "carom/rotation.hpp"
#include "carom/transform.hpp"
#include "carom/vec.hpp"
#include "math/symmetric.hpp"
#include "math/trig.hpp"

/// The seam of the dimensions: what code that is written once for both uses, next to `Vec`, `Angular`,
/// `Rotation` and `Inertia`, which value-initialise to zero (the rotation to none), and `cross`:
/// cross(r, F) is a torque and cross(w, r) a velocity in both.
namespace carom::detail {

/// The most points that a contact manifold has.
template <int D>
constexpr int max_points = D == 2 ? 2 : 4;

/// a · b of angular velocities, torques or angular momenta.
template <class T>
constexpr T angular_dot(const T& a, const T& b) {
    return a * b;
}
template <class T>
constexpr T angular_dot(const Vec<3, T>& a, const Vec<3, T>& b) {
    return dot(a, b);
}

/// a × b of the same; zero in the plane, where all are parallel.
template <std::floating_point T>
constexpr T angular_cross(T, T) {
    return T(0);
}
template <class T>
constexpr Vec<3, T> angular_cross(const Vec<3, T>& a, const Vec<3, T>& b) {
    return cross(a, b);
}

/// An angular quantity of a frame, as seen from the frame in which that one is turned by `q`.
template <class T>
constexpr T rotate_angular(const Rotation<2, T>&, const T& w) {
    return w;
}
template <class T>
constexpr Vec<3, T> rotate_angular(const Rotation<3, T>& q, const Vec<3, T>& w) {
    return rotate(q, w);
}

/// The inverse of a moment of inertia; zero for zero, so that zero stands for infinite.
template <std::floating_point T>
constexpr T inverse(T inertia) {
    return inertia != T(0) ? T(1) / inertia : T(0);
}

/// A moment of inertia of a frame, as seen from the frame in which that one is turned by `q`.
template <std::floating_point T>
constexpr T rotated(T inertia, const Rotation<2, T>&) {
    return inertia;
}

/// The inertia about a point `offset` away from the centre of mass, less that about the centre (Steiner).
template <class T>
constexpr T steiner(T mass, const Vec<2, T>& offset) {
    return mass * dot(offset, offset);
}
template <class T>
constexpr Symmetric3<T> steiner(T mass, const Vec<3, T>& offset) {
    const T square = dot(offset, offset);
    return (diagonal(square, square, square) - outer_square(offset)) * mass;
}

/// The rotation by the angle v, |v| ≤ π/4, or by |v| ≤ π/2 about v. For doubles and lanes of them.
template <class T>
constexpr Rotation<2, T> exp_small(const T& v) {
    const auto [sine, cosine] = sin_cos_near_zero(v);
    return {cosine, sine};
}
/// q = (v/|v| sin |v|/2, cos |v|/2): the series in |v|²/4 need no root and no division.
template <class T>
constexpr Rotation<3, T> exp_small(const Vec<3, T>& v) {
    const T z = T(0.25) * dot(v, v);
    const Vec<3, T> u = (T(0.5) + T(0.5) * z * sin_series(z)) * v;
    return {u.x, u.y, u.z, T(1) - T(0.5) * z + z * z * cos_series(z)};
}

/// The rotation by |v| about v; in the plane, by the angle v.
template <int D>
Rotation<D> exp_rotation(const Angular<D>& v) {
    if constexpr (D == 2) {
        const auto [sine, cosine] = sin_cos(v);
        return {cosine, sine};
    } else {
        const double z = 0.25 * dot(v, v);
        if (z <= pi * pi / 16) return exp_small(v);
        const double half = std::sqrt(z);
        const auto [sine, cosine] = sin_cos(half);
        const Vec3 u = (0.5 * sine / half) * v;
        return {u.x, u.y, u.z, cosine};
    }
}

/// How far a point at distance 1 from the axis is moved by the rotation that leads from one to the other: the
/// chord 2 sin θ/2. In space the vector part of p⁻¹q has the length sin θ/2, in the plane |q − p| is the
/// chord.
inline double chord_between(const Rotation<2>& from, const Rotation<2>& to) {
    return length(Vec<2>{to.c - from.c, to.s - from.s});
}
inline double chord_between(const Rotation<3>& from, const Rotation<3>& to) {
    const Rotation<3> turn = inverse(from) * to;
    return 2 * length(Vec<3>{turn.x, turn.y, turn.z});
}

/// One or the other; lane types overload this with a mask for the condition.
template <std::floating_point T>
constexpr T select(bool condition, T yes, T no) {
    return condition ? yes : no;
}

/// Unit vectors that complete the unit normal to a right-handed frame. Around the coordinate axes, where
/// most normals of games lie, they turn with the normal without a jump, so that the friction impulses of the
/// last step, which are kept along them, stay what they were.
template <int D, class T>
std::array<Vec<D, T>, D - 1> tangents(const Vec<D, T>& normal) {
    if constexpr (D == 2) {
        return {Vec<2, T>{-normal.y, normal.x}};
    } else {
        using std::fabs;
        using std::sqrt;
        // normal × x axis, or normal × z axis when the normal is near the x axis: never shorter than 1/√3.
        const auto mostly_x = fabs(normal.x) > T(0.57735027);
        const T zero(0);
        const Vec<3, T> across{select(mostly_x, normal.y, zero), select(mostly_x, -normal.x, normal.z),
                               select(mostly_x, zero, -normal.y)};
        const Vec<3, T> first = across * (T(1) / sqrt(dot(across, across)));
        return {first, cross(normal, first)};
    }
}

/// The same in another arithmetic type, usually float.
template <class T, int D, class From>
constexpr Vec<D, T> narrow(const Vec<D, From>& v) {
    if constexpr (D == 2) {
        return {static_cast<T>(v.x), static_cast<T>(v.y)};
    } else {
        return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
    }
}
template <class T, class From>
constexpr Rotation<2, T> narrow(const Rotation<2, From>& q) {
    return {static_cast<T>(q.c), static_cast<T>(q.s)};
}
template <class T, class From>
constexpr Rotation<3, T> narrow(const Rotation<3, From>& q) {
    return {static_cast<T>(q.x), static_cast<T>(q.y), static_cast<T>(q.z), static_cast<T>(q.w)};
}
template <class T, class From>
constexpr Symmetric3<T> narrow(const Symmetric3<From>& m) {
    return {static_cast<T>(m.xx), static_cast<T>(m.yy), static_cast<T>(m.zz),
            static_cast<T>(m.xy), static_cast<T>(m.xz), static_cast<T>(m.yz)};
}
template <class T, std::floating_point From>
constexpr T narrow(From value) {
    return static_cast<T>(value);
}

}  // namespace carom::detail
