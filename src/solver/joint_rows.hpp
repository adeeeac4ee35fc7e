#pragma once

#include <type_traits>

#include "dynamics/joint.hpp"
#include "solver/prepare.hpp"
#include "solver/rows.hpp"

/// The arithmetic of a joint, written once for both dimensions and for any lane type, like solver/rows.hpp.
///
/// Arms and axes turn within the step. Impulses act along the Jacobian of the middle of a sub-step, and the
/// velocities of its end are what the rows constrain: the work that a joint does is then zero to second order
/// in the length of a sub-step, so that what swings on joints keeps its energy. As the solver warm-starts a
/// sub-step with the change of velocity of the one before, a joint first turns its impulses into their new
/// directions (`re_aim`). Of an impulse that was a blow, nothing is kept: it would strike again.
///
/// Errors of position are put right by moving the bodies, not by giving them a velocity: a velocity would be
/// kept by warm starting until all joints of a chain have agreed to take it back, and long chains swing up
/// or have to be made soft. So the impulses hold forces alone, come to rest where forces balance, and what
/// hangs at rest does not sag.
namespace carom::detail {

/// What the joints of a sub-step share.
template <class F>
struct JointStep {
    F h{};
    F inverse_h{};
    F share{};     ///< of an error of position that is put right in a sub-step
    F most_way{};  ///< the furthest that something is put right in a sub-step, m and rad
    /// Is it a further pass of the same sub-step? Then impulses and speeds are along the same directions, so
    /// that passes can only take energy away, however many there are.
    bool again = false;
};

// ---- What is kept from sub-step to sub-step, and from step to step: impulses of the rows ----

template <int tag>
struct Nothing {};

template <class F>
struct DriveImpulses {
    F spring{}, motor{}, low{}, high{};
    F sum() const { return spring + motor + low - high; }
};

template <int D, class F>
struct HeldImpulses {
    Angular<D, F> spring{}, friction{};
};

template <int D, class F, LinearPart part>
using LinearImpulse =
    std::conditional_t<part == LinearPart::none, Nothing<0>,
                       std::conditional_t<part == LinearPart::line, std::array<F, D - 1>, Vec<D, F>>>;

template <int D, class F, AngularPart part>
using AngularImpulse =
    std::conditional_t<part == AngularPart::none, Nothing<1>,
                       std::conditional_t<part == AngularPart::held, HeldImpulses<D, F>,
                                          std::conditional_t<part == AngularPart::square, F, Angular<D, F>>>>;

template <class F, int count>
using AllDriveImpulses = std::conditional_t<count == 0, Nothing<2>, std::array<DriveImpulses<F>, count>>;

template <int D, class F, Layout L>
struct KeptImpulses {
    [[no_unique_address]] LinearImpulse<D, F, L.linear> linear{};
    [[no_unique_address]] AngularImpulse<D, F, L.angular> angular{};
    [[no_unique_address]] AllDriveImpulses<F, L.drive_count> drives{};
};

// ---- What is known at the start of the step ----

/// A spring in the form in which one joint alone does exactly what it should at any length of a sub-step (see
/// `spring_response`): next = keep · old − mass · (offset + keep · speed), where offset = pull · stretch +
/// keep · the speed before. Zeros make no spring.
template <class F>
struct SpringRow {
    F pull{}, keep{}, most{};
};

template <int D, class F>
struct Anchors {
    Vec<D, F> arm_a{}, arm_b{};  ///< from the centres of mass to the anchors
    Vec<D, F> gap{};             ///< from anchor a to anchor b
};

template <int D, class F>
struct LineBase {
    std::array<Vec<D, F>, D - 1> across{};
};

template <int D, class F>
struct HeldPoint {
    SpringRow<F> spring{};
    Vec<D, F> offset{}, before{};  ///< before: speed at the start of the sub-step
};

template <int D, class F>
struct LockedBase {
    Angular<D, F> turn{};  ///< of frame b against frame a, as a rotation vector
};

template <class F>
struct AxesBase {
    Vec<3, F> axis_a{}, axis_b{};
};

template <int D, class F>
struct HeldTurn {
    Angular<D, F> turn{};
    SpringRow<F> spring{};
    F friction{};
    Angular<D, F> offset{}, before{};
};

template <int D, class F>
struct DriveBase {
    Vec<D, F> axis{};  ///< turns with a; unused in the plane for turns
    F low{}, high{};   ///< of angles: against that of the start of the step
    SpringRow<F> spring{};
    F rest{}, offset{}, before{};
    F motor_speed{}, motor_most{};
};

template <int D, class F, LinearPart part>
using LinearBase =
    std::conditional_t<part == LinearPart::line, LineBase<D, F>,
                       std::conditional_t<part == LinearPart::held, HeldPoint<D, F>, Nothing<3>>>;

template <int D, class F, AngularPart part>
using AngularBase = std::conditional_t<
    part == AngularPart::locked, LockedBase<D, F>,
    std::conditional_t<part == AngularPart::across || part == AngularPart::square, AxesBase<F>,
                       std::conditional_t<part == AngularPart::held, HeldTurn<D, F>, Nothing<4>>>>;

template <int D, class F, int count>
using AllDriveBases = std::conditional_t<count == 0, Nothing<5>, std::array<DriveBase<D, F>, count>>;

constexpr bool has_anchors(const Layout& l) {
    bool any = l.linear != LinearPart::none;
    for (int i = 0; i < l.drive_count; ++i) any |= l.drives[i] != DriveKind::turn;
    return any;
}

/// Is there nothing to a joint but that its anchors meet?
constexpr bool has_anchors_alone(const Layout& l) {
    return l.linear == LinearPart::point && l.angular == AngularPart::none && l.drive_count == 0;
}

/// A joint. All members are lanes.
template <int D, class F, Layout L>
struct JointRows {
    KeptImpulses<D, F, L> kept{};
    Wrench<D, F> wrench{};  ///< what the impulses are on the bodies: as they were last applied
    Wrench<D, F> before{};  ///< the same in the sub-step before
    Wrench<D, F> total{};   ///< sum over the sub-steps before
    [[no_unique_address]] std::conditional_t<has_anchors(L), Anchors<D, F>, Nothing<6>> anchors{};
    [[no_unique_address]] LinearBase<D, F, L.linear> linear{};
    [[no_unique_address]] AngularBase<D, F, L.angular> angular{};
    [[no_unique_address]] AllDriveBases<D, F, L.drive_count> drives{};
};

// ---- How things turn ----

/// The rotation by a rotation vector θ, from series of |θ|² that are exact to `float` up to a quarter turn
/// and good to 1e-3 up to half a turn, which is more than a step should bring.
template <class F>
struct TurnSeries {
    F sine, cosine;  ///< sin |θ| / |θ|, (1 − cos |θ|) / |θ|²
    CAROM_INLINE explicit TurnSeries(F z)
        : sine(F(1) - z * (F(1.0f / 6) -
                           z * (F(1.0f / 120) -
                                z * (F(1.0f / 5040) - z * (F(1.0f / 362880) - z * F(1.0f / 39916800)))))),
          cosine(F(0.5f) -
                 z * (F(1.0f / 24) -
                      z * (F(1.0f / 720) -
                           z * (F(1.0f / 40320) - z * (F(1.0f / 3628800) - z * F(1.0f / 479001600)))))) {}
};

/// The same turn with whole turns left out, which a spin of more than 190 rad/s brings within a step of 60
/// Hz: what is beyond half a turn the series would make arms of any length of.
template <int D, class F>
CAROM_INLINE Angular<D, F> without_whole_turns(const Angular<D, F>& angle) {
    constexpr float half = 3.14159265f, whole = 2 * half;
    const F squared = angular_dot(angle, angle);
    const auto beyond = squared > F(half * half);
    const F size = square_root(select(beyond, squared, F(1)));
    const F magic(12582912.0f);  // 1.5 · 2²³: what is added to it is rounded to a whole number
    const F turns = (size * F(1 / whole) + magic) - magic;
    return angle * select(beyond, F(1) - F(whole) * turns / size, F(1));
}

/// What a body has turned by since the step began, and turns on by.
template <int D, class F>
struct Turning {
    Angular<D, F> angle, spin;
    TurnSeries<F> series;
    F ahead;  ///< time in which arms are turned on, s

    /// What turns by so much in a sub-step that it cannot be followed is not: beyond 0.2 rad, and less from
    /// 0.14 rad on. With impulses and velocities along the same directions, a pass takes energy away whatever
    /// happens.
    CAROM_INLINE Turning(const Motion<D, F>& m, F h)
        : angle(without_whole_turns<D, F>(m.turned)), spin(m.w), series(angular_dot(angle, angle)) {
        const F squared = h * h * angular_dot(m.w, m.w);
        ahead = h * maximum(F(0), minimum(F(1), F(2) - F(50) * squared));
    }

    /// By how much the vector changed as it turned.
    CAROM_INLINE Vec<D, F> change(const Vec<D, F>& v) const {
        const Vec<D, F> across = cross(angle, v);
        return series.sine * across + series.cosine * cross(angle, across);
    }
};

/// A vector that turns with a body: now, in the middle of the sub-step and at its end. `biased` passes run at
/// the start of the sub-step, the others at its end.
template <int D, class F>
struct Turned {
    Vec<D, F> now{}, middle{}, end{};
};

template <bool biased, int D, class F>
CAROM_INLINE Turned<D, F> turned(const Vec<D, F>& now, const Angular<D, F>& spin, F h) {
    const Vec<D, F> first = cross(spin, now), second = cross(spin, first);
    const F eighth = F(0.125f) * h * h, half = F(0.5f) * h;
    if constexpr (biased) {
        return {now, now + half * first + eighth * second, now + h * first + (F(4) * eighth) * second};
    } else {
        return {now, now - half * first + eighth * second, now};
    }
}

template <bool biased, int D, class F>
CAROM_INLINE Turned<D, F> turned(const Vec<D, F>& start, const Turning<D, F>& turning) {
    return turned<biased, D, F>(start + turning.change(start), turning.spin, turning.ahead);
}

/// By how much b has turned more than a: log(exp(θb) exp(−θa)) to second order.
template <int D, class F>
CAROM_INLINE Angular<D, F> relative_turn(const Angular<D, F>& a, const Angular<D, F>& b) {
    if constexpr (D == 2) {
        return b - a;
    } else {
        return (b - a) - F(0.5f) * cross(b, a);
    }
}

// ---- Both bodies of a joint, and what it has applied to them ----

template <int D, class F>
struct Link {
    Motion<D, F>&a, &b;
    const Weight<D, F>&wa, &wb;
    Wrench<D, F>& applied;

    CAROM_INLINE void add(const Wrench<D, F>& w) {
        a.v -= each(wa.mass, w.force);
        a.w = a.w - wa.inertia * w.on_a;
        b.v += each(wb.mass, w.force);
        b.w = b.w + wb.inertia * w.on_b;
    }
    CAROM_INLINE void push(const Wrench<D, F>& w) {
        add(w);
        applied.force += w.force;
        applied.on_a = applied.on_a + w.on_a;
        applied.on_b = applied.on_b + w.on_b;
    }
    /// Moves the bodies as the impulse moves velocities.
    CAROM_INLINE void shift(const Wrench<D, F>& w) {
        a.moved -= each(wa.mass, w.force);
        a.turned = a.turned - wa.inertia * w.on_a;
        b.moved += each(wb.mass, w.force);
        b.turned = b.turned + wb.inertia * w.on_b;
    }
    /// How alike two impulses are, in what they do to the bodies: their product with the inverse masses.
    CAROM_INLINE F likeness(const Wrench<D, F>& s, const Wrench<D, F>& t) const {
        return dot(s.force, each(wa.mass + wb.mass, t.force)) + angular_dot(s.on_a, wa.inertia * t.on_a) +
               angular_dot(s.on_b, wb.inertia * t.on_b);
    }
    CAROM_INLINE Angular<D, F> spin() const { return b.w - a.w; }
    CAROM_INLINE Inertia<D, F> angular_compliance() const { return wa.inertia + wb.inertia; }
};

/// Where arms and axes of a joint are.
template <int D, class F>
struct Geometry {
    Turned<D, F> arm_a{}, arm_b{};
    Vec<D, F> gap{}, gap_middle{}, gap_end{};

    CAROM_INLINE Wrench<D, F> at_anchors(const Vec<D, F>& p) const {
        return {p, cross(arm_a.middle, p), cross(arm_b.middle, p)};
    }
    /// For forces that hold anchor b to a line that is fixed in a.
    CAROM_INLINE Wrench<D, F> at_b(const Vec<D, F>& p) const {
        return {p, cross(Vec<D, F>(arm_a.middle + gap_middle), p), cross(arm_b.middle, p)};
    }
    CAROM_INLINE Vec<D, F> speed(const Link<D, F>& link) const {
        return relative_velocity(link.a, link.b, arm_a.end, arm_b.end);
    }
    CAROM_INLINE Vec<D, F> speed_along_line(const Link<D, F>& link) const {
        return relative_velocity(link.a, link.b, Vec<D, F>(arm_a.end + gap_end), arm_b.end);
    }
};

template <bool biased, int D, class F>
CAROM_INLINE Geometry<D, F> geometry(const Anchors<D, F>& base, const Turning<D, F>& a,
                                     const Turning<D, F>& b, const Motion<D, F>& ma, const Motion<D, F>& mb) {
    Geometry<D, F> g;
    const Vec<D, F> change_a = a.change(base.arm_a), change_b = b.change(base.arm_b);
    g.arm_a = turned<biased, D, F>(base.arm_a + change_a, a.spin, a.ahead);
    g.arm_b = turned<biased, D, F>(base.arm_b + change_b, b.spin, b.ahead);
    g.gap = base.gap + (mb.moved - ma.moved) + (change_b - change_a);
    const Vec<D, F> way = minimum(a.ahead, b.ahead) * relative_velocity(ma, mb, g.arm_a.now, g.arm_b.now);
    g.gap_middle = biased ? g.gap + F(0.5f) * way : g.gap - F(0.5f) * way;
    g.gap_end = biased ? g.gap + way : g.gap;
    return g;
}

// ---- Effective masses ----

template <class F>
CAROM_INLINE void add_point_compliance(Symmetric3<F>& k, const Weight<3, F>& w, const Vec<3, F>& r) {
    const F o = F(0);
    const Vec<3, F> x{o, r.z, -r.y}, y{-r.z, o, r.x}, z{r.y, -r.x, o};  // r × each axis
    const Vec<3, F> ix = w.inertia * x, iy = w.inertia * y, iz = w.inertia * z;
    k = k + Symmetric3<F>{w.mass.x + dot(x, ix),
                          w.mass.y + dot(y, iy),
                          w.mass.z + dot(z, iz),
                          dot(x, iy),
                          dot(x, iz),
                          dot(y, iz)};
}

/// The impulse between two anchors that changes their relative velocity by `wanted`.
template <class F>
CAROM_INLINE Vec<3, F> point_impulse(const Link<3, F>& link, const Vec<3, F>& arm_a, const Vec<3, F>& arm_b,
                                     const Vec<3, F>& wanted) {
    Symmetric3<F> k{};
    add_point_compliance(k, link.wa, arm_a);
    add_point_compliance(k, link.wb, arm_b);
    return inverse_or_zero(k) * wanted;
}

template <class F>
CAROM_INLINE Vec<2, F> inverse_times(F xx, F xy, F yy, const Vec<2, F>& v) {
    const F k = inverse_or_zero(xx * yy - xy * xy);
    return {k * (yy * v.x - xy * v.y), k * (xx * v.y - xy * v.x)};
}

template <class F>
CAROM_INLINE Vec<2, F> point_impulse(const Link<2, F>& link, const Vec<2, F>& ra, const Vec<2, F>& rb,
                                     const Vec<2, F>& wanted) {
    const F ia = link.wa.inertia, ib = link.wb.inertia;
    const F xx = link.wa.mass.x + link.wb.mass.x + ia * ra.y * ra.y + ib * rb.y * rb.y;
    const F yy = link.wa.mass.y + link.wb.mass.y + ia * ra.x * ra.x + ib * rb.x * rb.x;
    const F xy = -(ia * ra.x * ra.y + ib * rb.x * rb.y);
    return inverse_times(xx, xy, yy, wanted);
}

template <class F>
CAROM_INLINE F cut_to(F value, F most) {
    return maximum(-most, minimum(most, value));
}
template <int D, class F>
CAROM_INLINE Vec<D, F> cut_to(const Vec<D, F>& value, F most) {
    const F squared = dot(value, value);
    const auto over = squared > most * most;
    return value * select(over, most / square_root(select(over, squared, F(1))), F(1));
}

}  // namespace carom::detail
