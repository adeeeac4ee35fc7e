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

}  // namespace carom::detail
