#pragma once

#include <cstddef>

#include "solver/passes.hpp"

/// From contact records to lanes: records are read by fours of floats, which are transposed.
namespace carom::detail {

/// Reads the floats of each lane's record from a member on: as many as the pattern of four has.
template <int D>
struct RecordReader {
    static constexpr std::size_t stride = sizeof(ContactRecord<D>) / sizeof(float);
    static_assert(sizeof(ContactRecord<D>) % sizeof(float) == 0);
    // What is read as one four has to lie together.
    static_assert(offsetof(ContactRecord<D>, rolling) == offsetof(ContactRecord<D>, count) + 12);
    static_assert(offsetof(ContactRecord<D>, roundness_b) == offsetof(ContactRecord<D>, roundness_a) + 4);
    static_assert(offsetof(ContactRecordPoint<D>, arm_b) == 4 * D);
    static_assert(offsetof(ContactRecordPoint<D>, separation) == 8 * D);
    static_assert(offsetof(ContactRecordPoint<D>, impulse) == 8 * D + 4);

    const BlockSource<D>& source;

    template <class F, class Member>
    CAROM_INLINE void operator()(const Member& member_of_first, F& x, F& y, F& z, F& w) const {
        gather_quads(reinterpret_cast<const float*>(&member_of_first), source.index, stride, x, y, z, w);
    }
    template <class F>
    CAROM_INLINE Vec<2, F> vec(const Vec<2, float>& member_of_first) const {
        F x, y, z, w;
        (*this)(member_of_first, x, y, z, w);
        return {x, y};
    }
    template <class F>
    CAROM_INLINE Vec<3, F> vec(const Vec<3, float>& member_of_first) const {
        F x, y, z, w;
        (*this)(member_of_first, x, y, z, w);
        return {x, y, z};
    }
};

template <class F>
CAROM_INLINE void read_point(const RecordReader<2>& read, const ContactRecordPoint<2>& from,
                             NormalRow<2, F>& p) {
    F total, feature;
    read(from.arm_a, p.arm_a.x, p.arm_a.y, p.arm_b.x, p.arm_b.y);
    read(from.separation, p.separation, p.impulse, total, feature);
}
template <class F>
CAROM_INLINE void read_point(const RecordReader<3>& read, const ContactRecordPoint<3>& from,
                             NormalRow<3, F>& p) {
    read(from.arm_a, p.arm_a.x, p.arm_a.y, p.arm_a.z, p.arm_b.x);
    read(from.arm_b.y, p.arm_b.y, p.arm_b.z, p.separation, p.impulse);
}

/// The points of the contact; masses are 1 where a point is used and 0 where not (see `weigh_rows`).
template <int D, class F>
CAROM_INLINE void load_points(ContactRows<D, F>& rows, const BlockSource<D>& source) {
    const RecordReader<D> read{source};
    const F count = load_lanes<F>(source.count);
    for (int k = 0; k < ContactRows<D, F>::capacity; ++k) {
        NormalRow<D, F> p;
        read_point(read, source.records->points[k], p);
        p.mass = select(count > F(static_cast<float>(k)), F(1), F(0));
        p.impulse = select(p.mass > F(0), p.impulse, F(0));
        rows.points[k] = p;
    }
}

template <int D, class F>
CAROM_INLINE void load_rows(ContactRows<D, F>& rows, const BlockSource<D>& source, Extras extras) {
    const ContactRecord<D>& first = *source.records;
    const RecordReader<D> read{source};
    F count, restitution;
    read(first.count, count, restitution, rows.friction, rows.rolling);
    rows.normal = read.template vec<F>(first.normal);
    const auto t = tangents<D>(rows.normal);
    rows.tangent = t[0];
    const Vec<D, F> friction = read.template vec<F>(first.friction_impulse);
    const Vec<D, F> surface = read.template vec<F>(first.surface_velocity);
    for (int i = 0; i < D - 1; ++i) {
        rows.friction_impulse[i] = dot(friction, t[i]);
        rows.surface_speed[i] = dot(surface, t[i]);
        rows.total_friction[i] = F(0);
    }
    F x, y, z, w;
    read(first.roundness_a, rows.roundness_a, rows.roundness_b, x, y);
    if constexpr (D == 3) read(first.twist_impulse, rows.twist_impulse, x, y, z);
    if (extras.rolling) {
        read(first.spin_impulse, x, y, z, w);
        if constexpr (D == 2) {
            rows.rolling_impulse = x;
        } else {
            rows.rolling_impulse = {x, y, z};
        }
    }
    load_points(rows, source);
}

}  // namespace carom::detail
