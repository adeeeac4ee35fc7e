#include <algorithm>
#include <cmath>

#include "core/remove_each.hpp"
#include "geometry/terrain.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

/// Boxes are made this much fatter than the shape, or an eighth of its size where that is less, so that a
/// body that hardly moves keeps its box.
constexpr double box_margin = 0.05;

template <int D>
Aabb<D> grown(const Aabb<D>& box, double margin, const Vec<D>& motion) {
    Aabb<D> r;
    for (int i = 0; i < D; ++i) {
        r.lower[i] = box.lower[i] - margin + std::min(motion[i], 0.0);
        r.upper[i] = box.upper[i] + margin + std::max(motion[i], 0.0);
    }
    return r;
}

/// A box that holds `box`, in the frame.
template <int D>
Aabb<D> box_in(const Transform<D>& frame, const Aabb<D>& box) {
    const Vec<D> center = unrotate(frame.rotation, 0.5 * (box.lower + box.upper) - frame.position);
    const Vec<D> half = 0.5 * (box.upper - box.lower);
    Vec<D> reach{};
    for (int i = 0; i < D; ++i) {
        Vec<D> side{};
        side[i] = half[i];
        const Vec<D> turned = unrotate(frame.rotation, side);
        for (int k = 0; k < D; ++k) reach[k] += std::fabs(turned[k]);
    }
    return {center - reach, center + reach};
}

}  // namespace

template <int D>
const OuterBox<D>& WorldState<D>::fat_box(const ShapeRecord<D>& shape) const {
    return (shape.in_fixed_tree ? fixed_tree : moving_tree).box(shape.leaf);
}

template <int D>
void WorldState<D>::mark_moved(std::uint32_t shape) {
    if (has_new_box[shape]) return;
    has_new_box[shape] = 1;
    moved_shapes.push_back(shape);
}

template <int D>
void WorldState<D>::insert_leaf(std::uint32_t shape) {
    ShapeRecord<D>& s = shapes[shape];
    s.in_fixed_tree = types[s.body] == BodyType::fixed;
    s.leaf = (s.in_fixed_tree ? fixed_tree : moving_tree).insert(bounds(s.shape, frame_of(s.body)), shape);
    mark_moved(shape);
}

template <int D>
void WorldState<D>::remove_leaf(std::uint32_t shape) {
    ShapeRecord<D>& s = shapes[shape];
    (s.in_fixed_tree ? fixed_tree : moving_tree).remove(s.leaf);
    s.leaf = Tree<D>::none;
}

/// Gives a fat box to every shape that may leave its own in this step.
template <int D>
void WorldState<D>::refresh_boxes(double dt) {
    for (const std::uint32_t body : awake) {
        const Transform<D> placed = frame_of(body);
        const Vec<D> way = states[body].velocity * dt;
        const double spin =
            std::sqrt(angular_dot(states[body].angular_velocity, states[body].angular_velocity));
        for (const ShapeId<D>& id : infos[body].shapes) {
            ShapeRecord<D>& s = shapes[id.index];
            const Aabb<D> tight = bounds(s.shape, placed);
            const Vec<D> size = tight.upper - tight.lower;
            double smallest = size.x;
            for (int i = 1; i < D; ++i) smallest = std::min(smallest, size[i]);
            // A point that turns by an angle about the centre of mass, at the distance r from it, comes no
            // further than its arc, nor than 2 r. Of a ball only the middle counts.
            const bool is_ball = s.shape.kind == ShapeKind::ball;
            const double arm = is_ball ? length(s.shape.a - masses[body].center) : masses[body].radius;
            const double turning = std::min(spin * dt, 2.0) * arm;
            const double falling = length(definition.gravity) * dt * dt;
            const Aabb<D> swept = grown(tight, turning + falling, way);
            if (s.leaf != Tree<D>::none && contains(moving_tree.box(s.leaf), swept)) continue;
            const double margin = std::min(box_margin, 0.125 * smallest);
            moving_tree.move(s.leaf, grown(swept, margin, way));
            mark_moved(id.index);
        }
    }
}

/// May the two shapes touch, or where one is a sensor, notice each other?
template <int D>
bool WorldState<D>::may_meet(std::uint32_t shape_a, std::uint32_t shape_b) const {
    const ShapeRecord<D>&a = shapes[shape_a], &b = shapes[shape_b];
    if (a.body == b.body || infos[a.body].disabled || infos[b.body].disabled) return false;
    if (a.definition.sensor || b.definition.sensor) {
        if (a.definition.sensor && b.definition.sensor) return false;
        if (types[a.body] == BodyType::fixed && types[b.body] == BodyType::fixed) return false;
    } else {
        if (types[a.body] != BodyType::dynamic && types[b.body] != BodyType::dynamic) return false;
        if (std::ranges::binary_search(infos[a.body].ignored, b.body)) return false;
    }
    const Filter &fa = a.definition.filter, &fb = b.definition.filter;
    if (fa.group == fb.group && fa.group != 0) return fa.group > 0;
    return (fa.mask & fb.category) != 0 && (fb.mask & fa.category) != 0;
}

/// Every pair of a shape whose box is new and a shape, or a facet of a terrain, that it overlaps becomes a
/// contact. Pairs are sorted before they are taken up, so that the order of contacts depends on the shapes
/// alone.
template <int D>
void WorldState<D>::find_pairs() {
    new_pairs.clear();
    for (const std::uint32_t shape : moved_shapes) {
        const ShapeRecord<D>& s = shapes[shape];
        if (!shape_slots.in_use(shape) || s.leaf == Tree<D>::none) continue;
        const auto meet = [&](std::uint32_t other) {
            if (shape == other || !may_meet(shape, other)) return;
            if (is_terrain_contact(shape, other)) return find_facets(shape, other);
            const PairKey key = PairKey::of(shape, other);
            if (!pairs.contains(key)) new_pairs.push_back(key);
        };
        const OuterBox<D>& box = fat_box(s);
        moving_tree.query(box, meet);
        if (!s.in_fixed_tree) fixed_tree.query(box, meet);
    }
    for (const std::uint32_t shape : moved_shapes) has_new_box[shape] = 0;
    moved_shapes.clear();

    std::sort(new_pairs.begin(), new_pairs.end());
    new_pairs.erase(std::unique(new_pairs.begin(), new_pairs.end()), new_pairs.end());
    regrouped.clear();
    for (const PairKey& key : new_pairs) {
        pairs.insert(key);
        const bool a_senses = shapes[key.a].definition.sensor, b_senses = shapes[key.b].definition.sensor;
        if (!a_senses && !b_senses) {
            add_contact(key);
            continue;
        }
        sensor_links.add(static_cast<std::uint32_t>(sensor_pairs.size()), key.a, key.b);
        sensor_pairs.push_back(a_senses ? SensorPair{key.a, key.b} : SensorPair{key.b, key.a});
        placed_anew.push_back(key.a);
    }
    part_from_others();
}

/// Does a shape meet the facets of a terrain here? Sensors care for the whole.
template <int D>
bool WorldState<D>::is_terrain_contact(std::uint32_t shape_a, std::uint32_t shape_b) const {
    const ShapeRecord<D>&a = shapes[shape_a], &b = shapes[shape_b];
    if (a.definition.sensor || b.definition.sensor) return false;
    return a.shape.kind == ShapeKind::terrain || b.shape.kind == ShapeKind::terrain;
}

template <int D>
void WorldState<D>::find_facets(std::uint32_t shape_a, std::uint32_t shape_b) {
    const bool a_terrain = shapes[shape_a].shape.kind == ShapeKind::terrain;
    const ShapeRecord<D>& ground = shapes[a_terrain ? shape_a : shape_b];
    const Aabb<D> box = widened(fat_box(shapes[a_terrain ? shape_b : shape_a]));
    ground.shape.terrain->query(box_in(frame_of(ground.body), box), [&](std::uint32_t facet) {
        const PairKey key = PairKey::of(shape_a, shape_b, facet);
        if (!pairs.contains(key)) new_pairs.push_back(key);
    });
}

/// What the materials of the two shapes make of their contact.
template <int D>
void WorldState<D>::set_surface(ContactRecord<D>& c) const {
    const auto material = [&](std::uint32_t shape) -> const Material& {
        const ShapeRecord<D>& s = shapes[shape];
        const Material* own =
            s.shape.kind == ShapeKind::terrain ? s.shape.terrain->material(c.facet) : nullptr;
        return own ? *own : s.definition.material;
    };
    const Material &a = material(c.shape_a), &b = material(c.shape_b);
    c.friction = static_cast<float>(std::sqrt(a.friction * b.friction));
    c.restitution = static_cast<float>(std::max(a.restitution, b.restitution));
    const double radius = std::max(shapes[c.shape_a].shape.radius, shapes[c.shape_b].shape.radius);
    const auto is_special = [&](std::uint32_t shape) {
        const ShapeDefinition<D>& s = shapes[shape].definition;
        return s.one_way || s.surface_velocity != Vec<D>{};
    };
    c.special = is_special(c.shape_a) || is_special(c.shape_b);
    if (!c.special) c.surface_velocity = {};
    c.rolling = static_cast<float>(std::max(a.rolling_resistance, b.rolling_resistance) * radius);
}

/// Forgets the pairs whose boxes parted; only a box that is new can have left another.
template <int D>
void WorldState<D>::drop_pairs() {
    picked.clear();
    for (const std::uint32_t shape : moved_shapes) {
        each_contact_of_shape(shape, [&](std::uint32_t contact) {
            if (!are_near(contacts[contact])) picked.push_back(contact);
        });
    }
    remove_picked_contacts();
    if (sensor_pairs.empty()) return;
    for (const std::uint32_t shape : moved_shapes) {
        sensor_links.each(shape, [&](std::uint32_t pair) {
            const ShapeRecord<D>&sensor = shapes[sensor_pairs[pair].sensor],
                  &visitor = shapes[sensor_pairs[pair].visitor];
            if (!overlaps(fat_box(sensor), fat_box(visitor))) picked.push_back(pair);
        });
    }
    remove_picked_visits();
}

template <int D>
bool WorldState<D>::are_near(const ContactRecord<D>& c) const {
    const ShapeRecord<D>&a = shapes[c.shape_a], &b = shapes[c.shape_b];
    if (!overlaps(fat_box(a), fat_box(b))) return false;
    if (c.facet == no_part) return true;
    const bool a_terrain = a.shape.kind == ShapeKind::terrain;
    const ShapeRecord<D>& ground = a_terrain ? a : b;
    const Aabb<D> box = box_in(frame_of(ground.body), widened(fat_box(a_terrain ? b : a)));
    return overlaps(box, ground.shape.terrain->facet(c.facet).bounds());
}

template <int D>
void WorldState<D>::place_visits_anew(std::uint32_t shape) {
    placed_anew.push_back(shape);
    sensor_links.each(shape, [&](std::uint32_t pair) { sensor_pairs[pair].placed_anew = true; });
}

template <int D>
void WorldState<D>::remove_visit(std::size_t sensor_pair) {
    const SensorPair& pair = sensor_pairs[sensor_pair];
    pairs.erase(PairKey::of(pair.sensor, pair.visitor));
    if (pair.inside) dropped_visits.push_back({names(pair.sensor, pair.visitor)});
    const std::size_t last = sensor_pairs.size() - 1;
    sensor_links.remove(static_cast<std::uint32_t>(sensor_pair));
    if (sensor_pair != last) {
        sensor_pairs[sensor_pair] = sensor_pairs[last];
        sensor_links.renumber(static_cast<std::uint32_t>(last), static_cast<std::uint32_t>(sensor_pair));
    }
    sensor_pairs.pop_back();
}

template <int D>
void WorldState<D>::remove_picked_visits() {
    remove_each(picked, sensor_pairs, [&](std::uint32_t pair) { remove_visit(pair); });
}

template <int D>
void WorldState<D>::remove_visits_of(std::uint32_t shape) {
    sensor_links.each(shape, [&](std::uint32_t pair) { picked.push_back(pair); });
    remove_picked_visits();
}

#define CAROM_INSTANTIATE(D)                                                             \
    template const OuterBox<D>& WorldState<D>::fat_box(const ShapeRecord<D>&) const;         \
    template void WorldState<D>::mark_moved(std::uint32_t);                              \
    template void WorldState<D>::insert_leaf(std::uint32_t);                             \
    template void WorldState<D>::remove_leaf(std::uint32_t);                             \
    template void WorldState<D>::refresh_boxes(double);                                  \
    template bool WorldState<D>::is_terrain_contact(std::uint32_t, std::uint32_t) const; \
    template void WorldState<D>::find_pairs();                                           \
    template void WorldState<D>::drop_pairs();                                           \
    template void WorldState<D>::remove_visits_of(std::uint32_t);                        \
    template void WorldState<D>::place_visits_anew(std::uint32_t);                       \
    template void WorldState<D>::set_surface(ContactRecord<D>&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
