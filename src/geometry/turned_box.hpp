#pragma once

#include <cmath>

#include "carom/rotation.hpp"
#include "carom/vec.hpp"

namespace carom::detail {

/// How far the rotated box reaches from its middle along the axes of the world.
inline Vec<2> reach_of(const Rotation<2>& q, const Vec<2>& half) {
    const double c = std::fabs(q.c), s = std::fabs(q.s);
    return {c * half.x + s * half.y, s * half.x + c * half.y};
}
inline Vec<3> reach_of(const Rotation<3>& q, const Vec<3>& half) {
    const double x = 2 * q.x, y = 2 * q.y, z = 2 * q.z;
    const double xx = x * q.x, yy = y * q.y, zz = z * q.z, xy = x * q.y, xz = x * q.z, yz = y * q.z,
                 wx = x * q.w, wy = y * q.w, wz = z * q.w;
    const auto sum = [&](double a, double b, double c) {
        return std::fabs(a) * half.x + std::fabs(b) * half.y + std::fabs(c) * half.z;
    };
    return {sum(1 - (yy + zz), xy - wz, xz + wy), sum(xy + wz, 1 - (xx + zz), yz - wx),
            sum(xz - wy, yz + wx, 1 - (xx + yy))};
}

}  // namespace carom::detail
