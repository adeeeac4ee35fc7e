#include <algorithm>
#include <cmath>

#include "geometry/terrain.hpp"
#include "math/trig.hpp"
#include "world/meeting.hpp"
#include "world/state.hpp"

// Continuous collision: what is fast meets what is in its way, at any speed and spin.

namespace carom::detail {

namespace {

/// Where a body will be after `time` seconds if only gravity acts on it.
template <int D>
BodyState<D> coasted(BodyState<D> s, const BodyMass<D>& m, const Vec<D>& gravity, double time) {
    if (m.inverse_mass == 0 && s.velocity == Vec<D>{} && s.angular_velocity == Angular<D>{}) return s;
    s.position += time * s.velocity;
    if (m.inverse_mass > 0) s.position += (0.5 * time * time * m.gravity_scale) * gravity;
    turn<D>(s, s.angular_velocity * time);
    return s;
}

/// The turn that leads from one state to the other: an angle, whole turns included, or the shortest rotation
/// vector.
double turn_between(const BodyState<2>& from, const BodyState<2>& to) {
    return whole_angle(to) - whole_angle(from);
}
Vec3 turn_between(const BodyState<3>& from, const BodyState<3>& to) {
    Rotation3 q = to.rotation * inverse(from.rotation);
    if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
    const Vec3 axis{q.x, q.y, q.z};
    const double sine = length(axis);
    return sine > 0 ? (2 * atan2(sine, q.w) / sine) * axis : Vec3{};
}

/// The motion of a body through the step, as a straight way and a steady turn.
template <int D>
struct StepMotion {
    const BodyState<D>& start;
    Vec<D> way;
    Angular<D> turned;

    StepMotion(const BodyState<D>& from, const BodyState<D>& to)
        : start(from), way(to.position - from.position), turned(turn_between(from, to)) {}
    BodyState<D> at(double share) const {
        BodyState<D> s = start;
        s.position += share * way;
        turn<D>(s, turned * share);
        return s;
    }
    double turn_speed() const { return std::sqrt(angular_dot(turned, turned)); }
};

/// What stands still, or moves, in the way of a body.
template <int D>
struct Obstacle {
    const Shape<D>& shape;
    std::uint32_t facet;
    StepMotion<D> sweep;
    const BodyMass<D>& mass;
};

/// When a shape meets an obstacle, as a share of the step, and the direction from the obstacle to the shape.
template <int D>
struct Meeting {
    double share;
    Vec<D> axis;
};

/// The share of the step after which the shape is as near to the obstacle as `near`, by conservative
/// advancement; nothing when it never is. One that is nearer from the start meets the obstacle at once if it
/// ends deeper or on the other side.
template <int D>
std::optional<Meeting<D>> first_meeting(const Shape<D>& shape, const BodyMass<D>& mass,
                                        const StepMotion<D>& sweep, const Obstacle<D>& obstacle,
                                        double near) {
    constexpr int most_advances = 128;
    const double turning =
        sweep.turn_speed() * mass.radius + obstacle.sweep.turn_speed() * obstacle.mass.radius;
    const auto gap_at = [&](double share) {
        const BodyState<D> there = obstacle.sweep.at(share), here = sweep.at(share);
        auto gap = gap_between<D>(obstacle.shape, shape, obstacle.facet,
                                  relative(frame(there, obstacle.mass), frame(here, mass)));
        if (gap) gap->axis = rotate(there.rotation, gap->axis);
        return gap;
    };
    double share = 0;
    for (int i = 0;; ++i) {
        const auto gap = gap_at(share);
        if (!gap) return std::nullopt;
        if (gap->distance <= near || i == most_advances) {
            if (i > 0) return Meeting<D>{share, gap->axis};
            const auto end = gap_at(1);
            const bool stays_out =
                end && dot(end->axis, gap->axis) > 0 && end->distance > gap->distance - near;
            return stays_out ? std::nullopt : std::optional(Meeting<D>{0, gap->axis});
        }
        const double closing = turning - dot(gap->axis, sweep.way - obstacle.sweep.way);
        if (closing <= 0) return std::nullopt;
        share += (gap->distance - 0.5 * near) / closing;
        if (share >= 1) return std::nullopt;
    }
}

/// Is a ball sure to come nowhere near the facet, which stands still, on its way from `first` to `last`? Its
/// middle leaves the line between them by no more than `bow`. A facet that is not two-sided meets nothing
/// whose middle starts behind it.
template <int D>
bool passes_by(const Facet<D>& facet, const Vec<D>& first, const Vec<D>& last, double near, double bow) {
    const double reach = near + bow;
    bool beside = false;
    for (int i = 0; i < D; ++i) {
        double lowest = facet.points[0][i], highest = lowest;
        for (int k = 1; k < D; ++k) {
            lowest = std::min(lowest, facet.points[k][i]);
            highest = std::max(highest, facet.points[k][i]);
        }
        beside |=
            std::min(first[i], last[i]) - reach > highest || std::max(first[i], last[i]) + reach < lowest;
    }
    if (beside) return true;
    const Vec<D> normal = facet.normal();
    const double at_first = dot(normal, first - facet.points[0]),
                 at_last = dot(normal, last - facet.points[0]);
    if (at_first < 0) return !facet.two_sided || std::max(at_first, at_last) < -reach;
    return std::min(at_first, at_last) > reach;
}

}  // namespace

/// The contacts with fixed shapes of all bodies that came far in this step, in the order of bodies and
/// shapes.
template <int D>
void WorldState<D>::list_fast_contacts() {
    fast.clear();
    fixed_contacts.clear();
    if (trees[of_fixed].size() == 0) return;
    for (std::size_t k = 0; k < awake.size(); ++k) {
        if ((outcomes[k] & went_far) && moving[awake[k]] == moves_freely) fast.push_back(awake[k]);
    }
    if (!std::ranges::is_sorted(fast)) std::ranges::sort(fast);
    if (fast.empty()) return;
    for (const std::uint32_t body : fast) {
        const std::size_t first = fixed_contacts.size();
        each_contact_of(body, true, [&](std::uint32_t contact) { list_fixed_contact(contact); });
        // What came no further than foreseen is still in its box, and all that this meets are its pairs.
        if (outcomes[place[body]] & went_astray) list_strays(body);
        sort_fixed_contacts(first);
    }
}

/// A blow may throw a body to where its fat box does not reach, past shapes with which it is no pair. Lists
/// the fixed ones in the way of its cores; one-way shapes let pass whom they did not see come.
template <int D>
void WorldState<D>::list_strays(std::uint32_t body) {
    const Transform<D> start = frame(before[place[body]], masses[body]), end = frame_of(body);
    for (const ShapeId<D>& id : infos[body].shapes) {
        const ShapeRecord<D>& own = shapes[id.index];
        const auto way_in = [&](const Transform<D>& placed) {
            const Vec<D> first = apply_inverse(placed, apply(start, own.core()));
            const Vec<D> last = apply_inverse(placed, apply(end, own.core()));
            Aabb<D> box;
            for (int i = 0; i < D; ++i) {
                box.lower[i] = std::min(first[i], last[i]) - own.core_radius();
                box.upper[i] = std::max(first[i], last[i]) + own.core_radius();
            }
            return box;
        };
        // Within the fat box all that it may meet are its pairs.
        const Aabb<D> way = way_in({});
        if (contains(fat_boxes[id.index], way)) continue;
        const auto add = [&](std::uint32_t other, std::uint32_t facet) {
            if (!pairs.contains(PairKey::of(id.index, other, facet)))
                fixed_contacts.push_back({body, id.index, other, facet, ContactRecord<D>::nowhere});
        };
        trees[of_fixed].query(OuterBox<D>(way), [&](std::uint32_t other) {
            const ShapeRecord<D>& obstacle = shapes[other];
            const bool blocks = !company[id.index].senses && !company[other].senses &&
                                !obstacle.definition().one_way && may_meet(id.index, other);
            if (!blocks) return;
            if (obstacle.shape().kind != ShapeKind::terrain) return add(other, no_part);
            obstacle.shape().terrain->query(way_in(frame_of(obstacle.body)),
                                            [&](std::uint32_t facet) { add(other, facet); });
        });
    }
}

/// The solver keeps to the points where bodies first meet; what a body does after that within the step, as it
/// spins off from there, it does unseen. So where the core of a fast body would have passed through a fixed
/// shape, or that of a bullet through anything, the body is stopped where it met that. Its velocity stays,
/// and the next step goes on from there.
template <int D>
void WorldState<D>::stop_at_obstacles() {
    if (!definition.continuous) return;
    // A one-way shape lets pass what goes out of its open side.
    const auto lets_pass = [&](const ContactRecord<D>& c, std::uint32_t body, std::uint32_t shape) {
        if (!c.special || !shapes[shape].definition().one_way) return false;
        const Vec<D> way = states[body].position - before[place[body]].position;
        return c.passing || dot(way, rotate(axes_of(shape), *shapes[shape].definition().one_way)) >= 0;
    };
    list_fast_contacts();
    for (const FixedContact& f : fixed_contacts) {
        const bool seen = f.contact != ContactRecord<D>::nowhere;
        if (!seen || !lets_pass(contacts[f.contact], f.body, f.other))
            stop_at(f.body, f.shape, f.other, f.facet);
    }
    if (bullets > 0) stop_bullets();
}

template <int D>
void WorldState<D>::stop_bullets() {
    for (const std::uint32_t body : awake) {
        if (!infos[body].bullet) continue;
        each_contact_of(body, false, [&](std::uint32_t contact) { picked.push_back(contact); });
    }
    std::ranges::sort(picked);
    picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
    for (const std::uint32_t contact : picked) {
        const ContactRecord<D>& c = contacts[contact];
        if (c.passing) continue;
        if (infos[c.body_a].bullet) stop_at(c.body_a, c.shape_a, c.shape_b, c.facet);
        if (infos[c.body_b].bullet) stop_at(c.body_b, c.shape_b, c.shape_a, c.facet);
    }
    picked.clear();
}

template <int D>
void WorldState<D>::stop_at(std::uint32_t body, std::uint32_t shape, std::uint32_t other,
                            std::uint32_t facet) {
    if (moving[body] != moves_freely || infos[body].disabled) return;
    const auto earlier = [&](std::uint32_t i) -> const BodyState<D>& {
        return moving[i] == stands_still ? states[i] : before[place[i]];
    };
    const BodyMass<D>& mass = masses[body];
    const BodyState<D>& start = earlier(body);
    const ShapeRecord<D>& own = shapes[shape];
    const Vec<D> first = apply(frame(start, mass), own.core());
    const Vec<D> last = apply(frame_of(body), own.core());
    const std::uint32_t other_body = shapes[other].body;
    const bool stands = moving[other_body] == stands_still;
    // How far the core came as seen from the obstacle.
    const Transform<D> now = frame_of(other_body),
                       before_step = stands ? now : frame(earlier(other_body), masses[other_body]);
    const Vec<D> seen_first = apply_inverse(before_step, first), seen_last = apply_inverse(now, last);
    if (length(seen_last - seen_first) <= seen_share * own.core_radius()) return;

    const StepMotion<D> sweep(start, states[body]);
    const double near_core = 1e-3 * own.core_radius();
    const Shape<D>& others = shapes[other].shape();
    if (stands && others.kind == ShapeKind::terrain) {
        // A point that turns steadily by w at the distance r is within w² r / 8 of the line that it would
        // follow if it went straight.
        const double turn = sweep.turn_speed(), bow = 0.125 * turn * turn * length(own.core() - mass.center);
        if (passes_by(others.terrain->facet(facet), seen_first, seen_last, own.core_radius() + 2 * near_core,
                      bow))
            return;
    }
    const Obstacle<D> obstacle{others, facet, StepMotion<D>(earlier(other_body), states[other_body]),
                               masses[other_body]};
    Shape<D> core;
    core.a = own.core();
    core.radius = own.core_radius();
    const auto passes = first_meeting(core, mass, sweep, obstacle, near_core);
    if (!passes) return;
    const double near = std::min(0.5 * speculative_distance, 0.2 * own.core_radius());
    const auto meets = first_meeting(own.shape(), mass, sweep, obstacle, near);
    if (meets && meets->share > 0) {
        const BodyState<D> stopped = sweep.at(std::min(meets->share, passes->share));
        states[body].position = stopped.position;
        states[body].rotation = stopped.rotation;
        states[body].turns = stopped.turns;
        outcomes[place[body]] |= was_stopped;
        return;
    }
    // It touched from the start, so there is no going back: it turns as it did, and its core stays outside.
    const Transform<D> then = frame(obstacle.sweep.at(passes->share), obstacle.mass);
    const auto carried = [&](const Vec<D>& v) { return rotate(now.rotation, unrotate(then.rotation, v)); };
    const Vec<D> there = apply(frame(sweep.at(passes->share), mass), own.core());
    const Vec<D> axis = carried(passes->axis);
    const double inwards = dot(axis, now.position + carried(there - then.position) - last);
    if (inwards <= 0) return;
    states[body].position += inwards * axis;
    outcomes[place[body]] |= was_stopped;
}

/// Bodies that are apart and may meet within the step are moved on to where they first come near
/// (conservative advancement, Mirtich 1996): the gap divided by a bound on its rate of closing is a time in
/// which they cannot meet. Along an axis that held them apart before, the gap costs little and bounds the
/// whole; only where it closes is a better axis looked for. The points found at last are given the gaps that
/// they have now, so the solver stops the bodies at the right place, along the right normal, however fast
/// they are; and bodies that pass one another do not touch.
template <int D>
void WorldState<D>::meet_ahead(ContactRecord<D>& c, const ContactCache<D>& cache, double dt) const {
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const Shape<D>&shape_a = shapes[c.shape_a].shape(), &shape_b = shapes[c.shape_b].shape();
    const double turning = turning_speed(sa, ma) + turning_speed(sb, mb) + length(definition.gravity) * dt;
    const Vec<D> speed = sb.velocity - sa.velocity;
    constexpr double near = 0.5 * speculative_distance;
    constexpr int most_advances = 32;
    double elapsed = 0;
    BodyState<D> a = sa, b = sb;
    Vec<D> axis = narrow<double>(cache.normal);
    const double least_gap = cache.least_gap(RelativePose<D>(sa, sb), mb.radius);
    if (least_gap - 0.5 * near > dt * (turning - dot(rotate(sa.rotation, axis), speed))) return;
    for (int i = 0; i < most_advances; ++i) {
        // At the start the bound may do.
        Transform<D> b_in_a;
        double distance = least_gap;
        if (i > 0 || distance <= near) {
            if (i > 0) {
                a = coasted(sa, ma, definition.gravity, elapsed);
                b = coasted(sb, mb, definition.gravity, elapsed);
            }
            b_in_a = relative(frame(a, ma), frame(b, mb));
            distance = least_gap_between<D>(shape_a, shape_b, c.facet, b_in_a, axis);
        }
        const bool last = i + 1 == most_advances;
        if (distance <= near || last) {
            const auto gap = gap_between<D>(shape_a, shape_b, c.facet, b_in_a);
            if (!gap) return;
            if (gap->distance <= near || last) {
                ContactCache<D> then;
                touch(c, a, b, speculative_distance, then);
                set_points(then, a, b, speculative_distance, c);
                break;
            }
            axis = gap->axis;
            distance = gap->distance;
        }
        const double closing = turning - dot(rotate(a.rotation, axis), speed);
        if (closing <= 0) return;
        elapsed += (distance - 0.5 * near) / closing;
        if (elapsed > dt) return;
    }
    for (int i = 0; i < c.count; ++i) {
        ContactRecordPoint<D>& p = c.points[i];
        const Vec<D> arm_a = narrow<double>(p.arm_a), arm_b = narrow<double>(p.arm_b);
        const Vec<D> turned =
            elapsed * (cross(sb.angular_velocity, arm_b) - cross(sa.angular_velocity, arm_a));
        const Vec<D> way = (b.position - sb.position) - (a.position - sa.position) + turned;
        p.separation -= static_cast<float>(dot(narrow<double>(c.normal), way));
    }
}

#define CAROM_INSTANTIATE(D)                                                                          \
    template void WorldState<D>::meet_ahead(ContactRecord<D>&, const ContactCache<D>&, double) const; \
    template void WorldState<D>::stop_at_obstacles();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
