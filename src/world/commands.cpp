#include <algorithm>

#include "math/check.hpp"
#include "world/state.hpp"
#include "world/validate.hpp"

// What changes a world between steps. Everything is checked before anything is changed.

namespace carom {

using namespace detail;

template <int D>
World<D>::World(const WorldDefinition<D>& definition) {
    validate(definition);
    state_ = std::make_unique<WorldState<D>>();
    state_->definition = definition;
}

template <int D>
World<D>::~World() = default;
template <int D>
World<D>::World(World&&) noexcept = default;
template <int D>
World<D>& World<D>::operator=(World&&) noexcept = default;

template <int D>
void World<D>::set_scheduler(std::shared_ptr<Scheduler> scheduler) {
    state_->scheduler = std::move(scheduler);
}

template <int D>
void World<D>::set_profiling(bool on) {
    if (on != state_->profiler.has_value()) on ? void(state_->profiler.emplace()) : state_->profiler.reset();
}

template <int D>
const StepProfile& World<D>::profile() const {
    static const StepProfile none;
    return state_->profiler ? state_->profiler->profile : none;
}

template <int D>
void World<D>::set_gravity(const Vec<D>& gravity) {
    require_finite(gravity, "gravity");
    state_->definition.gravity = gravity;
    state_->wake_all();
}

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
        w.tree_of.push_back(of_fixed);
        w.moving.push_back(stands_still);
        w.place.emplace_back();
        w.loads.emplace_back();
        w.varies.emplace_back();
        w.fixed_contacts_of.push_back(0);
    }
    w.states[i] = {};
    w.masses[i] = {};
    w.infos[i] = {};
    w.applied[i] = {};
    return i;
}

/// As long as none of these has come to the other side of a wall, nothing has passed through.
template <int D>
Shape<D> core_of(const Shape<D>& shape) {
    if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::terrain) return {};
    Shape<D> ball = inner_ball(shape);
    ball.radius *= 0.5;
    return ball;
}

template <int D>
void make_into(WorldState<D>& w, std::uint32_t i, const ShapeDefinition<D>& definition, Shape<D> shape) {
    ShapeRecord<D>& s = w.shapes[i];
    const Filter& filter = definition.filter;
    w.company[i] = {filter.category, filter.mask,       s.body,
                    filter.group,    definition.sensor, shape.kind == ShapeKind::terrain};
    s.shape = std::move(shape);
    s.definition = definition;
    s.core = core_of(s.shape);
}

template <int D>
ShapeId<D> put_shape(WorldState<D>& w, std::uint32_t body, const ShapeDefinition<D>& definition,
                     Shape<D> shape) {
    const std::uint32_t i = w.shape_slots.acquire();
    if (i == w.shapes.size()) {
        w.shapes.emplace_back();
        w.company.emplace_back();
        w.fat_boxes.emplace_back();
        w.has_new_box.push_back(0);
        w.contact_links.make_room(WorldState<D>::contact_list(i + 1, false));
    }
    w.shapes[i] = {{}, {}, body};
    make_into(w, i, definition, std::move(shape));
    const auto id = w.shape_slots.template id<ShapeId<D>>(i);
    w.infos[body].shapes.push_back(id);
    return id;
}

template <int D>
void drop_shape(WorldState<D>& w, ShapeId<D> id) {
    w.remove_contacts_of_shape(id.index);
    w.remove_visits_of(id.index);
    w.remove_leaf(id.index);
    w.shape_slots.release(id.index);
}

}  // namespace

template <int D>
BodyId<D> World<D>::add_body(const BodyDefinition<D>& definition) {
    std::vector<Shape<D>> shapes = validate(definition);
    WorldState<D>& w = *state_;
    const std::uint32_t i = new_body_place(w);
    w.types[i] = definition.type;
    BodyState<D>& s = w.states[i];
    s.position = definition.position;
    s.rotation = normalized(definition.rotation);
    BodyInfo<D>& info = w.infos[i];
    info.can_sleep = definition.can_sleep;
    info.bullet = definition.bullet;
    w.bullets += definition.bullet;
    info.definition = definition;
    info.definition.shapes.clear();
    BodyMass<D>& m = w.masses[i];
    m.gravity_scale = definition.gravity_scale;
    m.linear_damping = definition.linear_damping;
    m.angular_damping = definition.angular_damping;
    m.locks = definition.locks;
    w.some_locked |= definition.locks != Locks{};
    for (std::size_t k = 0; k < shapes.size(); ++k)
        put_shape(w, i, definition.shapes[k], std::move(shapes[k]));
    w.update_mass(i);  // moves the state from the frame to the centre of mass
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

template <int D>
void World<D>::remove_body(BodyId<D> body) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    w.wake_neighbours(i);
    w.wake_islands();
    w.remove_contacts_of(i);
    w.remove_joints_of(i);
    for (const std::uint32_t other : w.infos[i].ignored) std::erase(w.infos[other].ignored, i);
    for (const ShapeId<D>& shape : w.infos[i].shapes) {
        w.remove_visits_of(shape.index);
        w.remove_leaf(shape.index);
        w.shape_slots.release(shape.index);
    }
    w.forces.remove_all_of(body);
    w.bullets -= w.infos[i].bullet;
    w.infos[i] = {};
    w.masses[i] = {};
    w.types[i] = BodyType::fixed;  // so that no list of what moves keeps it
    std::erase(w.to_wake, i);
    std::erase(w.movable, i);
    std::erase(w.body_ids, body);
    w.body_slots.release(i);
}

template <int D>
ShapeId<D> World<D>::add_shape(BodyId<D> body, const ShapeDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    Shape<D> shape = make_shape(definition);
    require_place_for(shape, w.types[i]);
    const ShapeId<D> id = put_shape(w, i, definition, std::move(shape));
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
    std::vector<ShapeDefinition<D>> rest;
    for (const ShapeId<D>& id : w.infos[body].shapes) {
        if (id != shape) rest.push_back(w.shapes[id.index].definition);
    }
    body_mass<D>(w.infos[body].definition, rest);
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
    Shape<D> made = make_shape(definition);
    require_place_for(made, w.types[body]);
    std::vector<ShapeDefinition<D>> all;
    for (const ShapeId<D>& id : w.infos[body].shapes)
        all.push_back(id == shape ? definition : w.shapes[id.index].definition);
    body_mass<D>(w.infos[body].definition, all);

    const Filter &before = w.shapes[i].definition.filter, &now = definition.filter;
    // Contacts with a terrain name its facets, which are others now.
    const bool is_ground = made.kind == ShapeKind::terrain || w.shapes[i].shape.kind == ShapeKind::terrain;
    const bool same_company = !is_ground && w.shapes[i].definition.sensor == definition.sensor &&
                              before.category == now.category && before.mask == now.mask &&
                              before.group == now.group;
    w.wake_neighbours(body);
    w.wake_islands();
    if (!same_company) {
        w.remove_contacts_of_shape(i);
        w.remove_visits_of(i);
    }
    make_into(w, i, definition, std::move(made));
    w.update_mass(body);
    w.forget_manifolds_of(body);
    w.remove_leaf(i);
    w.insert_leaf(i);
    w.each_contact_of_shape(i, [&](std::uint32_t contact) { w.set_surface(w.contacts[contact]); });
    w.place_visits_anew(i);
}

template <int D>
void World<D>::set_collision(BodyId<D> a, BodyId<D> b, bool enabled) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(a), k = w.index(b);
    if (i == k) throw Error("body: a body does not collide with itself");
    const bool was_enabled = !std::ranges::binary_search(w.infos[i].ignored, k);
    if (enabled == was_enabled) return;
    const auto change = [&](std::uint32_t one, std::uint32_t other) {
        std::vector<std::uint32_t>& ignored = w.infos[one].ignored;
        if (enabled)
            std::erase(ignored, other);
        else
            ignored.insert(std::ranges::lower_bound(ignored, other), other);
        w.wake(one);
    };
    change(i, k);
    change(k, i);
    w.remove_contacts_between(i, k);
    for (const ShapeId<D>& id : w.infos[i].shapes) w.mark_moved(id.index);
}

template <int D>
ForceId<D> World<D>::add_force(const ForceDefinition<D>& definition) {
    validate(definition);
    WorldState<D>& w = *state_;
    ForceDefinition<D> resolved = definition;
    if (auto* spring = std::get_if<Spring<D>>(&resolved.kind)) {
        const std::uint32_t b = w.index(spring->b);
        const Vec<D> from =
            spring->a ? apply(w.frame_of(w.index(*spring->a)), spring->anchor_a) : spring->anchor_a;
        if (!spring->length) spring->length = length(apply(w.frame_of(b), spring->anchor_b) - from);
        if (spring->a) w.wake(spring->a->index);
        w.wake(b);
    } else if (auto* drag = std::get_if<Drag<D>>(&resolved.kind)) {
        if (drag->body) w.index(*drag->body);
    } else if (auto* force = std::get_if<ConstantForce<D>>(&resolved.kind)) {
        w.wake(w.index(force->body));
    } else if (auto* torque = std::get_if<ConstantTorque<D>>(&resolved.kind)) {
        w.wake(w.index(torque->body));
    } else if (auto* impulse = std::get_if<TimedImpulse<D>>(&resolved.kind)) {
        w.index(impulse->body);
    } else {
        w.wake_all();
    }
    return w.forces.add(resolved);
}

template <int D>
void World<D>::remove_force(ForceId<D> force) {
    if (!state_->forces.contains(force)) throw Error("force: the handle names nothing in this world");
    state_->wake_all();
    state_->forces.remove(force);
}

template <int D>
void World<D>::step(double dt) {
    state_->step(dt);
}

template <int D>
void World<D>::set_transform(BodyId<D> body, const Transform<D>& transform) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    require_finite(transform.position, "position");
    require_unit(transform.rotation, "rotation");
    w.wake_neighbours(i);
    BodyState<D>& s = w.states[i];
    s.rotation = normalized(transform.rotation);
    s.turns = 0;
    s.position = transform.position + rotate(s.rotation, w.masses[i].center);
    w.remove_contacts_of(i);
    for (const ShapeId<D>& id : w.infos[i].shapes) {
        w.remove_leaf(id.index);
        w.insert_leaf(id.index);
        w.place_visits_anew(id.index);
    }
}

template <int D>
void World<D>::set_velocity(BodyId<D> body, const Vec<D>& velocity) {
    const std::uint32_t i = state_->index(body);
    require_finite(velocity, "velocity");
    if (state_->types[i] == BodyType::fixed) throw Error("velocity: a fixed body has none");
    state_->states[i].velocity = free_components<D>(state_->masses[i].locks, velocity);
    state_->roused.push_back(i);
    state_->wake(i);
}

template <int D>
void World<D>::set_angular_velocity(BodyId<D> body, const Angular<D>& angular_velocity) {
    const std::uint32_t i = state_->index(body);
    require_finite(angular_velocity, "angular_velocity");
    if (state_->types[i] == BodyType::fixed) throw Error("angular_velocity: a fixed body has none");
    state_->states[i].angular_velocity = free_spin<D>(state_->masses[i].locks, angular_velocity);
    state_->roused.push_back(i);
    state_->wake(i);
}

template <int D>
void World<D>::set_type(BodyId<D> body, BodyType type) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    std::vector<ShapeDefinition<D>> definitions;
    for (const ShapeId<D>& id : w.infos[i].shapes) {
        definitions.push_back(w.shapes[id.index].definition);
        if (w.shapes[id.index].shape.kind == ShapeKind::plane && type != BodyType::fixed)
            throw Error("type: a body with a plane must be fixed");
        if (w.shapes[id.index].shape.kind == ShapeKind::terrain && type == BodyType::dynamic)
            throw Error("type: a body with a chain, mesh or height field must be fixed or kinematic");
    }
    BodyDefinition<D> changed = w.infos[i].definition;
    changed.type = type;
    body_mass<D>(changed, definitions);
    w.wake_neighbours(i);
    w.wake_islands();
    w.remove_contacts_of(i);
    for (const ShapeId<D>& id : w.infos[i].shapes) {
        w.remove_visits_of(id.index);
        w.remove_leaf(id.index);
    }
    w.types[i] = type;
    w.infos[i].definition.type = type;
    w.infos[i].awake = true;
    std::erase(w.movable, i);
    if (type == BodyType::fixed) {
        w.states[i].velocity = {};
        w.states[i].angular_velocity = {};
    } else {
        w.movable.push_back(i);
        w.roused.push_back(i);
    }
    w.update_mass(i);
    w.tree_of[i] = w.tree_for(i);
    for (const ShapeId<D>& id : w.infos[i].shapes) w.insert_leaf(id.index);
}

template <int D>
void World<D>::set_gravity_scale(BodyId<D> body, double scale) {
    const std::uint32_t i = state_->index(body);
    require_finite(scale, "gravity_scale");
    state_->masses[i].gravity_scale = scale;
    state_->wake(i);
}

template <int D>
void World<D>::set_damping(BodyId<D> body, double linear, double angular) {
    const std::uint32_t i = state_->index(body);
    require_not_negative(linear, "linear_damping");
    require_not_negative(angular, "angular_damping");
    state_->masses[i].linear_damping = linear;
    state_->masses[i].angular_damping = angular;
    state_->wake(i);
}

template <int D>
void World<D>::set_locks(BodyId<D> body, const Locks& locks) {
    const std::uint32_t i = state_->index(body);
    state_->masses[i].locks = locks;
    state_->some_locked |= locks != Locks{};
    state_->states[i].velocity = free_components<D>(locks, state_->states[i].velocity);
    state_->states[i].angular_velocity = free_spin<D>(locks, state_->states[i].angular_velocity);
    state_->wake(i);
}

template <int D>
void World<D>::set_mass_properties(BodyId<D> body, const MassProperties<D>& properties) {
    const std::uint32_t i = state_->index(body);
    require_positive(properties.mass, "mass");
    require_finite(properties.center, "center");
    validate_inertia(properties.inertia);
    BodyDefinition<D>& d = state_->infos[i].definition;
    d.mass = properties.mass;
    d.center_of_mass = properties.center;
    d.inertia = properties.inertia;
    state_->update_mass(i);
    state_->forget_manifolds_of(i);
    state_->wake(i);
}

template <int D>
void World<D>::set_user_data(BodyId<D> body, std::uint64_t user_data) {
    state_->infos[state_->index(body)].definition.user_data = user_data;
}

template <int D>
void World<D>::wake(BodyId<D> body) {
    state_->wake(state_->index(body));
    state_->wake_islands();
}

template <int D>
void World<D>::put_to_sleep(BodyId<D> body) {
    const std::uint32_t i = state_->index(body);
    if (state_->types[i] != BodyType::dynamic) throw Error("body: only dynamic bodies sleep");
    state_->infos[i].awake = false;
    std::erase(state_->to_wake, i);
    state_->states[i].velocity = {};
    state_->states[i].angular_velocity = {};
}

template <int D>
void World<D>::apply_force(BodyId<D> body, const Vec<D>& force) {
    const std::uint32_t i = state_->index(body);
    apply_force(body, force, state_->states[i].position);
}

template <int D>
void World<D>::apply_force(BodyId<D> body, const Vec<D>& force, const Vec<D>& point) {
    const std::uint32_t i = state_->index(body);
    require_finite(force, "force");
    require_finite(point, "point");
    if (state_->types[i] != BodyType::dynamic) return;
    state_->applied[i].force += force;
    state_->applied[i].torque += cross(point - state_->states[i].position, force);
    state_->wake(i);
}

template <int D>
void World<D>::apply_torque(BodyId<D> body, const Angular<D>& torque) {
    const std::uint32_t i = state_->index(body);
    require_finite(torque, "torque");
    if (state_->types[i] != BodyType::dynamic) return;
    state_->applied[i].torque += torque;
    state_->wake(i);
}

template <int D>
void World<D>::apply_impulse(BodyId<D> body, const Vec<D>& impulse) {
    const std::uint32_t i = state_->index(body);
    apply_impulse(body, impulse, state_->states[i].position);
}

template <int D>
void World<D>::apply_impulse(BodyId<D> body, const Vec<D>& impulse, const Vec<D>& point) {
    const std::uint32_t i = state_->index(body);
    require_finite(impulse, "impulse");
    require_finite(point, "point");
    const BodyMass<D>& m = state_->masses[i];
    state_->states[i].velocity += free_components<D>(m.locks, impulse * m.inverse_mass);
    apply_angular_impulse(body, cross(point - state_->states[i].position, impulse));
}

template <int D>
void World<D>::apply_angular_impulse(BodyId<D> body, const Angular<D>& impulse) {
    const std::uint32_t i = state_->index(body);
    require_finite(impulse, "impulse");
    BodyState<D>& s = state_->states[i];
    s.angular_velocity =
        s.angular_velocity + world_inverse_inertia<D>(state_->masses[i], s.rotation) * impulse;
    state_->wake(i);
}

// The members defined in this file; those that read the world are instantiated in reading.cpp.
template class World<2>;
template class World<3>;

}  // namespace carom
