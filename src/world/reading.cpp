#include <algorithm>

#include "carom/error.hpp"
#include "dynamics/buoyancy.hpp"
#include "world/state.hpp"

// What the user reads between steps.

namespace carom {

using namespace detail;

namespace detail {

template <int D>
std::uint32_t WorldState<D>::index(BodyId<D> body) const {
    if (!body_slots.contains(body)) throw Error("body: the handle names nothing in this world");
    return body.index;
}

template <int D>
std::uint32_t WorldState<D>::index(ShapeId<D> shape) const {
    if (!shape_slots.contains(shape)) throw Error("shape: the handle names nothing in this world");
    return shape.index;
}

}  // namespace detail

template <int D>
const WorldDefinition<D>& World<D>::definition() const {
    return state_->definition;
}
template <int D>
bool World<D>::contains(BodyId<D> body) const {
    return state_->body_slots.contains(body);
}
template <int D>
bool World<D>::contains(ShapeId<D> shape) const {
    return state_->shape_slots.contains(shape);
}
template <int D>
bool World<D>::contains(ForceId<D> force) const {
    return state_->forces.contains(force);
}
template <int D>
double World<D>::time() const {
    return state_->time;
}
template <int D>
std::uint64_t World<D>::steps() const {
    return state_->step_count;
}

template <int D>
Transform<D> World<D>::transform(BodyId<D> body) const {
    return state_->frame_of(state_->index(body));
}
template <int D>
Vec<D> World<D>::position(BodyId<D> body) const {
    return transform(body).position;
}
template <int D>
Rotation<D> World<D>::rotation(BodyId<D> body) const {
    return state_->states[state_->index(body)].rotation;
}
template <int D>
double World<D>::angle(BodyId<D> body) const requires(D == 2) {
    return whole_angle(state_->states[state_->index(body)]);
}
template <int D>
Vec<D> World<D>::center_of_mass(BodyId<D> body) const {
    return state_->states[state_->index(body)].position;
}
template <int D>
Vec<D> World<D>::velocity(BodyId<D> body) const {
    return state_->states[state_->index(body)].velocity;
}
template <int D>
Angular<D> World<D>::angular_velocity(BodyId<D> body) const {
    return state_->states[state_->index(body)].angular_velocity;
}
template <int D>
Vec<D> World<D>::velocity_at(BodyId<D> body, const Vec<D>& point) const {
    const BodyState<D>& s = state_->states[state_->index(body)];
    return s.velocity + cross(s.angular_velocity, point - s.position);
}
template <int D>
MassProperties<D> World<D>::mass_properties(BodyId<D> body) const {
    const BodyMass<D>& m = state_->masses[state_->index(body)];
    return {m.mass, m.center, m.inertia};
}
template <int D>
BodyType World<D>::type(BodyId<D> body) const {
    return state_->types[state_->index(body)];
}
template <int D>
bool World<D>::awake(BodyId<D> body) const {
    return state_->is_awake(state_->index(body));
}
template <int D>
std::string_view World<D>::name(BodyId<D> body) const {
    return state_->infos[state_->index(body)].seen().name;
}
template <int D>
std::uint64_t World<D>::user_data(BodyId<D> body) const {
    return state_->infos[state_->index(body)].user_data;
}
template <int D>
std::span<const ShapeId<D>> World<D>::shapes(BodyId<D> body) const {
    const ShortList<ShapeId<D>>& ids = state_->infos[state_->index(body)].shapes;
    return {ids.data(), ids.size()};
}
template <int D>
const ShapeDefinition<D>& World<D>::shape(ShapeId<D> shape) const {
    return state_->shapes[state_->index(shape)].definition();
}
template <int D>
BodyId<D> World<D>::body_of(ShapeId<D> shape) const {
    return state_->body_slots.template id<BodyId<D>>(state_->shapes[state_->index(shape)].body);
}
template <int D>
std::span<const BodyId<D>> World<D>::bodies() const {
    return state_->body_ids;
}
template <int D>
std::span<const MovedBody<D>> World<D>::moved_bodies() const {
    return state_->moved_bodies;
}
template <int D>
std::span<const BodyId<D>> World<D>::quarantined() const {
    return state_->quarantined;
}

template <int D>
std::span<const ContactBegin<D>> World<D>::contact_begins() const {
    return state_->events.contact_begins;
}
template <int D>
std::span<const ContactEnd<D>> World<D>::contact_ends() const {
    return state_->events.contact_ends;
}
template <int D>
std::span<const ContactHit<D>> World<D>::contact_hits() const {
    return state_->events.contact_hits;
}
template <int D>
std::span<const SensorBegin<D>> World<D>::sensor_begins() const {
    return state_->events.sensor_begins;
}
template <int D>
std::span<const SensorEnd<D>> World<D>::sensor_ends() const {
    return state_->events.sensor_ends;
}

template <int D>
std::vector<ShapeId<D>> World<D>::inside(ShapeId<D> sensor) const {
    const std::uint32_t i = state_->index(sensor);
    if (!state_->shapes[i].definition().sensor) throw Error("sensor: the shape is not a sensor");
    std::vector<ShapeId<D>> result;
    state_->sensor_links.each(i, [&](std::uint32_t k, std::uint32_t) {
        const SensorPair& pair = state_->sensor_pairs[k];
        if (pair.inside) result.push_back(state_->shape_slots.template id<ShapeId<D>>(pair.visitor));
    });
    std::ranges::sort(result, {}, &ShapeId<D>::index);
    return result;
}

template <int D>
std::vector<Contact<D>> World<D>::contacts() const {
    std::vector<Contact<D>> result;
    for (std::uint32_t contact = 0; contact < state_->contacts.size(); ++contact) {
        if (state_->contacts[contact].count == 0) continue;
        const ContactRecord<D> c = state_->current(contact);
        Contact<D>& out = result.emplace_back();
        out.body_a = state_->body_slots.template id<BodyId<D>>(c.body_a);
        out.body_b = state_->body_slots.template id<BodyId<D>>(c.body_b);
        out.shape_a = state_->shape_slots.template id<ShapeId<D>>(c.shape_a);
        out.shape_b = state_->shape_slots.template id<ShapeId<D>>(c.shape_b);
        out.normal = narrow<double>(c.normal);
        out.friction_impulse = narrow<double>(c.total_friction);
        out.count = c.count;
        for (int i = 0; i < c.count; ++i) {
            const ContactRecordPoint<D>& p = c.points[i];
            out.points[i] = {state_->states[c.body_a].position + narrow<double>(p.arm_a), p.separation,
                             p.total_impulse, p.feature};
        }
    }
    return result;
}

template <int D>
Counts World<D>::counts() const {
    Counts counts;
    counts.bodies = static_cast<int>(state_->body_slots.count());
    counts.shapes = static_cast<int>(state_->shape_slots.count());
    counts.forces = state_->forces.count();
    counts.joints = static_cast<int>(state_->joint_ids.size());
    for (const std::uint32_t i : state_->movable) {
        counts.awake += state_->types[i] == BodyType::dynamic && state_->is_awake(i);
    }
    for (const ContactRecord<D>& c : state_->contacts) counts.contacts += c.count > 0;
    return counts;
}

template <int D>
Energy World<D>::energy(BodyId<D> body) const {
    const std::uint32_t i = state_->index(body);
    const BodyMass<D>& m = state_->masses[i];
    if (m.inverse_mass == 0) return {};
    return {kinetic_energy(state_->states[i], m),
            -m.mass * m.gravity_scale * dot(state_->definition.gravity, state_->states[i].position)};
}

template <int D>
Energy World<D>::energy() const {
    Energy sum;
    for (const BodyId<D>& id : state_->body_ids) {
        const Energy e = energy(id);
        sum.kinetic += e.kinetic;
        sum.potential += e.potential;
    }
    const WorldState<D>& w = *state_;
    const std::vector<Buoyancy<D>> waters = w.forces.waters(w.time);
    sum.potential += w.forces.potential({w.states, w.masses}, w.time);
    if (!waters.empty())
        sum.potential += energy_in_water<D>({w.states, w.masses, w.solids(), w.definition.gravity, waters});
    return sum;
}

// The members defined in this file; those that change the world are instantiated in commands.cpp.
template class World<2>;
template class World<3>;
template std::uint32_t detail::WorldState<2>::index(BodyId<2>) const;
template std::uint32_t detail::WorldState<2>::index(ShapeId<2>) const;
template std::uint32_t detail::WorldState<3>::index(BodyId<3>) const;
template std::uint32_t detail::WorldState<3>::index(ShapeId<3>) const;

}  // namespace carom
