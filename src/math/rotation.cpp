#include "carom/rotation.hpp"

#include <algorithm>

#include "math/check.hpp"
#include "math/trig.hpp"

namespace carom {

template <>
Rotation2 Rotation2::from_angle(double angle) {
    detail::require_finite(angle, "angle");
    const auto [sine, cosine] = detail::sin_cos(angle);
    return {cosine, sine};
}

template <>
double Rotation2::angle() const {
    return detail::atan2(s, c);
}

template <>
Rotation3 Rotation3::from_axis_angle(const Vec3& axis, double angle) {
    detail::require_finite(axis, "axis");
    detail::require_finite(angle, "angle");
    // Scaled first, so that the squares neither over- nor underflow.
    const double largest = std::max({std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)});
    if (!(largest > 0)) throw Error("axis: all components are zero");
    const auto [sine, cosine] = detail::sin_cos(angle / 2);
    const Vec3 u = sine * normalized(axis / largest);
    return {u.x, u.y, u.z, cosine};
}

}  // namespace carom
