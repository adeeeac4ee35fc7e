#pragma once

#include "carom/inertia.hpp"
#include "carom/rotation.hpp"

/// Algebra of symmetric 3×3 matrices.
namespace carom::detail {

template <class T>
constexpr Symmetric3<T> diagonal(T xx, T yy, T zz) {
    return {xx, yy, zz, T(0), T(0), T(0)};
}

/// v vᵀ
template <class T>
constexpr Symmetric3<T> outer_square(const Vec<3, T>& v) {
    return {v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z};
}

template <class T>
constexpr T trace(const Symmetric3<T>& m) {
    return m.xx + m.yy + m.zz;
}

/// The matrix of cofactors: m times it is the determinant times 1.
template <class T>
constexpr Symmetric3<T> adjugate(const Symmetric3<T>& m) {
    return {m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xx * m.yy - m.xy * m.xy,
            m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy, m.xy * m.xz - m.xx * m.yz};
}

template <class T>
constexpr T determinant(const Symmetric3<T>& m) {
    const Symmetric3<T> a = adjugate(m);
    return m.xx * a.xx + m.xy * a.xy + m.xz * a.xz;
}

/// The inverse matrix; zero for a matrix whose determinant is zero, so that zero stands for infinite.
template <class T>
constexpr Symmetric3<T> inverse(const Symmetric3<T>& m) {
    const Symmetric3<T> a = adjugate(m);
    const T d = m.xx * a.xx + m.xy * a.xy + m.xz * a.xz;
    return d != T(0) ? a * (T(1) / d) : Symmetric3<T>{};
}

/// True when vᵀ m v > 0 for all v but zero (Sylvester: all leading minors are positive).
template <class T>
constexpr bool is_positive_definite(const Symmetric3<T>& m) {
    return m.xx > T(0) && m.xx * m.yy - m.xy * m.xy > T(0) && determinant(m) > T(0);
}

/// R m Rᵀ: the tensor, given in a frame, as seen from the frame in which that one is turned by `q`.
template <class T>
constexpr Symmetric3<T> rotated(const Symmetric3<T>& m, const Rotation<3, T>& q) {
    const T one(1), zero(0);
    const Vec<3, T> x = rotate(q, Vec<3, T>{one, zero, zero});
    const Vec<3, T> y = rotate(q, Vec<3, T>{zero, one, zero});
    const Vec<3, T> z = rotate(q, Vec<3, T>{zero, zero, one});
    // The columns of R m.
    const Vec<3, T> mx = m.xx * x + m.xy * y + m.xz * z;
    const Vec<3, T> my = m.xy * x + m.yy * y + m.yz * z;
    const Vec<3, T> mz = m.xz * x + m.yz * y + m.zz * z;
    return {mx.x * x.x + my.x * y.x + mz.x * z.x, mx.y * x.y + my.y * y.y + mz.y * z.y,
            mx.z * x.z + my.z * y.z + mz.z * z.z, mx.x * x.y + my.x * y.y + mz.x * z.y,
            mx.x * x.z + my.x * y.z + mz.x * z.z, mx.y * x.z + my.y * y.z + mz.y * z.z};
}

}  // namespace carom::detail
