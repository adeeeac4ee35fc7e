#pragma once

#include "carom/rotation.hpp"
#include "carom/vec.hpp"

namespace carom {

/// A placement: first rotate, then move. Positions are `double`, so that a world may be large.
template <int D>
struct Transform {
    Vec<D> position{};
    Rotation<D> rotation{};

    friend constexpr bool operator==(const Transform&, const Transform&) = default;
};

using Transform2 = Transform<2>;
using Transform3 = Transform<3>;

/// The point `p` of the placed frame, in the outer frame.
template <int D>
constexpr Vec<D> apply(const Transform<D>& t, const Vec<D>& p) {
    return rotate(t.rotation, p) + t.position;
}

/// The point `p` of the outer frame, in the placed frame.
template <int D>
constexpr Vec<D> apply_inverse(const Transform<D>& t, const Vec<D>& p) {
    return unrotate(t.rotation, p - t.position);
}

/// The placement `b` inside the frame that `a` places.
template <int D>
constexpr Transform<D> operator*(const Transform<D>& a, const Transform<D>& b) {
    return {apply(a, b.position), a.rotation * b.rotation};
}

/// The placement of `b` as seen from the frame that `a` places. The difference of the positions is taken
/// first, so nothing is lost far from the origin.
template <int D>
constexpr Transform<D> relative(const Transform<D>& a, const Transform<D>& b) {
    return {unrotate(a.rotation, b.position - a.position), inverse(a.rotation) * b.rotation};
}

/// An axis-aligned box from corner `lower` to corner `upper`.
template <int D>
struct Aabb {
    Vec<D> lower{};
    Vec<D> upper{};
};

}  // namespace carom
