#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/manifold.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {}  // namespace

template <int D>
ShapePair<D> WorldState<D>::names(std::uint32_t shape_a, std::uint32_t shape_b) const {
    return {body_slots.template id<BodyId<D>>(shapes[shape_a].body),
            body_slots.template id<BodyId<D>>(shapes[shape_b].body),
            shape_slots.template id<ShapeId<D>>(shape_a), shape_slots.template id<ShapeId<D>>(shape_b)};
}

/// The contacts that began or ended to touch, in their order. Contacts of bodies that stand still stay as
/// they are.
template <int D>
void WorldState<D>::report_contacts() {
    events.clear();
    std::swap(events.contact_ends, dropped_contacts);
    touch_changes.clear();
    solver.report(scheduler.get(), [&](std::uint32_t i) {
        solver.read(caches[i], contacts[i]);
        touch_changes.push_back(i);
    });
    for (const std::uint32_t i : loose) {
        if (i == ContactRecord<D>::nowhere || contacts[i].place) continue;
        ContactRecord<D>& c = contacts[i];
        const bool touches = c.merged && c.nearest <= parting_distance;
        if (touches != c.touching) touch_changes.push_back(i);
        c.touching = touches;
    }
    std::ranges::sort(touch_changes);
    for (const std::uint32_t i : touch_changes) {
        const ContactRecord<D>& c = contacts[i];
        if (c.facet != no_part) continue;
        if (c.touching)
            report_begin(c);
        else
            events.contact_ends.push_back({names(c.shape_a, c.shape_b)});
    }
    report_terrain();
}

/// A shape touches a terrain as long as it touches any of its facets.
template <int D>
void WorldState<D>::report_terrain() {
    std::swap(terrain_before, terrain_touched);
    terrain_touched.clear();
    for (std::uint32_t i = 0; i < contacts.size() && facet_contacts > 0; ++i) {
        const ContactRecord<D>& c = contacts[i];
        if (c.touching && c.facet != no_part) terrain_touched.push_back({names(c.shape_a, c.shape_b), i});
    }
    const auto by_shapes = [](const TerrainTouch<D>& one, const TerrainTouch<D>& other) {
        const auto key = [](const TerrainTouch<D>& t) {
            return std::tuple(t.pair.shape_a.index, t.pair.shape_a.generation, t.pair.shape_b.index,
                              t.pair.shape_b.generation);
        };
        return key(one) < key(other);
    };
    std::ranges::stable_sort(terrain_touched, by_shapes);
    const auto same = [](const TerrainTouch<D>& one, const TerrainTouch<D>& other) {
        return one.pair == other.pair;
    };
    terrain_touched.erase(std::unique(terrain_touched.begin(), terrain_touched.end(), same),
                          terrain_touched.end());
    const auto missing_in = [&](const std::vector<TerrainTouch<D>>& list, const TerrainTouch<D>& touch) {
        return !std::ranges::binary_search(list, touch, by_shapes);
    };
    for (const TerrainTouch<D>& touch : terrain_touched) {
        if (missing_in(terrain_before, touch)) report_begin(current(touch.contact));
    }
    for (const TerrainTouch<D>& touch : terrain_before) {
        if (missing_in(terrain_touched, touch)) events.contact_ends.push_back({touch.pair});
    }
}

/// The work that a contact did on the two bodies is, of each of its impulses, the impulse times the mean of
/// the relative velocities before and after (both bodies' energies are quadratic in their velocities).
template <int D>
void WorldState<D>::report_begin(const ContactRecord<D>& c) {
    const auto earlier = [&](std::uint32_t body) -> const BodyState<D>& {
        return moving[body] == stands_still ? states[body] : before[place[body]];
    };
    const auto relative_speed = [&](const BodyState<D>& one, const BodyState<D>& other,
                                    const ContactRecordPoint<D>& at) {
        return other.velocity + cross(other.angular_velocity, narrow<double>(at.arm_b)) - one.velocity -
               cross(one.angular_velocity, narrow<double>(at.arm_a));
    };
    const Vec<D> normal = narrow<double>(c.normal);
    const BodyState<D>&a0 = earlier(c.body_a), &b0 = earlier(c.body_b);
    const Vec<D> pull =
        (masses[c.body_b].inverse_mass > 0 ? masses[c.body_b].gravity_scale : 0.0) * definition.gravity -
        (masses[c.body_a].inverse_mass > 0 ? masses[c.body_a].gravity_scale : 0.0) * definition.gravity;
    ContactHit<D> hit{};
    static_cast<ShapePair<D>&>(hit) = names(c.shape_a, c.shape_b);
    hit.normal = normal;
    Vec<D> friction_speed{};
    // A contact that another keeps the points of still has its own first point.
    const int count = c.merged ? 1 : c.count;
    for (int i = 0; i < count; ++i) {
        const ContactRecordPoint<D>& p = c.points[i];
        const Vec<D> first = relative_speed(a0, b0, p);
        const Vec<D> last = relative_speed(states[c.body_a], states[c.body_b], p);
        // On the way through the gap s the speed grows to √(v² + 2 a s).
        const double closing = std::max(0.0, -dot(first, normal));
        const double gained = -2 * dot(pull, normal) * std::max(0.0, static_cast<double>(p.separation));
        const double approach = std::sqrt(std::max(0.0, closing * closing + gained));
        if (i == 0 || approach > hit.approach_speed) {
            hit.approach_speed = approach;
            hit.point = states[c.body_a].position + narrow<double>(p.arm_a);
        }
        const double leaving = dot(last, normal);
        hit.impulse += p.total_impulse;
        hit.energy_lost += 0.5 * p.total_impulse * (approach - leaving);
        friction_speed += (0.5 / count) * (first + last);
    }
    hit.energy_lost -= dot(narrow<double>(c.total_friction), friction_speed);
    events.contact_begins.push_back({hit, hit.point, normal});
    if (hit.approach_speed > definition.hit_speed) events.contact_hits.push_back(hit);
}

template <int D>
bool WorldState<D>::overlap(std::uint32_t shape_a, std::uint32_t shape_b) const {
    const ShapeRecord<D>&a = shapes[shape_a], &b = shapes[shape_b];
    const auto gap = separate_shapes<D>(a.shape, b.shape, relative(frame_of(a.body), frame_of(b.body)));
    return gap && gap->distance <= 0;
}

/// Who is inside the sensors now. Where neither the sensor nor the visitor moved, nothing changed.
template <int D>
void WorldState<D>::sense() {
    std::swap(events.sensor_ends, dropped_visits);
    for (SensorPair& pair : sensor_pairs) {
        const std::uint32_t a = shapes[pair.sensor].body, b = shapes[pair.visitor].body;
        if (!any_moves(a, b) && !pair.placed_anew) continue;
        pair.placed_anew = false;
        const bool was_inside = pair.inside;
        pair.inside = !infos[a].disabled && !infos[b].disabled && overlap(pair.sensor, pair.visitor);
        if (pair.inside && !was_inside) events.sensor_begins.push_back({names(pair.sensor, pair.visitor)});
        if (!pair.inside && was_inside) events.sensor_ends.push_back({names(pair.sensor, pair.visitor)});
    }
}

#define CAROM_INSTANTIATE(D)                                                        \
    template ShapePair<D> WorldState<D>::names(std::uint32_t, std::uint32_t) const; \
    template void WorldState<D>::report_contacts();                                 \
    template void WorldState<D>::sense();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
