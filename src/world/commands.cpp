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

template <int D>
void World<D>::remove_body(BodyId<D> body) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    w.wake_neighbours(i);
    w.wake_islands();
    w.remove_contacts_of(i);
    w.remove_joints_of(i);
    for (const std::uint32_t other : w.infos[i].seen().ignored) std::erase(w.infos[other].own().ignored, i);
    for (const ShapeId<D>& shape : w.infos[i].shapes) {
        w.remove_visits_of(shape.index);
        w.remove_leaf(shape.index);
        w.lane_shapes.forget(shape.index);
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
void World<D>::set_collision(BodyId<D> a, BodyId<D> b, bool enabled) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(a), k = w.index(b);
    if (i == k) throw Error("body: a body does not collide with itself");
    const bool was_enabled = !std::ranges::binary_search(w.infos[i].seen().ignored, k);
    if (enabled == was_enabled) return;
    const auto change = [&](std::uint32_t one, std::uint32_t other) {
        std::vector<std::uint32_t>& ignored = w.infos[one].own().ignored;
        if (enabled)
            std::erase(ignored, other);
        else
            ignored.insert(std::ranges::lower_bound(ignored, other), other);
        w.wake(one);
    };
    change(i, k);
    change(k, i);
    w.remove_contacts_between(i, k);
    for (const ShapeId<D>& id : w.infos[i].shapes) w.meet_anew(id.index);
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
    } else if (auto* water = std::get_if<Buoyancy<D>>(&resolved.kind)) {
        water->up = normalized(water->up);
        w.wake_all();
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
    std::vector<const ShapeDefinition<D>*> definitions;
    for (const ShapeId<D>& id : w.infos[i].shapes) {
        definitions.push_back(&w.shapes[id.index].definition());
        if (w.shapes[id.index].shape().kind == ShapeKind::plane && type != BodyType::fixed)
            throw Error("type: a body with a plane must be fixed");
        if (w.shapes[id.index].shape().kind == ShapeKind::terrain && type == BodyType::dynamic)
            throw Error("type: a body with a chain, mesh or height field must be fixed or kinematic");
    }
    body_mass<D>(type, overrides_of(w.infos[i]), definitions);
    w.wake_neighbours(i);
    w.wake_islands();
    w.remove_contacts_of(i);
    for (const ShapeId<D>& id : w.infos[i].shapes) {
        w.remove_visits_of(id.index);
        w.remove_leaf(id.index);
    }
    w.types[i] = type;
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
    const MassOverrides<D> given{properties.mass, properties.center, properties.inertia};
    state_->infos[i].own().overrides = given;
    state_->update_mass(i);
    state_->forget_manifolds_of(i);
    state_->wake(i);
}

template <int D>
void World<D>::set_user_data(BodyId<D> body, std::uint64_t user_data) {
    state_->infos[state_->index(body)].user_data = user_data;
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
    state_->applied_to.push_back(i);
    state_->wake(i);
}

template <int D>
void World<D>::apply_torque(BodyId<D> body, const Angular<D>& torque) {
    const std::uint32_t i = state_->index(body);
    require_finite(torque, "torque");
    if (state_->types[i] != BodyType::dynamic) return;
    state_->applied[i].torque += torque;
    state_->applied_to.push_back(i);
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
