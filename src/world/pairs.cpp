#include <algorithm>
#include <cmath>

#include "core/remove_each.hpp"
#include "geometry/terrain.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

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

/// May the two shapes touch, or where one is a sensor, notice each other?
template <int D>
bool WorldState<D>::may_meet(std::uint32_t shape_a, std::uint32_t shape_b) const {
    const Company &a = company[shape_a], &b = company[shape_b];
    if (a.body == b.body) return false;
    const bool senses = a.senses || b.senses;
    if (senses) {
        if (a.senses && b.senses) return false;
        if (types[a.body] == BodyType::fixed && types[b.body] == BodyType::fixed) return false;
    } else if (types[a.body] != BodyType::dynamic && types[b.body] != BodyType::dynamic) {
        return false;
    }
    const bool agreed = a.group == b.group && a.group != 0
                            ? a.group > 0
                            : (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
    if (!agreed || infos[a.body].disabled || infos[b.body].disabled) return false;
    const BodyExtras<D>* extras = infos[a.body].extras.get();
    return senses || !extras ||
           (!std::ranges::binary_search(extras->ignored, b.body) &&
            !std::ranges::binary_search(extras->jointed, b.body));
}

/// Two shapes whose boxes overlap: where they, or facets of a terrain, are no pair yet, they become one.
template <int D>
void WorldState<D>::meet(std::uint32_t shape_a, std::uint32_t shape_b) {
    const PairKey key = PairKey::of(shape_a, shape_b);
    const Company &a = company[shape_a], &b = company[shape_b];
    const bool on_ground =
        (a.is_ground || b.is_ground) && !a.senses && !b.senses;  // sensors care for the whole
    if (on_ground && !has_new_box[shape_a] && !has_new_box[shape_b]) return;
    if ((!on_ground && pairs.contains(key)) || !may_meet(shape_a, shape_b)) return;
    if (on_ground)
        find_facets(shape_a, shape_b);
    else
        new_pairs.push_back(key);
}

/// Every pair of a shape whose box is new and a shape, or a facet of a terrain, that it overlaps becomes a
/// contact. Two whose boxes overlapped before are a pair already, or may not be one, so it is enough to look
/// at those that begin to. Pairs are sorted before they are taken up, so that the order of contacts depends
/// on the shapes alone.
template <int D>
void WorldState<D>::find_pairs() {
    new_pairs.clear();
    met_boxes.resize(fat_boxes.size(), no_box<D>());
    for (const std::uint32_t shape : moved_shapes) {
        if (has_new_box[shape] & meets_anew) met_boxes[shape] = no_box<D>();
    }
    // Where many move, it is cheaper to look at all that do at once than to ask a tree for each.
    constexpr std::size_t many = 64;
    const bool crowded = moved_shapes.size() >= many && 4 * moved_shapes.size() >= moving_shapes.size();
    if (crowded) {
        crowd.find(moving_shapes, fat_boxes, met_boxes, scheduler.get(),
                   [&](std::uint32_t shape, std::uint32_t other) { meet(shape, other); });
    }
    ask_trees(crowded);
    for (const std::uint32_t shape : moved_shapes) {
        has_new_box[shape] = 0;
        // Of a terrain other facets may be near each time.
        met_boxes[shape] = company[shape].is_ground ? no_box<D>() : fat_boxes[shape];
    }
    moved_shapes.clear();
    take_up_pairs();
}

/// What the shapes with new boxes come near that stands still, and where there is no crowd, that moves.
template <int D>
void WorldState<D>::ask_trees(bool crowded) {
    constexpr std::size_t stretch = 128;
    const bool some_fixed = trees[of_fixed].size() > 0, some_resting = trees[of_resting].size() > 0;
    const auto asks_moving = [&](std::uint32_t shape) {
        return !crowded || tree_of[company[shape].body] != of_moving;
    };
    if (std::ranges::any_of(moved_shapes, asks_moving))
        refresh_tree();
    else if (!some_fixed && !some_resting)
        return;
    meeting.look_through(scheduler.get(), moved_shapes.size(), stretch,
                         [&](std::size_t begin, std::size_t end, std::vector<PairKey>& near) {
                             for (std::size_t i = begin; i < end; ++i) {
                                 const std::uint32_t shape = moved_shapes[i];
                                 if (!shape_slots.in_use(shape)) continue;
                                 const auto visit = [&](std::uint32_t other) {
                                     // Two that are both new meet once.
                                     const bool here =
                                         shape != other && (!has_new_box[other] || shape < other);
                                     if (here && !overlapped(met_boxes[shape], met_boxes[other]))
                                         near.push_back({shape, other});
                                 };
                                 if (asks_moving(shape)) trees[of_moving].query(fat_boxes[shape], visit);
                                 trees[of_resting].query(fat_boxes[shape], visit);
                                 if (tree_of[company[shape].body] != of_fixed)
                                     trees[of_fixed].query(fat_boxes[shape], visit);
                             }
                         });
    meeting.each([&](const PairKey& pair) { meet(pair.a, pair.b); });
}

template <int D>
void WorldState<D>::take_up_pairs() {
    std::sort(new_pairs.begin(), new_pairs.end());
    new_pairs.erase(std::unique(new_pairs.begin(), new_pairs.end()), new_pairs.end());
    regrouped.clear();
    for (const PairKey& key : new_pairs) {
        pairs.insert(key);
        const bool a_senses = company[key.a].senses, b_senses = company[key.b].senses;
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

template <int D>
void WorldState<D>::find_facets(std::uint32_t shape_a, std::uint32_t shape_b) {
    const bool a_terrain = shapes[shape_a].shape().kind == ShapeKind::terrain;
    const ShapeRecord<D>& ground = shapes[a_terrain ? shape_a : shape_b];
    const Aabb<D> box = widened(fat_boxes[a_terrain ? shape_b : shape_a]);
    ground.shape().terrain->query(box_in(frame_of(ground.body), box), [&](std::uint32_t facet) {
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
            s.shape().kind == ShapeKind::terrain ? s.shape().terrain->material(c.facet) : nullptr;
        return own ? *own : s.definition().material;
    };
    const Material &a = material(c.shape_a), &b = material(c.shape_b);
    c.friction = static_cast<float>(std::sqrt(a.friction * b.friction));
    c.restitution = static_cast<float>(std::max(a.restitution, b.restitution));
    const double radius = std::max(shapes[c.shape_a].shape().radius, shapes[c.shape_b].shape().radius);
    const auto is_special = [&](std::uint32_t shape) {
        const ShapeDefinition<D>& s = shapes[shape].definition();
        return s.one_way || s.surface_velocity != Vec<D>{};
    };
    c.special = is_special(c.shape_a) || is_special(c.shape_b);
    if (!c.special) c.surface_velocity = {};
    c.rolling = static_cast<float>(std::max(a.rolling_resistance, b.rolling_resistance) * radius);
}

/// Lists the contacts whose boxes parted; only a box that is new can have left another.
template <int D>
void WorldState<D>::list_parting() {
    // Where many are new it is quicker to look at all contacts in their order.
    if (8 * moved_shapes.size() >= contacts.size()) {
        constexpr std::size_t stretch = 2048;
        parting.look_through(scheduler.get(), contacts.size(), stretch,
                             [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& parted) {
                                 for (std::size_t i = begin; i < end; ++i) {
                                     const auto contact = static_cast<std::uint32_t>(i);
                                     const std::uint32_t a = shape_of_list(contact_links.node(contact, 0)),
                                                         b = shape_of_list(contact_links.node(contact, 1));
                                     const bool is_news = has_new_box[a] || has_new_box[b];
                                     if (is_news && !are_near(contact, a, b)) parted.push_back(contact);
                                 }
                             });
        parting.each([&](std::uint32_t contact) { picked.push_back(contact); });
        return;
    }
    for (const std::uint32_t shape : moved_shapes) {
        for (const bool on_fixed : {false, true}) {
            contact_links.each(contact_list(shape, on_fixed), [&](std::uint32_t contact, std::uint32_t list) {
                if (!are_near(contact, shape, shape_of_list(list))) picked.push_back(contact);
            });
        }
    }
}

/// Forgets the pairs whose boxes parted.
template <int D>
void WorldState<D>::drop_pairs() {
    list_parting();
    remove_picked_contacts();
    if (sensor_pairs.empty()) return;
    for (const std::uint32_t shape : moved_shapes) {
        sensor_links.each(shape, [&](std::uint32_t pair, std::uint32_t other) {
            if (!overlaps(fat_boxes[shape], fat_boxes[other])) picked.push_back(pair);
        });
    }
    remove_picked_visits();
}

template <int D>
bool WorldState<D>::are_near(std::uint32_t contact, std::uint32_t shape_a, std::uint32_t shape_b) const {
    if (!overlaps(fat_boxes[shape_a], fat_boxes[shape_b])) return false;
    const bool a_ground = company[shape_a].is_ground;
    if (!a_ground && !company[shape_b].is_ground) return true;
    const ShapeRecord<D>& ground = shapes[a_ground ? shape_a : shape_b];
    const Aabb<D> box = box_in(frame_of(ground.body), widened(fat_boxes[a_ground ? shape_b : shape_a]));
    return overlaps(box, ground.shape().terrain->facet(contacts[contact].facet).bounds());
}

template <int D>
void WorldState<D>::place_visits_anew(std::uint32_t shape) {
    placed_anew.push_back(shape);
    sensor_links.each(shape,
                      [&](std::uint32_t pair, std::uint32_t) { sensor_pairs[pair].placed_anew = true; });
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
    sensor_links.each(shape, [&](std::uint32_t pair, std::uint32_t) { picked.push_back(pair); });
    remove_picked_visits();
}

#define CAROM_INSTANTIATE(D)                                       \
    template void WorldState<D>::find_pairs();                     \
    template void WorldState<D>::drop_pairs();                     \
    template void WorldState<D>::remove_visits_of(std::uint32_t);  \
    template void WorldState<D>::place_visits_anew(std::uint32_t); \
    template void WorldState<D>::set_surface(ContactRecord<D>&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
