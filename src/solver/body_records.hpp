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

template <int D, class F>
struct Body {
    Motion<D, F> motion;
    Weight<D, F> weight;
    F inverse_mass{};
};

/// Reads the bodies with these slots, one a lane.
template <class F>
CAROM_INLINE Body<2, F> gather(const RecordView<2>& bodies, const std::uint32_t* slots) {
    Body<2, F> body;
    Motion<2, F>& m = body.motion;
    F& mass = body.inverse_mass;
    gather_quads(bodies.records, slots, body_stride<2>, m.v.x, m.v.y, m.w, mass);
    gather_quads(bodies.records + 4, slots, body_stride<2>, m.moved.x, m.moved.y, m.turned,
                 body.weight.inertia);
    body.weight.mass = {mass, mass};
    if (bodies.free_axes) {
        F x, y, z, w;
        gather_quads(bodies.free_axes, slots, 4, x, y, z, w);
        body.weight.mass = {mass * x, mass * y};
    }
    return body;
}

template <class F>
CAROM_INLINE Body<3, F> gather(const RecordView<3>& bodies, const std::uint32_t* slots) {
    Body<3, F> body;
    Motion<3, F>& m = body.motion;
    Symmetric3<F>& i = body.weight.inertia;
    F& mass = body.inverse_mass;
    F unused;
    gather_quads(bodies.records, slots, body_stride<3>, m.v.x, m.v.y, m.v.z, mass);
    gather_quads(bodies.records + 4, slots, body_stride<3>, m.w.x, m.w.y, m.w.z, i.xx);
    gather_quads(bodies.records + 8, slots, body_stride<3>, m.moved.x, m.moved.y, m.moved.z, i.yy);
    gather_quads(bodies.records + 12, slots, body_stride<3>, m.turned.x, m.turned.y, m.turned.z, i.zz);
    gather_quads(bodies.records + 16, slots, body_stride<3>, i.xy, i.xz, i.yz, unused);
    body.weight.mass = {mass, mass, mass};
    if (bodies.free_axes) {
        F x, y, z, w;
        gather_quads(bodies.free_axes, slots, 4, x, y, z, w);
        body.weight.mass = {mass * x, mass * y, mass * z};
    }
    return body;
}

/// Writes the velocities back. No two lanes may have the same slot; with `some_fixed`, those that cannot be
/// pushed may.
template <class F>
CAROM_INLINE void scatter_velocity(const RecordView<2>& bodies, const std::uint32_t* slots,
                                   const Body<2, F>& body, bool some_fixed) {
    const Motion<2, F>& m = body.motion;
    if (some_fixed) {
        scatter_quads_from(bodies.first_movable, bodies.records, slots, body_stride<2>, m.v.x, m.v.y, m.w,
                           body.inverse_mass);
    } else {
        scatter_quads(bodies.records, slots, body_stride<2>, m.v.x, m.v.y, m.w, body.inverse_mass);
    }
}

template <class F>
CAROM_INLINE void scatter_velocity(const RecordView<3>& bodies, const std::uint32_t* slots,
                                   const Body<3, F>& body, bool some_fixed) {
    const Motion<3, F>& m = body.motion;
    const F& ixx = body.weight.inertia.xx;
    float *linear = bodies.records, *angular = bodies.records + 4;
    if (some_fixed) {
        scatter_quads_from(bodies.first_movable, linear, slots, body_stride<3>, m.v.x, m.v.y, m.v.z,
                           body.inverse_mass);
        scatter_quads_from(bodies.first_movable, angular, slots, body_stride<3>, m.w.x, m.w.y, m.w.z, ixx);
    } else {
        scatter_quads(linear, slots, body_stride<3>, m.v.x, m.v.y, m.v.z, body.inverse_mass);
        scatter_quads(angular, slots, body_stride<3>, m.w.x, m.w.y, m.w.z, ixx);
    }
}

/// Writes how far the bodies have come; all slots have to differ.
template <class F>
CAROM_INLINE void scatter_way(const RecordView<2>& bodies, const std::uint32_t* slots,
                              const Body<2, F>& body) {
    const Motion<2, F>& m = body.motion;
    scatter_quads(bodies.records + 4, slots, body_stride<2>, m.moved.x, m.moved.y, m.turned,
                  body.weight.inertia);
}
template <class F>
CAROM_INLINE void scatter_way(const RecordView<3>& bodies, const std::uint32_t* slots,
                              const Body<3, F>& body) {
    const Motion<3, F>& m = body.motion;
    const Symmetric3<F>& i = body.weight.inertia;
    scatter_quads(bodies.records + 8, slots, body_stride<3>, m.moved.x, m.moved.y, m.moved.z, i.yy);
    scatter_quads(bodies.records + 12, slots, body_stride<3>, m.turned.x, m.turned.y, m.turned.z, i.zz);
}

/// Writes everything but the locks; all slots have to differ.
template <int D, class F>
CAROM_INLINE void write_record(const RecordView<D>& bodies, const std::uint32_t* slots,
                               const Body<D, F>& body) {
    scatter_velocity(bodies, slots, body, false);
    scatter_way(bodies, slots, body);
    if constexpr (D == 3) {
        const Symmetric3<F>& i = body.weight.inertia;
        scatter_quads(bodies.records + 16, slots, body_stride<3>, i.xy, i.xz, i.yz, F(0));
    }
}

}  // namespace carom::detail
