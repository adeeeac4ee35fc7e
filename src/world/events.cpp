#include <algorithm>
#include <cmath>
#include <tuple>

#include "collision/manifold.hpp"
#include "world/state.hpp"

namespace carom::detail {

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
    solver.report(scheduler.get(), [&](std::uint32_t i) { touch_changes.push_back(i); });
    constexpr std::size_t worth_a_worker = 64;
    run_range(scheduler.get(), touch_changes.size(), worth_a_worker, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            solver.read(caches[touch_changes[k]], contacts[touch_changes[k]]);
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
        if (c.facet != no_part)
            terrain_changes.push_back(names(c.shape_a, c.shape_b));
        else if (c.touching)
            report_begin(c);
        else
            events.contact_ends.push_back({names(c.shape_a, c.shape_b)});
    }
    report_terrain();
}

/// A shape touches a terrain as long as it touches any of its facets.
template <int D>
void WorldState<D>::report_terrain() {
    const auto key = [](const ShapePair<D>& pair) {
        return std::tuple(pair.shape_a.index, pair.shape_a.generation, pair.shape_b.index,
                          pair.shape_b.generation);
    };
    std::ranges::sort(terrain_changes, {}, key);
    terrain_changes.erase(std::unique(terrain_changes.begin(), terrain_changes.end()), terrain_changes.end());
    for (const ShapePair<D>& pair : terrain_changes) {
        const std::uint32_t touch = first_touching_facet(pair);
        const PairKey shapes_of_it = PairKey::of(pair.shape_a.index, pair.shape_b.index);
        const bool touches = touch != ContactRecord<D>::nowhere;
        if (touches && terrain_touched.insert(shapes_of_it)) report_begin(current(touch));
        if (!touches && terrain_touched.contains(shapes_of_it)) {
            terrain_touched.erase(shapes_of_it);
            events.contact_ends.push_back({pair});
        }
    }
    terrain_changes.clear();
}

/// The first of the contacts in which the two shapes touch, or `nowhere`.
template <int D>
std::uint32_t WorldState<D>::first_touching_facet(const ShapePair<D>& pair) const {
    std::uint32_t first = ContactRecord<D>::nowhere;
    if (!shape_slots.contains(pair.shape_a) || !shape_slots.contains(pair.shape_b)) return first;
    const bool a_ground = shapes[pair.shape_a.index].shape().kind == ShapeKind::terrain;
    const std::uint32_t ground = a_ground ? pair.shape_a.index : pair.shape_b.index;
    each_contact_of_shape(a_ground ? pair.shape_b.index : pair.shape_a.index, [&](std::uint32_t contact) {
        const ContactRecord<D>& c = contacts[contact];
        if (c.touching && (c.shape_a == ground || c.shape_b == ground)) first = std::min(first, contact);
    });
    return first;
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
    const auto gap = separate_shapes<D>(a.shape(), b.shape(), relative(frame_of(a.body), frame_of(b.body)));
    return gap && gap->distance <= 0;
}

/// Who is inside the sensors now. Where neither the sensor nor the visitor moved, nothing changed.
template <int D>
void WorldState<D>::sense() {
    std::swap(events.sensor_ends, dropped_visits);
    if (sensor_pairs.empty()) return placed_anew.clear();
    for (const std::uint32_t body : awake) {
        for (const ShapeId<D>& id : infos[body].shapes)
            sensor_links.each(id.index, [&](std::uint32_t pair, std::uint32_t) { picked.push_back(pair); });
    }
    for (const std::uint32_t shape : placed_anew) {
        sensor_links.each(shape, [&](std::uint32_t pair, std::uint32_t) {
            if (sensor_pairs[pair].placed_anew) picked.push_back(pair);
        });
    }
    placed_anew.clear();
    std::ranges::sort(picked);
    picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
    for (const std::uint32_t i : picked) {
        SensorPair& pair = sensor_pairs[i];
        pair.placed_anew = false;
        const std::uint32_t a = shapes[pair.sensor].body, b = shapes[pair.visitor].body;
        const bool was_inside = pair.inside;
        pair.inside = !infos[a].disabled && !infos[b].disabled && overlap(pair.sensor, pair.visitor);
        if (pair.inside && !was_inside) events.sensor_begins.push_back({names(pair.sensor, pair.visitor)});
        if (!pair.inside && was_inside) events.sensor_ends.push_back({names(pair.sensor, pair.visitor)});
    }
    picked.clear();
}

#define CAROM_INSTANTIATE(D)                                                        \
    template ShapePair<D> WorldState<D>::names(std::uint32_t, std::uint32_t) const; \
    template void WorldState<D>::report_contacts();                                 \
    template void WorldState<D>::sense();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
