#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/rows.hpp"

/// Bodies as the passes over the contacts see them: one compact record a body, because each lane of a contact
/// asks for another body. A record is read and written by fours of floats, which are transposed into lanes.
///
///     2D, 32 bytes: velocity xy, spin, 1/mass | way xy, turn, 1/inertia
///     3D, 80 bytes: velocity xyz, 1/mass | spin xyz, Ixx | way xyz, Iyy | turn xyz, Izz | Ixy Ixz Iyz,
///     unused
namespace carom::detail {

template <int D>
constexpr std::size_t body_stride = D == 2 ? 8 : 20;  // floats

template <int D>
struct RecordView {
    float* records = nullptr;
    /// Four floats a body, 0 along a locked axis and 1 along a free one; null where no axis is locked.
    const float* free_axes = nullptr;
    std::uint32_t first_movable = 0;  ///< bodies before this one cannot be pushed: they are read only
};

/// Contacts name the records of their bodies by where these lie, in pairs of floats: processors add so much
/// to an address without further ado.
constexpr std::size_t record_unit = 2;  // floats
template <int D>
constexpr std::uint32_t record_of(std::uint32_t slot) {
    return slot * static_cast<std::uint32_t>(body_stride<D> / record_unit);
}
template <int D>
constexpr std::uint32_t slot_of(std::uint32_t record) {
    return record / static_cast<std::uint32_t>(body_stride<D> / record_unit);
}

template <int D, class F>
struct Body {
    Motion<D, F> motion;
    Weight<D, F> weight;
    F inverse_mass{};
};

/// Inverse mass along each axis, of bodies some of which have locked ones.
template <int D, class F>
CAROM_INLINE void lock_axes(const RecordView<D>& bodies, const std::uint32_t* slots, Body<D, F>& body) {
    F x, y, z, w;
    gather_record(bodies.free_axes, slots, 4, x, y, z, w);
    const F mass = body.inverse_mass;
    if constexpr (D == 2)
        body.weight.mass = {mass * x, mass * y};
    else
        body.weight.mass = {mass * x, mass * y, mass * z};
}

template <std::size_t unit, class F>
CAROM_INLINE void gather_at(const RecordView<2>& bodies, const std::uint32_t* index, Body<2, F>& body) {
    Motion<2, F>& m = body.motion;
    F& mass = body.inverse_mass;
    gather_record(bodies.records, index, unit, m.v.x, m.v.y, m.w, mass, m.moved.x, m.moved.y, m.turned,
                  body.weight.inertia);
    body.weight.mass = {mass, mass};
}
template <std::size_t unit, class F>
CAROM_INLINE void gather_at(const RecordView<3>& bodies, const std::uint32_t* index, Body<3, F>& body) {
    Motion<3, F>& m = body.motion;
    Symmetric3<F>& i = body.weight.inertia;
    F& mass = body.inverse_mass;
    F unused;
    gather_record(bodies.records, index, unit, m.v.x, m.v.y, m.v.z, mass, m.w.x, m.w.y, m.w.z, i.xx,
                  m.moved.x, m.moved.y, m.moved.z, i.yy, m.turned.x, m.turned.y, m.turned.z, i.zz, i.xy, i.xz,
                  i.yz, unused);
    body.weight.mass = {mass, mass, mass};
}

/// Reads the bodies with these slots, one a lane.
template <class F, int D>
CAROM_INLINE Body<D, F> gather(const RecordView<D>& bodies, const std::uint32_t* slots) {
    Body<D, F> body;
    gather_at<body_stride<D>>(bodies, slots, body);
    if (bodies.free_axes) lock_axes(bodies, slots, body);
    return body;
}
/// Reads the bodies with these records, one a lane.
template <class F, int D>
CAROM_INLINE Body<D, F> gather_records(const RecordView<D>& bodies, const std::uint32_t* records) {
    Body<D, F> body;
    gather_at<record_unit>(bodies, records, body);
    if (bodies.free_axes) {
        std::uint32_t slots[lane_count<F>];
        for (int lane = 0; lane < lane_count<F>; ++lane) slots[lane] = slot_of<D>(records[lane]);
        lock_axes(bodies, slots, body);
    }
    return body;
}

/// Writes the velocities back. No two lanes may have the same slot; with `some_fixed`, those that cannot be
/// pushed may.
template <std::size_t unit, class F>
CAROM_INLINE void scatter_velocity_at(const RecordView<2>& bodies, const std::uint32_t* index,
                                      const Body<2, F>& body, bool some_fixed) {
    const Motion<2, F>& m = body.motion;
    const auto first = static_cast<std::uint32_t>(bodies.first_movable * (body_stride<2> / unit));
    if (some_fixed) {
        scatter_record_from(first, bodies.records, index, unit, m.v.x, m.v.y, m.w, body.inverse_mass);
    } else {
        scatter_record(bodies.records, index, unit, m.v.x, m.v.y, m.w, body.inverse_mass);
    }
}
template <std::size_t unit, class F>
CAROM_INLINE void scatter_velocity_at(const RecordView<3>& bodies, const std::uint32_t* index,
                                      const Body<3, F>& body, bool some_fixed) {
    const Motion<3, F>& m = body.motion;
    const F& ixx = body.weight.inertia.xx;
    const auto first = static_cast<std::uint32_t>(bodies.first_movable * (body_stride<3> / unit));
    if (some_fixed) {
        scatter_record_from(first, bodies.records, index, unit, m.v.x, m.v.y, m.v.z, body.inverse_mass, m.w.x,
                            m.w.y, m.w.z, ixx);
    } else {
        scatter_record(bodies.records, index, unit, m.v.x, m.v.y, m.v.z, body.inverse_mass, m.w.x, m.w.y,
                       m.w.z, ixx);
    }
}
template <int D, class F>
CAROM_INLINE void scatter_velocity(const RecordView<D>& bodies, const std::uint32_t* slots,
                                   const Body<D, F>& body, bool some_fixed) {
    scatter_velocity_at<body_stride<D>>(bodies, slots, body, some_fixed);
}

/// Writes how far the bodies have come; all slots have to differ.
template <class F>
CAROM_INLINE void scatter_way(const RecordView<2>& bodies, const std::uint32_t* slots,
                              const Body<2, F>& body) {
    const Motion<2, F>& m = body.motion;
    scatter_record(bodies.records + 4, slots, body_stride<2>, m.moved.x, m.moved.y, m.turned,
                   body.weight.inertia);
}
template <class F>
CAROM_INLINE void scatter_way(const RecordView<3>& bodies, const std::uint32_t* slots,
                              const Body<3, F>& body) {
    const Motion<3, F>& m = body.motion;
    const Symmetric3<F>& i = body.weight.inertia;
    scatter_record(bodies.records + 8, slots, body_stride<3>, m.moved.x, m.moved.y, m.moved.z, i.yy,
                   m.turned.x, m.turned.y, m.turned.z, i.zz);
}

/// Writes everything but the locks; all slots have to differ.
template <int D, class F>
CAROM_INLINE void write_record(const RecordView<D>& bodies, const std::uint32_t* slots,
                               const Body<D, F>& body) {
    scatter_velocity(bodies, slots, body, false);
    scatter_way(bodies, slots, body);
    if constexpr (D == 3) {
        const Symmetric3<F>& i = body.weight.inertia;
        scatter_record(bodies.records + 16, slots, body_stride<3>, i.xy, i.xz, i.yz, F(0));
    }
}

}  // namespace carom::detail
