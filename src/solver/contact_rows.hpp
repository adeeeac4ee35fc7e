#pragma once

#include <array>

#include "solver/contact_frame.hpp"
#include "solver/rows.hpp"

/// The arithmetic of a contact, for any lane type like solver/rows.hpp.
///
/// A contact has a frame in its middle, and its points lie in that frame. An impulse along the normal changes
/// only how fast the bodies part at the centre and how the one tilts against the other, so while the rows of
/// the points are solved nothing else is kept up to date, and the bodies get the sum of the impulses.
namespace carom::detail {

/// What an impulse along the normal makes of the motion of b against a at the centre of a contact: at the
/// lever l it changes the speed along the normal by straight + mixed · l, and the tilt by mixed + turning l.
template <int D, class F>
struct Response {
    F straight{};
    Tilt<D, F> mixed{};
    TiltInertia<D, F> turning{};
};

/// What only points in space have.
template <int D, class F>
struct PointInSpace {};
template <class F>
struct PointInSpace<3, F> {
    F lever{};  ///< distance from the centre, at which friction resists twisting
};

template <int D, class F>
struct NormalRow : PointInSpace<D, F> {
    Vec<D, F> place{};  ///< from the centre, in the frame
    F separation{};     ///< at the start of the step
    F mass{};           ///< effective mass; zero for a row that is not used
    F impulse{};
    F total_impulse{};  ///< sum over the sub-steps
};

/// What only contacts in space have.
template <int D, class F>
struct ContactInSpace {};
template <class F>
struct ContactInSpace<3, F> {
    Vec<3, F> tangent{};  ///< the first; the second is normal × tangent
    Response<3, F> response{};
    F twist_mass{}, twist_impulse{};
};

/// A contact between two bodies: a row a point along the normal, and one patch of friction in the middle.
/// All members are lanes, so that a contact is one lane of an array of them.
template <int D, class F>
struct ContactRows : ContactInSpace<D, F> {
    static constexpr int capacity = max_points<D>;

    Vec<D, F> normal{};
    Vec<D, F> arm_a{}, arm_b{};  ///< of the centre, in the frame
    F lead{};  ///< how much less a gap closes in a sub-step than h · speed, because the speed is still
               ///< growing
    F firm{};  ///< 1 where one of the bodies cannot be moved, so that overlap is pushed apart faster; else 0
    std::array<NormalRow<D, F>, capacity> points{};

    F friction{};
    std::array<F, D - 1> friction_impulse{};
    std::array<F, D == 2 ? 1 : 3>
        patch_mass{};  ///< 2D: effective mass; 3D: inverse of the 2×2 system (xx, xy, yy)
    std::array<F, D - 1> total_friction{};  ///< sum over the sub-steps

    // Last, what only some contacts have (see `Extras`).
    std::array<F, D - 1>
        surface_speed{};  ///< along the tangents, of b's surface against a's beside the bodies' motion
    F roundness_a{}, roundness_b{};
    F rolling{};
    Angular<D, F> rolling_impulse{};
    Inertia<D, F> rolling_mass{};
};

/// Terms that only some contacts have; a pass over contacts without them leaves them out.
struct Extras {
    bool roundness = false, rolling = false, belts = false;
};
constexpr Extras all_extras{true, true, true};

template <class F>
CAROM_INLINE ContactFrame<2, F> frame_of(const ContactRows<2, F>& c) {
    return {c.normal, tangents<2>(c.normal)};
}
template <class F>
CAROM_INLINE ContactFrame<3, F> frame_of(const ContactRows<3, F>& c) {
    return {c.normal, {c.tangent, cross(c.normal, c.tangent)}};
}

template <int D, class F>
CAROM_INLINE void set_normal(ContactRows<D, F>& c, const Vec<D, F>& normal) {
    c.normal = normal;
    if constexpr (D == 3) c.tangent = tangents<3>(normal)[0];
}

/// From the centre of mass of either body to a point.
template <int D, class F>
CAROM_INLINE Vec<D, F> arm_a(const ContactRows<D, F>& c, const NormalRow<D, F>& p) {
    return from_frame(frame_of(c), Vec<D, F>(c.arm_a + p.place));
}
template <int D, class F>
CAROM_INLINE Vec<D, F> arm_b(const ContactRows<D, F>& c, const NormalRow<D, F>& p) {
    return from_frame(frame_of(c), Vec<D, F>(c.arm_b + p.place));
}

/// Puts the points where these arms end, one of either body a point, and the frame into the middle of those
/// that are used, whose mass is positive. The frame comes in the axes in which the arms are. Of the two arms
/// the shorter one is the more precise.
template <int D, class F, std::size_t n>
CAROM_INLINE void place_points(ContactRows<D, F>& c, const ContactFrame<D, F>& frame,
                               const std::array<Vec<D, F>, n>& arms_a,
                               const std::array<Vec<D, F>, n>& arms_b) {
    F count = F(0);
    Vec<D, F> sum_a{}, sum_b{};
    for (std::size_t k = 0; k < n; ++k) {
        const F used = select(c.points[k].mass > F(0), F(1), F(0));
        count = count + used;
        sum_a += used * arms_a[k];
        sum_b += used * arms_b[k];
    }
    const F share = F(1) / maximum(count, F(1));
    const Vec<D, F> centre_a = share * sum_a, centre_b = share * sum_b;
    const auto b_is_nearer = dot(centre_a, centre_a) > dot(centre_b, centre_b);
    for (std::size_t k = 0; k < n; ++k) {
        const Vec<D, F> from_a = arms_a[k] - centre_a, from_b = arms_b[k] - centre_b;
        Vec<D, F> place;
        for (int i = 0; i < D; ++i) place[i] = select(b_is_nearer, from_b[i], from_a[i]);
        c.points[k].place = to_frame(frame, place);
    }
    c.arm_a = to_frame(frame, centre_a);
    c.arm_b = to_frame(frame, centre_b);
}

/// How gaps have grown since the step began: at the centre, and the more the further a point is from it.
template <int D, class F>
struct Opening {
    F at_centre{};
    Vec<D, F> slope{};

    /// Where a shape is round, the second-order term of `rise` opens too much: a ball that rolls presents new
    /// points at the same height, so the term belongs to the arm that ends at the centre of the curvature, a
    /// radius ρ further in.
    CAROM_INLINE Opening(const ContactRows<D, F>& c, const ContactFrame<D, F>& frame, const Motion<D, F>& a,
                         const Motion<D, F>& b, bool roundness) {
        const Vec<D, F> rise_a = rise(frame, a.turned), rise_b = rise(frame, b.turned);
        at_centre = dot(c.normal, b.moved - a.moved);
        if (roundness) at_centre = at_centre + (c.roundness_a * rise_a.x + c.roundness_b * rise_b.x);
        at_centre = at_centre + (dot(rise_b, c.arm_b) - dot(rise_a, c.arm_a));
        slope = rise_b - rise_a;
    }
    CAROM_INLINE F at(const NormalRow<D, F>& p) const { return at_centre + dot(slope, p.place); }
};

/// Gap at a point now. The normal is that of the step's start.
template <int D, class F>
CAROM_INLINE F gap(const ContactRows<D, F>& c, const NormalRow<D, F>& p, const Motion<D, F>& a,
                   const Motion<D, F>& b) {
    return p.separation + Opening<D, F>(c, frame_of(c), a, b, true).at(p);
}

/// A gap that counts as closed, m.
constexpr float closed_gap = 1e-5f;

template <class F>
CAROM_INLINE Response<2, F> response_of(const ContactRows<2, F>& c, const Weight<2, F>& a,
                                        const Weight<2, F>& b, const F& inertia_a, const F& inertia_b) {
    const F la = lever(c.arm_a), lb = lever(c.arm_b), ma = inertia_a * la, mb = inertia_b * lb;
    return {dot(c.normal, each(a.mass + b.mass, c.normal)) + (la * ma + lb * mb), ma + mb,
            inertia_a + inertia_b};
}
/// The inertias are those in the frame.
template <class F>
CAROM_INLINE Response<3, F> response_of(const ContactRows<3, F>& c, const Weight<3, F>& a,
                                        const Weight<3, F>& b, const Symmetric3<F>& inertia_a,
                                        const Symmetric3<F>& inertia_b) {
    const Vec<2, F> la = lever(c.arm_a), lb = lever(c.arm_b);
    const Symmetric2<F> ia = tilt_inertia(inertia_a), ib = tilt_inertia(inertia_b);
    const Vec<2, F> ma = ia * la, mb = ib * lb;
    return {dot(c.normal, each(a.mass + b.mass, c.normal)) + (dot(la, ma) + dot(lb, mb)), ma + mb, ia + ib};
}
/// As it was worked out before the first sub-step.
template <class F>
CAROM_INLINE Response<2, F> response_of(const ContactRows<2, F>& c, const Weight<2, F>& a,
                                        const Weight<2, F>& b) {
    return response_of(c, a, b, a.inertia, b.inertia);
}
template <class F>
CAROM_INLINE Response<3, F> response_of(const ContactRows<3, F>& c, const Weight<3, F>&,
                                        const Weight<3, F>&) {
    return c.response;
}

/// The impulse `along` the normal at the centre, and an angular impulse.
template <int D, class F>
CAROM_INLINE void push_along_normal(const ContactRows<D, F>& c, const ContactFrame<D, F>& frame,
                                    Motion<D, F>& a, Motion<D, F>& b, const Weight<D, F>& wa,
                                    const Weight<D, F>& wb, const F& along, const Tilt<D, F>& tilt) {
    const Vec<D, F> p = along * c.normal;
    a.v -= each(wa.mass, p);
    b.v += each(wb.mass, p);
    a.w = a.w - wa.inertia * from_tilt(frame, Tilt<D, F>(lever(c.arm_a) * along + tilt));
    b.w = b.w + wb.inertia * from_tilt(frame, Tilt<D, F>(lever(c.arm_b) * along + tilt));
}

/// One pass over the normal rows. A gap is left to close by itself (the bias lets the bodies approach just so
/// far), an overlap is pushed apart softly if `biased`.
template <bool biased, int D, class F>
CAROM_INLINE void solve_normals(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                const Weight<D, F>& wa, const Weight<D, F>& wb, const SubStep<F>& sub,
                                Extras extras = all_extras) {
    const ContactFrame<D, F> frame = frame_of(c);
    const Opening<D, F> opening(c, frame, a, b, extras.roundness);
    const Response<D, F> response = response_of(c, wa, wb);
    const Tilt<D, F> tilt_a = tilt_of(frame, a.w), tilt_b = tilt_of(frame, b.w);
    Tilt<D, F> tilt = tilt_b - tilt_a;
    F speed =
        dot(c.normal, b.v - a.v) + (tilt_dot(tilt_b, lever(c.arm_b)) - tilt_dot(tilt_a, lever(c.arm_a)));
    const auto firm = c.firm > F(0);
    const F push_rate =
        select(firm, sub.firm.mass_scale * sub.firm.bias_rate, sub.soft.mass_scale * sub.soft.bias_rate);
    const F mass_scale = select(firm, sub.firm.mass_scale, sub.soft.mass_scale);
    const F impulse_scale = select(firm, sub.firm.impulse_scale, sub.soft.impulse_scale);
    F along = F(0);
    Tilt<D, F> aside{};
    for (NormalRow<D, F>& p : c.points) {
        const F now = p.separation + opening.at(p);
        // Before positions are integrated the lead lies ahead; after it, the way still lacks the lead.
        const F next_gap = now + c.lead;
        const auto apart = (biased ? now : next_gap) > F(0);
        const F old = p.impulse;
        F bias, scale, keep = F(0);
        if constexpr (biased) {
            bias = select(apart, next_gap * sub.inverse_length, maximum(push_rate * now, -sub.push_speed));
            scale = select(apart, F(1), mass_scale);
            keep = select(apart, F(0), impulse_scale);
        } else {
            // A gap that is still open after this sub-step is the business of the next one, unless it is as
            // small as rounding leaves it: of a face that lands flat, all corners are to stop together.
            scale = select(next_gap > F(closed_gap), select(old > F(0), F(1), F(0)), F(1));
            bias = select(apart, scale * next_gap * sub.inverse_length, F(0));
        }
        const Tilt<D, F> l = lever(p.place);
        F next = old - p.mass * (scale * (speed + tilt_dot(tilt, l)) + bias);
        if constexpr (biased) next = next - keep * old;
        next = maximum(next, F(0));
        const F change = next - old;
        p.impulse = next;
        speed = speed + change * (response.straight + tilt_dot(response.mixed, l));
        tilt = tilt + (response.mixed + response.turning * l) * change;
        along = along + change;
        aside = aside + l * change;
    }
    push_along_normal(c, frame, a, b, wa, wb, along, aside);
}

/// Coulomb friction in the middle of the contact: |tangential impulse| ≤ μ · normal impulse. It works towards
/// the speed at which the surfaces move along with one another. In 3D the two
/// tangential components are solved together and cut back to the circle, so friction is a cone.
template <class F>
CAROM_INLINE void solve_patch(ContactRows<2, F>& c, Motion<2, F>& a, Motion<2, F>& b, const Weight<2, F>& wa,
                              const Weight<2, F>& wb, F normal_impulse, Extras extras = all_extras) {
    const Vec<2, F> t = tangents<2>(c.normal)[0];
    F speed = dot(t, b.v - a.v) + (b.w * c.arm_b.x - a.w * c.arm_a.x);
    if (extras.belts) speed = speed + c.surface_speed[0];
    const F limit = c.friction * normal_impulse;
    const F old = c.friction_impulse[0];
    const F next = maximum(-limit, minimum(limit, old - c.patch_mass[0] * speed));
    c.friction_impulse[0] = next;
    const F change = next - old;
    const Vec<2, F> p = change * t;
    a.v -= each(wa.mass, p);
    b.v += each(wb.mass, p);
    a.w = a.w - wa.inertia * (c.arm_a.x * change);
    b.w = b.w + wb.inertia * (c.arm_b.x * change);
}

/// The torque of the impulse that has these components along the tangents, about the other end of the arm.
template <class F>
CAROM_INLINE Vec<3, F> torque_across(const Vec<3, F>& arm, const F& first, const F& second) {
    return {arm.y * second - arm.z * first, -(arm.x * second), arm.x * first};
}

template <class F>
CAROM_INLINE void solve_patch(ContactRows<3, F>& c, Motion<3, F>& a, Motion<3, F>& b, const Weight<3, F>& wa,
                              const Weight<3, F>& wb, F normal_impulse, Extras extras = all_extras) {
    const ContactFrame<3, F> frame = frame_of(c);
    const auto& [t1, t2] = frame.tangents;
    const Vec<3, F> v = b.v - a.v;
    const Vec<3, F> turning = cross(to_frame(frame, b.w), c.arm_b) - cross(to_frame(frame, a.w), c.arm_a);
    F v1 = dot(t1, v) + turning.y, v2 = dot(t2, v) + turning.z;
    if (extras.belts) {
        v1 = v1 + c.surface_speed[0];
        v2 = v2 + c.surface_speed[1];
    }
    const F old1 = c.friction_impulse[0], old2 = c.friction_impulse[1];
    F next1 = old1 - (c.patch_mass[0] * v1 + c.patch_mass[1] * v2);
    F next2 = old2 - (c.patch_mass[1] * v1 + c.patch_mass[2] * v2);
    const F limit = c.friction * normal_impulse;
    const F squared = next1 * next1 + next2 * next2;
    const auto slips = squared > limit * limit;
    if (any(slips)) {
        const F cut = select(slips, limit / square_root(select(slips, squared, F(1))), F(1));
        next1 = next1 * cut;
        next2 = next2 * cut;
    }
    c.friction_impulse = {next1, next2};
    const F change1 = next1 - old1, change2 = next2 - old2;
    const Vec<3, F> impulse = change1 * t1 + change2 * t2;
    a.v -= each(wa.mass, impulse);
    b.v += each(wb.mass, impulse);
    a.w -= wa.inertia * from_frame(frame, torque_across(c.arm_a, change1, change2));
    b.w += wb.inertia * from_frame(frame, torque_across(c.arm_b, change1, change2));

    // Friction against twisting about the normal: each point resists at its lever.
    F limit_twist = F(0);
    for (const NormalRow<3, F>& p : c.points) limit_twist = limit_twist + p.lever * p.impulse;
    limit_twist = c.friction * limit_twist;
    const F spin = dot(c.normal, b.w - a.w);
    const F old = c.twist_impulse;
    c.twist_impulse = maximum(-limit_twist, minimum(limit_twist, old - c.twist_mass * spin));
    twist(a, b, wa, wb, (c.twist_impulse - old) * c.normal);
}

/// Rolling resistance: the angular impulse that stops the relative spin, at most rolling · normal impulse.
template <int D, class F>
CAROM_INLINE void solve_rolling(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                const Weight<D, F>& wa, const Weight<D, F>& wb, F normal_impulse) {
    const Angular<D, F> old = c.rolling_impulse;
    Angular<D, F> next = old - c.rolling_mass * (b.w - a.w);
    const F limit = c.rolling * normal_impulse;
    const F squared = angular_dot(next, next);
    const auto over = squared > limit * limit;
    next = next * select(over, limit / square_root(select(over, squared, F(1))), F(1));
    c.rolling_impulse = next;
    twist(a, b, wa, wb, Angular<D, F>(next - old));
}

/// Friction and rolling resistance, after the normal rows.
template <int D, class F>
CAROM_INLINE void solve_friction(ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                                 const Weight<D, F>& wa, const Weight<D, F>& wb, Extras extras = all_extras) {
    F normal_impulse = F(0);
    for (const NormalRow<D, F>& p : c.points) normal_impulse = normal_impulse + p.impulse;
    if (extras.rolling) solve_rolling(c, a, b, wa, wb, normal_impulse);
    solve_patch(c, a, b, wa, wb, normal_impulse, extras);
}

/// The vector with these components along the tangents.
template <int D, class F>
CAROM_INLINE Vec<D, F> along_tangents(const ContactRows<D, F>& c, const std::array<F, D - 1>& components) {
    const auto t = frame_of(c).tangents;
    Vec<D, F> sum = components[0] * t[0];
    if constexpr (D == 3) sum += components[1] * t[1];
    return sum;
}

/// Applies the impulses that the rows hold.
template <int D, class F>
CAROM_INLINE void warm_start(const ContactRows<D, F>& c, Motion<D, F>& a, Motion<D, F>& b,
                             const Weight<D, F>& wa, const Weight<D, F>& wb, Extras extras = all_extras) {
    const ContactFrame<D, F> frame = frame_of(c);
    F along = F(0);
    Tilt<D, F> aside{};
    for (const NormalRow<D, F>& p : c.points) {
        along = along + p.impulse;
        aside = aside + lever(p.place) * p.impulse;
    }
    push_along_normal(c, frame, a, b, wa, wb, along, aside);
    push(a, b, wa, wb, from_frame(frame, c.arm_a), from_frame(frame, c.arm_b),
         along_tangents(c, c.friction_impulse));
    if (extras.rolling) twist(a, b, wa, wb, c.rolling_impulse);
    if constexpr (D == 3) twist(a, b, wa, wb, c.twist_impulse * c.normal);
}

}  // namespace carom::detail
