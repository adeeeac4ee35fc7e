#pragma once

#include <array>
#include <type_traits>

#include "math/dim.hpp"
#include "simd/scalar.hpp"

/// The frame of a contact, and vectors as seen from it: the component along the normal comes first (`x`),
/// those along the tangents follow. It is right-handed, so cross products are the same in it. For any lane
/// type.
namespace carom::detail {

template <int D, class F>
struct ContactFrame {
    Vec<D, F> normal{};
    std::array<Vec<D, F>, D - 1> tangents{};
};

/// What lies across the normal of an angular quantity, along the tangents; in the plane all of it. An impulse
/// along the normal makes no other torque.
template <int D, class F>
using Tilt = std::conditional_t<D == 2, F, Vec<2, F>>;

template <class F>
struct Symmetric2 {
    F xx{}, xy{}, yy{};

    friend Symmetric2 operator+(const Symmetric2& a, const Symmetric2& b) {
        return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
    }
    friend Vec<2, F> operator*(const Symmetric2& m, const Vec<2, F>& v) {
        return {m.xx * v.x + m.xy * v.y, m.xy * v.x + m.yy * v.y};
    }
};
template <int D, class F>
using TiltInertia = std::conditional_t<D == 2, F, Symmetric2<F>>;

template <class F>
CAROM_INLINE F tilt_dot(const F& a, const F& b) {
    return a * b;
}
template <class F>
CAROM_INLINE F tilt_dot(const Vec<2, F>& a, const Vec<2, F>& b) {
    return dot(a, b);
}

template <class F>
CAROM_INLINE Vec<2, F> to_frame(const ContactFrame<2, F>& f, const Vec<2, F>& v) {
    return {dot(f.normal, v), dot(f.tangents[0], v)};
}
template <class F>
CAROM_INLINE Vec<3, F> to_frame(const ContactFrame<3, F>& f, const Vec<3, F>& v) {
    return {dot(f.normal, v), dot(f.tangents[0], v), dot(f.tangents[1], v)};
}
template <class F>
CAROM_INLINE Vec<2, F> from_frame(const ContactFrame<2, F>& f, const Vec<2, F>& v) {
    return v.x * f.normal + v.y * f.tangents[0];
}
template <class F>
CAROM_INLINE Vec<3, F> from_frame(const ContactFrame<3, F>& f, const Vec<3, F>& v) {
    return v.x * f.normal + v.y * f.tangents[0] + v.z * f.tangents[1];
}

/// Angular quantities.
template <class F>
CAROM_INLINE F turn_to_frame(const ContactFrame<2, F>&, const F& w) {
    return w;
}
template <class F>
CAROM_INLINE Vec<3, F> turn_to_frame(const ContactFrame<3, F>& f, const Vec<3, F>& w) {
    return to_frame(f, w);
}
template <class F>
CAROM_INLINE F turn_from_frame(const ContactFrame<2, F>&, const F& w) {
    return w;
}
template <class F>
CAROM_INLINE Vec<3, F> turn_from_frame(const ContactFrame<3, F>& f, const Vec<3, F>& w) {
    return from_frame(f, w);
}

template <class F>
CAROM_INLINE F tilt_of(const ContactFrame<2, F>&, const F& w) {
    return w;
}
template <class F>
CAROM_INLINE Vec<2, F> tilt_of(const ContactFrame<3, F>& f, const Vec<3, F>& w) {
    return {dot(f.tangents[0], w), dot(f.tangents[1], w)};
}
template <class F>
CAROM_INLINE F from_tilt(const ContactFrame<2, F>&, const F& l) {
    return l;
}
template <class F>
CAROM_INLINE Vec<3, F> from_tilt(const ContactFrame<3, F>& f, const Vec<2, F>& l) {
    return l.x * f.tangents[0] + l.y * f.tangents[1];
}

/// r × n for an arm r of the frame.
template <class F>
CAROM_INLINE F lever(const Vec<2, F>& arm) {
    return -arm.y;
}
template <class F>
CAROM_INLINE Vec<2, F> lever(const Vec<3, F>& arm) {
    return {arm.z, -arm.y};
}

/// The part of an inertia that is across the normal, of an inertia in the frame.
template <class F>
CAROM_INLINE F tilt_inertia(const F& inertia) {
    return inertia;
}
template <class F>
CAROM_INLINE Symmetric2<F> tilt_inertia(const Symmetric3<F>& inertia) {
    return {inertia.yy, inertia.yz, inertia.zz};
}

template <class F>
CAROM_INLINE F inertia_to_frame(const ContactFrame<2, F>&, const F& inertia) {
    return inertia;
}
template <class F>
CAROM_INLINE Symmetric3<F> inertia_to_frame(const ContactFrame<3, F>& f, const Symmetric3<F>& inertia) {
    const Vec<3, F> n = inertia * f.normal, t = inertia * f.tangents[0], u = inertia * f.tangents[1];
    return {dot(f.normal, n),      dot(f.tangents[0], t), dot(f.tangents[1], u),
            dot(f.tangents[0], n), dot(f.tangents[1], n), dot(f.tangents[1], t)};
}

/// How far the end of an arm r comes along the normal n as r turns by the rotation vector θ, to second order,
/// is r times this: n · (θ × r + ½ θ × (θ × r)) = r · (n × θ + ½ ((θ · n) θ − θ² n)).
template <class F>
CAROM_INLINE Vec<2, F> rise(const ContactFrame<2, F>&, const F& turned) {
    return {F(-0.5f) * turned * turned, -turned};
}
template <class F>
CAROM_INLINE Vec<3, F> rise(const ContactFrame<3, F>& f, const Vec<3, F>& turned) {
    const Vec<3, F> q = to_frame(f, turned);
    const F about = F(0.5f) * q.x;
    return {F(-0.5f) * (q.y * q.y + q.z * q.z), about * q.y - q.z, about * q.z + q.y};
}

}  // namespace carom::detail
