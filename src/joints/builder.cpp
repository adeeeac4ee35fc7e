#include "joints/builder.hpp"

namespace carom::detail {

Rotation3 frame_along(const Vec3& axis) {
    const Vec3 x = normalized(axis);
    // The turn from the world's x axis by the shortest way: with the half-way vector as its half angle.
    if (x.x < -0.999999) return {0, 0, 1, 0};
    return normalized(Rotation3{0, -x.z, x.y, 1 + x.x});
}

Rotation3 frame_along(const Vec3& axis, const Vec3& second) {
    const Rotation3 first = frame_along(axis);
    // Then about the axis itself.
    const Vec3 y = unrotate(first, second);
    const double half = 0.5 * normalized(Rotation2{y.y, y.z}).angle();
    const Rotation2 turn = Rotation2::from_angle(half);
    return normalized(first * Rotation3{turn.s, 0, 0, turn.c});
}

}  // namespace carom::detail
