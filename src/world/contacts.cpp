#include <algorithm>

#include "core/remove_each.hpp"
#include "world/state.hpp"

// What is done about each contact, and where it is kept. Contacts that carry impulses are the solver's, and
// most of these need nothing but to be carried along with their bodies, which the solver does for many at
// once. Most others are known to be apart, and so seen to be for many at once. What is left is loose: each
// step looks at it one by one. It came near, is on something particular, or round. Contacts of bodies that
// all stand still are none of these, and cost nothing.

namespace carom::detail {

/// The body of a contact with a fixed shape that is not the fixed one.
template <int D>
std::uint32_t WorldState<D>::mover(const ContactRecord<D>& c) const {
    return types[c.body_a] == BodyType::fixed ? c.body_b : c.body_a;
}

template <int D>
void WorldState<D>::add_contact(const PairKey& key) {
    ContactRecord<D> c;
    c.shape_a = key.a;
    c.shape_b = key.b;
    c.facet = key.part;
    c.body_a = shapes[key.a].body;
    c.body_b = shapes[key.b].body;
    c.on_fixed = types[c.body_a] == BodyType::fixed || types[c.body_b] == BodyType::fixed;
    set_surface(c);
    contact_links.add(static_cast<std::uint32_t>(contacts.size()), contact_list(key.a, c.on_fixed),
                      contact_list(key.b, c.on_fixed));
    contacts.push_back(c);
    caches.emplace_back();
    if (c.on_fixed && ++fixed_contacts_of[mover(c)] == 2) regrouped.push_back(mover(c));
    const auto contact = static_cast<std::uint32_t>(contacts.size() - 1);
    if (!stays_apart(contact)) loosen(contact);
}

/// A body that has several contacts with fixed shapes may lie on one surface that they make up, so that those
/// that have points have to be looked at together.
template <int D>
void WorldState<D>::part_from_others() {
    for (const std::uint32_t body : regrouped) {
        each_contact_of(body, true, [&](std::uint32_t contact) {
            if (contacts[contact].apart == ContactRecord<D>::nowhere) stop_carrying(contact);
        });
    }
}

template <int D>
void WorldState<D>::remove_contact(std::size_t contact) {
    const auto i = static_cast<std::uint32_t>(contact),
               last = static_cast<std::uint32_t>(contacts.size() - 1);
    if (contacts[i].place) leave_solver(i);
    leave_apart(i);
    const ContactRecord<D>& c = contacts[i];
    if (c.loose != c.nowhere) loose[c.loose] = c.nowhere;
    if (c.on_fixed) --fixed_contacts_of[mover(c)];
    pairs.erase(PairKey{c.shape_a, c.shape_b, c.facet});
    if (c.touching) {
        const ShapePair<D> pair = names(c.shape_a, c.shape_b);
        c.facet == no_part ? dropped_contacts.push_back({pair}) : terrain_changes.push_back(pair);
    }
    contact_links.remove(i);
    if (i != last) {
        contact_links.renumber(last, i);
        contacts[i] = contacts[last];
        caches[i] = caches[last];
        if (contacts[i].place) solver.rename(contacts[i], i);
        if (contacts[i].loose != c.nowhere) loose[contacts[i].loose] = i;
        if (contacts[i].apart != c.nowhere) apart.rename(contacts[i].apart, i);
    }
    contacts.pop_back();
    caches.pop_back();
}

template <int D>
void WorldState<D>::remove_contacts_of(std::uint32_t body) {
    each_contact_of(body, [&](std::uint32_t contact) { picked.push_back(contact); });
    remove_picked_contacts();
}

template <int D>
void WorldState<D>::remove_contacts_between(std::uint32_t body, std::uint32_t other) {
    each_contact_of(body, [&](std::uint32_t contact) {
        const ContactRecord<D>& c = contacts[contact];
        if (c.body_a == other || c.body_b == other) picked.push_back(contact);
    });
    remove_picked_contacts();
}

template <int D>
void WorldState<D>::remove_contacts_of_shape(std::uint32_t shape) {
    each_contact_of_shape(shape, [&](std::uint32_t contact) { picked.push_back(contact); });
    remove_picked_contacts();
}

template <int D>
void WorldState<D>::remove_picked_contacts() {
    remove_each(picked, contacts, [&](std::uint32_t contact) { remove_contact(contact); });
}

/// The shapes of the body, or its centre of mass, changed.
template <int D>
void WorldState<D>::forget_manifolds_of(std::uint32_t body) {
    each_contact_of(body, [&](std::uint32_t contact) {
        stop_carrying(contact);
        caches[contact].forget();
    });
    for (const ShapeId<D>& shape : infos[body].shapes) lane_shapes.forget(shape.index);
}

/// The contact is to be looked at, in this step or the next. From then on its record is up to date.
template <int D>
void WorldState<D>::loosen(std::uint32_t contact) {
    ContactRecord<D>& c = contacts[contact];
    if (c.loose != c.nowhere) return;
    if (c.place) solver.read(caches[contact], c);
    leave_apart(contact);
    c.loose = static_cast<std::uint32_t>(loose.size());
    loose.push_back(contact);
}

template <int D>
void WorldState<D>::stop_carrying(std::uint32_t contact) {
    ContactRecord<D>& c = contacts[contact];
    if (c.apart != c.nowhere) loosen(contact);
    if (!c.place || !solver.is_carried(c)) return;
    loosen(contact);
    solver.write(c, nullptr);
}

template <int D>
void WorldState<D>::leave_solver(std::uint32_t contact) {
    ContactRecord<D>& c = contacts[contact];
    const std::uint32_t index = c.place.index;
    const std::uint32_t moved = solver.remove(c);
    if (moved != Solver<D>::none) contacts[moved].place.index = index;
}

template <int D>
void WorldState<D>::leave_apart(std::uint32_t contact) {
    ContactRecord<D>& c = contacts[contact];
    if (c.apart == c.nowhere) return;
    const std::uint32_t moved = apart.remove(c.apart);
    if (moved != ApartStore<D>::none) contacts[moved].apart = c.apart;
    c.apart = c.nowhere;
}

/// Brings the records of the loose contacts up to date with what the solver did.
template <int D>
void WorldState<D>::take_loose() {
    std::erase(loose, ContactRecord<D>::nowhere);
    for (std::size_t k = 0; k < loose.size(); ++k) {
        ContactRecord<D>& c = contacts[loose[k]];
        c.loose = static_cast<std::uint32_t>(k);
        if (c.place) solver.read(caches[loose[k]], c);
    }
}

/// What is known of the contact now, and in `cache` of its manifold.
template <int D>
ContactRecord<D> WorldState<D>::current(std::uint32_t contact, ContactCache<D>& cache) const {
    ContactRecord<D> c = contacts[contact];
    cache = caches[contact];
    if (c.place) solver.read(cache, c);
    return c;
}
template <int D>
ContactRecord<D> WorldState<D>::current(std::uint32_t contact) const {
    ContactCache<D> unused;
    return current(contact, unused);
}

/// The solver is told which bodies move. Contacts of those that began to are looked at from now on.
template <int D>
void WorldState<D>::follow_bodies() {
    const bool changed = solver.follow(awake, types, [&](std::uint32_t i) {
        loosen(i);
        leave_solver(i);
    });
    if (!changed) return;
    joints_are_listed = false;
    for (std::size_t k = apart.size(); k-- > 0;) {
        const auto i = static_cast<std::uint32_t>(k);
        if (solver.changed(apart.body_a(i)) || solver.changed(apart.body_b(i))) loosen(apart.contact(i));
    }
    for (const std::uint32_t body : awake) {
        if (!solver.changed(body)) continue;
        each_contact_of(body, [&](std::uint32_t contact) {
            if (!contacts[contact].place) loosen(contact);
        });
    }
}

/// How the solver keeps the contact up to date with its bodies. Nothing where the manifold has to be made
/// anew in each step and lanes cannot do that, where several fixed shapes may be one surface, and where a
/// sleeper may have to be woken. On what is fixed a surface has rights (`lay_on_fixed_face`) that lanes know
/// nothing of, and neither do they of what may be struck.
template <int D>
std::optional<Carrying<D>> WorldState<D>::carrying(std::uint32_t contact) {
    const ContactRecord<D>& c = contacts[contact];
    Carrying<D> result{caches[contact], {}};
    if (!definition.continuous || c.special) return std::nullopt;
    if (c.on_fixed) {
        if (fixed_contacts_of[mover(c)] != 1) return std::nullopt;
    } else {
        if (moving[c.body_a] == stands_still || moving[c.body_b] == stands_still) return std::nullopt;
        if (!may_be_struck(c)) result.shapes = lane_pair(c);
    }
    if (result.cache.way < 0 && !result.shapes) return std::nullopt;
    return result;
}

/// The shapes of the contact, for lanes.
template <int D>
LanePair<D> WorldState<D>::lane_pair(const ContactRecord<D>& c) {
    if (c.facet != no_part) return {};
    return {lane_shapes.find(c.shape_a, shapes[c.shape_a].shape(), masses[c.body_a]),
            lane_shapes.find(c.shape_b, shapes[c.shape_b].shape(), masses[c.body_b])};
}

/// If nothing has to be known of the contact until its bodies have come nearer, it is put with those that are
/// apart. It must be known what holds the shapes apart, or lanes find that out.
template <int D>
bool WorldState<D>::stays_apart(std::uint32_t contact) {
    ContactRecord<D>& c = contacts[contact];
    if (!definition.continuous || c.count > 0 || c.touching || c.merged || c.special || may_be_struck(c))
        return false;
    if (!(masses[c.body_b].radius > 0)) return false;
    const LanePair<D> pair = lane_pair(c);
    if (!pair && !caches[contact].tells_of_gap()) return false;
    c.apart = apart.add(contact, c.body_a, c.body_b, caches[contact], masses[c.body_a].radius,
                        masses[c.body_b].radius, pair);
    return true;
}

/// Gives the solver what came out for the loose contacts. Those that can be carried along are not loose then.
/// The solver takes up new ones in their order, so that their colours do not depend on how they came here.
template <int D>
void WorldState<D>::place_contacts() {
    to_place.clear();
    std::size_t left = 0;
    for (const std::uint32_t i : loose) {
        if (i == ContactRecord<D>::nowhere) continue;
        ContactRecord<D>& c = contacts[i];
        c.loose = c.nowhere;
        if (!any_moves(c.body_a, c.body_b)) continue;
        const bool pushes =
            c.count > 0 && (moving[c.body_a] == moves_freely || moving[c.body_b] == moves_freely);
        const auto carried = pushes ? carrying(i) : std::nullopt;
        if (pushes && c.place) solver.write(c, carried ? &*carried : nullptr);
        if (pushes && !c.place) to_place.push_back(i);
        if (!pushes && c.place) leave_solver(i);
        if (carried) continue;
        if (!pushes && stays_apart(i)) continue;
        c.loose = static_cast<std::uint32_t>(left);
        loose[left++] = i;
    }
    loose.resize(left);
    std::ranges::sort(to_place);
    for (const std::uint32_t i : to_place) {
        ContactRecord<D>& c = contacts[i];
        const auto carried = carrying(i);
        solver.add(i, c, carried ? &*carried : nullptr);
    }
}

#define CAROM_INSTANTIATE(D)                                                                 \
    template std::uint32_t WorldState<D>::mover(const ContactRecord<D>&) const;              \
    template void WorldState<D>::add_contact(const PairKey&);                                \
    template void WorldState<D>::part_from_others();                                         \
    template void WorldState<D>::remove_picked_contacts();                                   \
    template void WorldState<D>::remove_contacts_of(std::uint32_t);                          \
    template void WorldState<D>::remove_contacts_between(std::uint32_t, std::uint32_t);      \
    template void WorldState<D>::remove_contacts_of_shape(std::uint32_t);                    \
    template void WorldState<D>::forget_manifolds_of(std::uint32_t);                         \
    template void WorldState<D>::loosen(std::uint32_t);                                      \
    template void WorldState<D>::stop_carrying(std::uint32_t);                               \
    template void WorldState<D>::leave_apart(std::uint32_t);                                 \
    template ContactRecord<D> WorldState<D>::current(std::uint32_t) const;                   \
    template ContactRecord<D> WorldState<D>::current(std::uint32_t, ContactCache<D>&) const; \
    template void WorldState<D>::take_loose();                                               \
    template void WorldState<D>::follow_bodies();                                            \
    template void WorldState<D>::place_contacts();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
