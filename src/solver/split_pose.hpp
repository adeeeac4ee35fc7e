#pragma once

#include "dynamics/contact_cache.hpp"

namespace carom::detail {

/// A double as the sum of two floats.
struct Split {
    float first, rest;
    explicit Split(double value)
        : first(static_cast<float>(value)), rest(static_cast<float>(value - static_cast<double>(first))) {}
};

inline void split(const Rotation<2>& q, Rotation<2, float>& first, Rotation<2, float>& rest) {
    const Split c(q.c), s(q.s);
    first = {c.first, s.first};
    rest = {c.rest, s.rest};
}
inline void split(const Rotation<3>& q, Rotation<3, float>& first, Rotation<3, float>& rest) {
    const Split x(q.x), y(q.y), z(q.z), w(q.w);
    first = {x.first, y.first, z.first, w.first};
    rest = {x.rest, y.rest, z.rest, w.rest};
}

/// Where b lies relative to a, each number as the sum of two floats.
template <int D>
void set_pose(const RelativePose<D>& pose, Vec<D, float>& place, Vec<D, float>& place_rest,
              Rotation<D, float>& turn, Rotation<D, float>& turn_rest) {
    for (int i = 0; i < D; ++i) {
        const Split along(pose.position[i]);
        place[i] = along.first;
        place_rest[i] = along.rest;
    }
    split(pose.rotation, turn, turn_rest);
}

inline Rotation<2> sum(const Rotation<2, float>& first, const Rotation<2, float>& rest) {
    return {double{first.c} + rest.c, double{first.s} + rest.s};
}
inline Rotation<3> sum(const Rotation<3, float>& first, const Rotation<3, float>& rest) {
    return {double{first.x} + rest.x, double{first.y} + rest.y, double{first.z} + rest.z,
            double{first.w} + rest.w};
}

/// What `set_pose` was given, to 2⁻⁴⁸ of it.
template <int D>
RelativePose<D> pose_of(const Vec<D, float>& place, const Vec<D, float>& place_rest,
                        const Rotation<D, float>& turn, const Rotation<D, float>& turn_rest) {
    RelativePose<D> pose;
    pose.position = narrow<double>(place) + narrow<double>(place_rest);
    pose.rotation = sum(turn, turn_rest);
    return pose;
}

}  // namespace carom::detail
