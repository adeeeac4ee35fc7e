#pragma once

#include <type_traits>

#include "carom/vec.hpp"

namespace carom {

/// A symmetric 3×3 matrix by its six different entries.
template <class T>
struct Symmetric3 {
    T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

    friend constexpr Symmetric3 operator+(const Symmetric3& a, const Symmetric3& b) {
        return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
    }
    friend constexpr Symmetric3 operator-(const Symmetric3& a, const Symmetric3& b) {
        return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
    }
    friend constexpr Symmetric3 operator*(const Symmetric3& a, T s) {
        return {a.xx * s, a.yy * s, a.zz * s, a.xy * s, a.xz * s, a.yz * s};
    }
    friend constexpr Vec<3, T> operator*(const Symmetric3& m, const Vec<3, T>& v) {
        return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
                m.xz * v.x + m.yz * v.y + m.zz * v.z};
    }
    friend constexpr bool operator==(const Symmetric3&, const Symmetric3&) = default;
};

/// Angular velocity, torque, angular momentum: a scalar in the plane, a vector in space.
template <int D, class T = double>
using Angular = std::conditional_t<D == 2, T, Vec<3, T>>;

/// Moment of inertia about the centre of mass: a scalar in the plane, a tensor in space.
template <int D, class T = double>
using Inertia = std::conditional_t<D == 2, T, Symmetric3<T>>;

}  // namespace carom
