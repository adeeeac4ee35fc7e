#pragma once

#include "carom/vec.hpp"

namespace carom {

/// A rotation: a unit complex number in the plane, a unit quaternion in space. Rotating with it costs no
/// trigonometry. Make one from an angle with `from_angle`, `from_axis_angle`.
template <int D, class T = double>
struct Rotation;

/// Rotation by the angle whose cosine is `c` and sine is `s`, counter-clockwise.
template <class T>
struct Rotation<2, T> {
    T c{1}, s{0};

    /// The rotation by `angle` radians, counter-clockwise.
    static Rotation from_angle(T angle);

    /// The angle in (−π, π].
    T angle() const;

    friend constexpr bool operator==(const Rotation&, const Rotation&) = default;
};

/// Unit quaternion w + xi + yj + zk.
template <class T>
struct Rotation<3, T> {
    T x{0}, y{0}, z{0}, w{1};

    /// The rotation by `angle` radians about `axis` (any length but zero), right-handed.
    static Rotation from_axis_angle(const Vec<3, T>& axis, T angle);

    friend constexpr bool operator==(const Rotation&, const Rotation&) = default;
};

template <>
Rotation<2, double> Rotation<2, double>::from_angle(double angle);
template <>
double Rotation<2, double>::angle() const;
template <>
Rotation<3, double> Rotation<3, double>::from_axis_angle(const Vec<3, double>& axis, double angle);

using Rotation2 = Rotation<2>;
using Rotation3 = Rotation<3>;

/// The inverse rotation.
template <class T>
constexpr Rotation<2, T> inverse(const Rotation<2, T>& q) {
    return {q.c, -q.s};
}
template <class T>
constexpr Rotation<3, T> inverse(const Rotation<3, T>& q) {
    return {-q.x, -q.y, -q.z, q.w};
}

/// The rotation `b` followed by `a`.
template <class T>
constexpr Rotation<2, T> operator*(const Rotation<2, T>& a, const Rotation<2, T>& b) {
    return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s};
}
template <class T>
constexpr Rotation<3, T> operator*(const Rotation<3, T>& a, const Rotation<3, T>& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

/// The vector `v`, rotated.
template <class T>
constexpr Vec<2, T> rotate(const Rotation<2, T>& q, const Vec<2, T>& v) {
    return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y};
}
template <class T>
constexpr Vec<3, T> rotate(const Rotation<3, T>& q, const Vec<3, T>& v) {
    const Vec<3, T> u{q.x, q.y, q.z};
    const Vec<3, T> t = T(2) * cross(u, v);
    return v + q.w * t + cross(u, t);
}

/// The vector `v`, rotated by the inverse of `q`.
template <int D, class T>
constexpr Vec<D, T> unrotate(const Rotation<D, T>& q, const Vec<D, T>& v) {
    return rotate(inverse(q), v);
}

/// The rotation scaled back to unit length, against the drift of rounding.
template <class T>
Rotation<2, T> normalized(const Rotation<2, T>& q) {
    using std::sqrt;
    const T k = T(1) / sqrt(q.c * q.c + q.s * q.s);
    return {q.c * k, q.s * k};
}
template <class T>
Rotation<3, T> normalized(const Rotation<3, T>& q) {
    using std::sqrt;
    const T k = T(1) / sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {q.x * k, q.y * k, q.z * k, q.w * k};
}

}  // namespace carom
