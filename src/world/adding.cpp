#include <algorithm>

#include "core/room.hpp"
#include "math/check.hpp"
#include "world/state.hpp"
#include "world/validate.hpp"

// How bodies and shapes come into a world, and how shapes change. Everything is checked before anything is
// changed.

namespace carom {

using namespace detail;

namespace {

template <int D>
std::uint32_t new_body_place(WorldState<D>& w) {
    const std::uint32_t i = w.body_slots.acquire();
    if (i == w.states.size()) {
        w.states.emplace_back();
        w.masses.emplace_back();
        w.types.emplace_back();
        w.infos.emplace_back();
        w.applied.emplace_back();
        w.only_shape.emplace_back();
        w.tree_of.push_back(of_fixed);
        w.moving.push_back(stands_still);
        w.place.emplace_back();
        w.loads.emplace_back();
        w.varies.emplace_back();
        w.fixed_contacts_of.push_back(0);
    } else {
        w.states[i] = {};
        w.masses[i] = {};
        w.infos[i] = {};
        w.applied[i] = {};
    }
    w.only_shape[i] = w.no_shape;
    return i;
}

/// Room for so many more bodies, and shapes on them, where these are many.
template <int D>
void make_room_for(WorldState<D>& w, std::size_t bodies, std::size_t shapes) {
    constexpr std::size_t many = 64;
    if (bodies + shapes < many) return;
    make_room(w.states, bodies);
    make_room(w.masses, bodies);
    make_room(w.types, bodies);
    make_room(w.only_shape, bodies);
    make_room(w.infos, bodies);
    make_room(w.applied, bodies);
    make_room(w.tree_of, bodies);
    make_room(w.moving, bodies);
    make_room(w.place, bodies);
    make_room(w.loads, bodies);
    make_room(w.varies, bodies);
    make_room(w.fixed_contacts_of, bodies);
    make_room(w.body_ids, bodies);
    make_room(w.shapes, shapes);
    make_room(w.company, shapes);
    make_room(w.fat_boxes, shapes);
    make_room(w.has_new_box, shapes);
    make_room(w.unplanted, shapes);
    make_room(w.moved_shapes, shapes);
}

/// As long as none of these has come to the other side of a wall, nothing has passed through.
template <int D>
Shape<D> core_of(const Shape<D>& shape) {
    if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::terrain) return {};
    Shape<D> ball = inner_ball(shape);
    ball.radius *= 0.5;
    return ball;
}

/// The shape, without the body that it is on.
template <int D>
ShapeRecord<D> recorded(const ShapeDefinition<D>& definition, Shape<D> shape) {
    const Shape<D> core = core_of(shape);
    return {std::move(shape), std::make_shared<const ShapeDefinition<D>>(definition), 0, core.a, core.radius};
}

template <int D>
void set_record(WorldState<D>& w, std::uint32_t i, std::uint32_t body, const ShapeRecord<D>& record) {
    w.shapes[i] = record;
    w.shapes[i].body = body;
    const ShapeDefinition<D>& s = *record.definition;
    w.company[i] = {s.filter.category, s.filter.mask, body,
                    s.filter.group,    s.sensor,      record.shape.kind == ShapeKind::terrain};
}

template <int D>
ShapeId<D> put_shape(WorldState<D>& w, std::uint32_t body, const ShapeRecord<D>& record) {
    const std::uint32_t i = w.shape_slots.acquire();
    if (i == w.shapes.size()) {
        w.shapes.emplace_back();
        w.company.emplace_back();
        w.extents.emplace_back();
        w.fat_boxes.emplace_back();
        w.has_new_box.push_back(0);
        w.contact_links.make_room(WorldState<D>::contact_list(i + 1, false));
    }
    set_record(w, i, body, record);
    const auto id = w.shape_slots.template id<ShapeId<D>>(i);
    w.infos[body].shapes.push_back(id);
    return id;
}

template <int D>
void drop_shape(WorldState<D>& w, ShapeId<D> id) {
    w.remove_contacts_of_shape(id.index);
    w.remove_visits_of(id.index);
    w.remove_leaf(id.index);
    w.lane_shapes.forget(id.index);
    w.shape_slots.release(id.index);
}

}  // namespace

namespace detail {

template <int D>
bool Blueprint<D>::serves(const BodyDefinition<D>& b) const {
    const auto same_shape = [](const ShapeDefinition<D>& wanted, const ShapeRecord<D>& one) {
        return wanted == *one.definition;
    };
    return made && b.type == definition.type && b.mass == definition.mass &&
           b.center_of_mass == definition.center_of_mass && b.inertia == definition.inertia &&
           b.gravity_scale == definition.gravity_scale && b.linear_damping == definition.linear_damping &&
           b.angular_damping == definition.angular_damping && b.locks == definition.locks &&
           std::ranges::equal(b.shapes, shapes, same_shape);
}

}  // namespace detail

namespace {

/// Works out what bodies like this one have in common; the body that is added stands at `i`.
template <int D>
void draw_blueprint(WorldState<D>& w, const BodyDefinition<D>& definition, std::vector<Shape<D>> shapes) {
    Blueprint<D>& plan = w.blueprint;
    plan.made = true;
    plan.definition = {};
    plan.definition.type = definition.type;
    plan.definition.mass = definition.mass;
    plan.definition.center_of_mass = definition.center_of_mass;
    plan.definition.inertia = definition.inertia;
    plan.definition.gravity_scale = definition.gravity_scale;
    plan.definition.linear_damping = definition.linear_damping;
    plan.definition.angular_damping = definition.angular_damping;
    plan.definition.locks = definition.locks;
    plan.shapes.clear();
    for (std::size_t k = 0; k < shapes.size(); ++k)
        plan.shapes.push_back(recorded(definition.shapes[k], std::move(shapes[k])));
    plan.mass = {};
    plan.mass.gravity_scale = definition.gravity_scale;
    plan.mass.linear_damping = definition.linear_damping;
    plan.mass.angular_damping = definition.angular_damping;
    plan.mass.locks = definition.locks;
}

}  // namespace

namespace {

/// Puts a body into the world that the blueprint serves, at `placed`; the first of its kind says what mass it
/// has.
template <int D>
BodyId<D> put_body(WorldState<D>& w, const BodyDefinition<D>& definition, const Transform<D>& placed,
                   bool is_first) {
    Blueprint<D>& plan = w.blueprint;
    const std::uint32_t i = new_body_place(w);
    w.types[i] = definition.type;
    BodyState<D>& s = w.states[i];
    s.position = placed.position;
    s.rotation = normalized(placed.rotation);
    BodyInfo<D>& info = w.infos[i];
    info.can_sleep = definition.can_sleep;
    info.bullet = definition.bullet;
    w.bullets += definition.bullet;
    info.name = definition.name;
    info.user_data = definition.user_data;
    if (definition.mass || definition.center_of_mass || definition.inertia)
        info.overrides = std::make_shared<const MassOverrides<D>>(overrides_of(definition));
    info.shapes.reserve(plan.shapes.size());
    for (const ShapeRecord<D>& record : plan.shapes) put_shape(w, i, record);
    BodyMass<D>& m = w.masses[i];
    m = plan.mass;
    if (is_first) {
        w.update_mass(i);  // moves the place from the frame to the centre of mass
        plan.mass = m;
    } else {
        s.position += rotate(s.rotation, m.center);
        w.measure_extents(i);
    }
    w.some_locked |= definition.locks != Locks{};
    if (definition.type != BodyType::fixed) {
        s.velocity = free_components<D>(m.locks, definition.velocity);
        s.angular_velocity = free_spin<D>(m.locks, definition.angular_velocity);
        w.movable.push_back(i);
        w.roused.push_back(i);
    }
    w.tree_of[i] = w.tree_for(i);
    for (const ShapeId<D>& shape : info.shapes) w.insert_leaf(shape.index);
    const auto id = w.body_slots.template id<BodyId<D>>(i);
    w.body_ids.push_back(id);
    return id;
}

/// Lets the blueprint serve the definition; true if it did not before. Throws `Error` for what cannot be.
template <int D>
bool prepare_blueprint(WorldState<D>& w, const BodyDefinition<D>& definition) {
    if (w.blueprint.serves(definition)) return false;
    draw_blueprint(w, definition, validate(definition, w.scheduler.get()));
    return true;
}

/// What has much data is not kept beyond its body.
template <int D>
void forget_large(Blueprint<D>& plan) {
    if (std::ranges::any_of(plan.shapes, [](const auto& r) { return r.shape.kind == ShapeKind::terrain; }))
        plan = {};
}

}  // namespace

template <int D>
BodyId<D> World<D>::add_body(const BodyDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const Transform<D> placed{definition.position, definition.rotation};
    validate_motion(definition, placed);
    const bool is_first = prepare_blueprint(w, definition);
    make_room_for(w, 1, w.blueprint.shapes.size());
    const BodyId<D> id = put_body(w, definition, placed, is_first);
    forget_large(w.blueprint);
    return id;
}

template <int D>
std::vector<BodyId<D>> World<D>::add_bodies(const BodyDefinition<D>& definition,
                                            std::span<const Transform<D>> places) {
    WorldState<D>& w = *state_;
    std::vector<BodyId<D>> added;
    if (places.empty()) return added;
    std::size_t checked = 0;
    try {
        for (; checked < places.size(); ++checked) validate_motion(definition, places[checked]);
    } catch (const Error& error) {
        throw Error("places[" + std::to_string(checked) + "]." + error.what());
    }
    bool is_first = prepare_blueprint(w, definition);
    make_room_for(w, places.size(), places.size() * w.blueprint.shapes.size());
    added.reserve(places.size());
    for (const Transform<D>& placed : places) {
        added.push_back(put_body(w, definition, placed, is_first));
        is_first = false;
    }
    forget_large(w.blueprint);
    return added;
}

template <int D>
ShapeId<D> World<D>::add_shape(BodyId<D> body, const ShapeDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    Shape<D> shape = make_shape(definition, w.scheduler.get());
    require_place_for(shape, w.types[i]);
    const ShapeId<D> id = put_shape(w, i, recorded(definition, std::move(shape)));
    w.update_mass(i);
    w.forget_manifolds_of(i);
    w.insert_leaf(id.index);
    w.wake(i);
    return id;
}

template <int D>
void World<D>::remove_shape(ShapeId<D> shape) {
    WorldState<D>& w = *state_;
    const std::uint32_t body = w.shapes[w.index(shape)].body;
    std::vector<const ShapeDefinition<D>*> rest;
    for (const ShapeId<D>& id : w.infos[body].shapes) {
        if (id != shape) rest.push_back(w.shapes[id.index].definition.get());
    }
    body_mass<D>(w.types[body], overrides_of(w.infos[body]), rest);
    w.wake_neighbours(body);
    w.wake_islands();
    drop_shape(w, shape);
    std::erase(w.infos[body].shapes, shape);
    w.update_mass(body);
    w.forget_manifolds_of(body);
}

template <int D>
void World<D>::set_shape(ShapeId<D> shape, const ShapeDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(shape), body = w.shapes[i].body;
    Shape<D> made = make_shape(definition, w.scheduler.get());
    require_place_for(made, w.types[body]);
    std::vector<const ShapeDefinition<D>*> all;
    for (const ShapeId<D>& id : w.infos[body].shapes)
        all.push_back(id == shape ? &definition : w.shapes[id.index].definition.get());
    body_mass<D>(w.types[body], overrides_of(w.infos[body]), all);

    const Filter &before = w.shapes[i].definition->filter, &now = definition.filter;
    // Contacts with a terrain name its facets, which are others now.
    const bool is_ground = made.kind == ShapeKind::terrain || w.shapes[i].shape.kind == ShapeKind::terrain;
    const bool same_company = !is_ground && w.shapes[i].definition->sensor == definition.sensor &&
                              before.category == now.category && before.mask == now.mask &&
                              before.group == now.group;
    w.wake_neighbours(body);
    w.wake_islands();
    if (!same_company) {
        w.remove_contacts_of_shape(i);
        w.remove_visits_of(i);
    }
    w.remove_leaf(i);
    set_record(w, i, body, recorded(definition, std::move(made)));
    w.update_mass(body);
    w.forget_manifolds_of(body);
    w.insert_leaf(i);
    w.each_contact_of_shape(i, [&](std::uint32_t contact) { w.set_surface(w.contacts[contact]); });
    w.place_visits_anew(i);
}

#define CAROM_INSTANTIATE(D)                                                             \
    template BodyId<D> World<D>::add_body(const BodyDefinition<D>&);                     \
    template std::vector<BodyId<D>> World<D>::add_bodies(const BodyDefinition<D>&,       \
                                                         std::span<const Transform<D>>); \
    template ShapeId<D> World<D>::add_shape(BodyId<D>, const ShapeDefinition<D>&);       \
    template void World<D>::remove_shape(ShapeId<D>);                                    \
    template void World<D>::set_shape(ShapeId<D>, const ShapeDefinition<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom
