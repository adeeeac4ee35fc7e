#pragma once

#include "dynamics/contact.hpp"
#include "dynamics/contact_cache.hpp"
#include "solver/apart.hpp"
#include "solver/lane_manifold.hpp"
#include "solver/marks.hpp"

/// Manifolds that are no longer good, made anew where they lie: in the lanes of the contacts. What
/// WorldState::update_contact does one by one for any two shapes is done here for those of `LaneShapes`.
namespace carom::detail {

/// A double as the sum of two floats, in the lanes of the mask.
template <class F, class Mask>
CAROM_INLINE void split(const Wide<F>& value, F& first, F& rest, Mask mask) {
    const F head(value);
    rest = select(mask, F(value - Wide<F>(head)), rest);
    first = select(mask, head, first);
}

/// Gives the points of the manifold the impulses that the rows and marks had: to those with the same feature,
/// then to the nearest (see `carry_impulses`). The result tells the lanes in which the contact goes on.
template <class F>
CAROM_INLINE auto carried_impulses(const ContactRows<2, F>& rows, const ContactMarks<2, F>& marks,
                                   const LaneManifold<F>& m, const Rotation<2, F>& axes,
                                   const Vec<2, F>& between, F near, std::array<F, 2>& impulses) {
    using Mask = decltype(near > near);
    std::array<Mask, 2> left{rows.points[0].mass > F(0), rows.points[1].mass > F(0)};
    std::array<Mask, 2> found{F(0) > F(0), F(0) > F(0)};
    impulses = {F(0), F(0)};
    const auto take = [&](int i, int k, Mask mask) {
        impulses[i] = select(mask, rows.points[k].impulse, impulses[i]);
        found[i] = either(found[i], mask);
        left[k] = both(left[k], !mask);
    };
    for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 2; ++k) {
            const auto same = !(fabs(marks.points[k].feature - m.points[i].feature) > F(0));
            take(i, k, both(both(m.points[i].used > F(0.5f), !found[i]), both(left[k], same)));
        }
    }
    for (int i = 0; i < 2; ++i) {
        const Vec<2, F> arm_a = rotate(axes, m.points[i].position), arm_b = arm_a - between;
        const auto square = [&](int k) {
            const auto known = F(unknown_place) > marks.points[k].on_a.x;
            const Vec<2, F> on_a = detail::arm_a(rows, rows.points[k]) - arm_a,
                            on_b = detail::arm_b(rows, rows.points[k]) - arm_b;
            return select(both(left[k], known), minimum(dot(on_a, on_a), dot(on_b, on_b)), F(1e30f));
        };
        const std::array<F, 2> squares{square(0), square(1)};
        const auto open = both(m.points[i].used > F(0.5f), !found[i]);
        const auto second = squares[0] > squares[1];
        take(i, 0, both(both(open, !second), !(squares[0] > near * near)));
        take(i, 1, both(both(open, second), !(squares[1] > near * near)));
    }
    return either(found[0], found[1]);
}

/// Carries the outline from its own frame into another.
template <class F>
CAROM_INLINE void put(LaneOutline<F>& outline, const Vec<2, F>& place, const Rotation<2, F>& turn) {
    for (int i = 0; i < outline.n; ++i) {
        outline.corners[i] = place + rotate(turn, outline.corners[i]);
        outline.normals[i] = rotate(turn, outline.normals[i]);
    }
}

/// How b lies relative to a.
template <class F>
struct LaneRelative {
    Vec<2, Wide<F>> place{};
    Rotation<2, Wide<F>> turn{};

    CAROM_INLINE LaneRelative(const Pose<2, F>& a, const Pose<2, F>& b)
        : place(unrotate(a.rotation, Vec<2, Wide<F>>(b.position - a.position))),
          turn(inverse(a.rotation) * b.rotation) {}

    /// As what the marks have been taken at, in the lanes of the mask.
    template <class Marks, class Mask>
    CAROM_INLINE void keep(Marks& marks, Mask mask) const {
        split(place.x, marks.place.x, marks.place_rest.x, mask);
        split(place.y, marks.place.y, marks.place_rest.y, mask);
        split(turn.c, marks.turn.c, marks.turn_rest.c, mask);
        split(turn.s, marks.turn.s, marks.turn_rest.s, mask);
    }
};

/// Looks for what holds the `wanted` pairs apart now. Those that are within reach of each other keep what
/// they had. b's outline comes in its own frame.
template <class F, class Mask>
CAROM_INLINE void look_again(ApartMarks<2, F>& marks, const Pose<2, F>& a, const Pose<2, F>& b,
                             const LaneOutline<F>& outline_a, LaneOutline<F>& outline_b, Mask wanted,
                             F reach) {
    const LaneRelative<F> relative(a, b);
    put(outline_b, {F(relative.place.x), F(relative.place.y)}, narrowed<F>(relative.turn));
    const LaneProximity<F> near = proximity(outline_a, outline_b);
    const F gap = near.distance - outline_a.radius - outline_b.radius;
    const Mask apart = both(wanted, gap > reach);
    relative.keep(marks, apart);
    marks.normal = selected(apart, near.axis, marks.normal);
    marks.gap = select(apart, gap, marks.gap);
}

/// Makes the manifold of the `wanted` lanes anew, for bodies that are at `a` and `b`. The result tells the
/// lanes in which that was done: those that have points within reach. b's outline comes in its own frame.
template <class F, class Mask>
CAROM_INLINE Mask remake(ContactRows<2, F>& rows, ContactMarks<2, F>& marks, const Pose<2, F>& a,
                         const Pose<2, F>& b, const LaneOutline<F>& outline_a, LaneOutline<F>& outline_b,
                         Mask wanted, F reach) {
    const LaneRelative<F> relative(a, b);
    const Rotation<2, F> axes = narrowed<F>(a.rotation), axes_b = narrowed<F>(relative.turn);
    const Vec<2, F> b_in_a{F(relative.place.x), F(relative.place.y)};
    const Vec<2, Wide<F>> apart = b.position - a.position;
    const Vec<2, F> between{F(apart.x), F(apart.y)};
    put(outline_b, b_in_a, axes_b);
    const F radius = minimum(outline_a.body_radius, outline_b.body_radius);
    const F full_way = minimum(F(static_cast<float>(reuse_share)) * radius, F(static_cast<float>(reuse_way)));
    const LaneManifold<F> m = collide(outline_a, outline_b, reach + full_way);

    std::array<F, 2> impulses;
    const auto goes_on =
        carried_impulses(rows, marks, m, axes, between, F(static_cast<float>(near_share)) * radius, impulses);
    const auto in_reach = [&](int k) {
        return both(m.points[k].used > F(0.5f), !(m.points[k].separation > reach));
    };
    const Mask done = both(wanted, either(in_reach(0), in_reach(1)));

    const Vec<2, F> friction = along_tangents(rows, rows.friction_impulse);
    const ContactRows<2, F> before = rows;
    rows.normal = selected(done, rotate(axes, m.normal), rows.normal);
    const Vec<2, F> tangent = tangents<2>(rows.normal)[0];
    const F kept_friction = select(goes_on, dot(friction, tangent), F(0));
    rows.friction_impulse[0] = select(done, kept_friction, rows.friction_impulse[0]);
    rows.rolling_impulse = select(both(done, !goes_on), F(0), rows.rolling_impulse);

    relative.keep(marks, done);
    const auto of_b = m.is_of_b > F(0.5f);
    marks.normal = selected(done, selected(of_b, unrotate(axes_b, m.normal), m.normal), marks.normal);
    marks.is_of_b = select(done, m.is_of_b, marks.is_of_b);
    std::array<Vec<2, F>, 2> arms_a, arms_b;
    for (int k = 0; k < 2; ++k) {
        const auto& p = m.points[k];
        NormalRow<2, F>& row = rows.points[k];
        arms_a[k] = rotate(axes, p.position);
        arms_b[k] = arms_a[k] - between;
        row.separation = select(done, p.separation, row.separation);
        row.mass = select(done, select(in_reach(k), F(1), F(0)), row.mass);
        row.impulse = select(done, select(in_reach(k), impulses[k], F(0)), row.impulse);
        auto& mark = marks.points[k];
        mark.on_a = selected(done, p.position, mark.on_a);
        mark.on_b = selected(done, p.position - b_in_a, mark.on_b);
        mark.separation =
            select(done, select(p.used > F(0.5f), p.separation, F(no_separation)), mark.separation);
        mark.feature = select(done, p.feature, mark.feature);
    }
    place_points(rows, frame_of(rows), arms_a, arms_b);
    rows.arm_a = selected(done, rows.arm_a, before.arm_a);
    rows.arm_b = selected(done, rows.arm_b, before.arm_b);
    for (int k = 0; k < 2; ++k)
        rows.points[k].place = selected(done, rows.points[k].place, before.points[k].place);
    const auto is_round = outline_a.radius + outline_b.radius > F(0);
    const auto has_face = F(0.5f) > F(1) - m.is_of_a - m.is_of_b;
    const F way = select(has_face, full_way, full_way * F(reuse_without_face)), angle = way / radius;
    marks.way_squared = select(done, select(is_round, F(-1), way * way), marks.way_squared);
    marks.turn_squared = select(done, angle * angle, marks.turn_squared);
    marks.is_newer = select(done, F(1), marks.is_newer);
    return done;
}

}  // namespace carom::detail
