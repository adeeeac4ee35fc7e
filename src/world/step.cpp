#include <algorithm>

#include "math/check.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

template <int D>
bool finite(const BodyState<D>& s) {
    double sum = dot(s.position, s.position) + dot(s.velocity, s.velocity) +
                 angular_dot(s.angular_velocity, s.angular_velocity);
    if constexpr (D == 2) {
        sum += s.rotation.c + s.rotation.s;
    } else {
        sum += s.rotation.x + s.rotation.y + s.rotation.z + s.rotation.w;
    }
    return is_finite(sum);
}

/// Faster than anything that `float` and a step can work with; whatever it swept over would be lost with it.
template <int D>
bool is_absurd(const BodyState<D>& s) {
    constexpr double fastest = 1e15;  // m/s, rad/s
    return !(dot(s.velocity, s.velocity) < fastest * fastest &&
             angular_dot(s.angular_velocity, s.angular_velocity) < fastest * fastest);
}

}  // namespace

/// Stops the body where it is and takes it out of the simulation.
template <int D>
void WorldState<D>::quarantine(std::uint32_t body) {
    states[body].velocity = {};
    states[body].angular_velocity = {};
    infos[body].disabled = true;
    remove_contacts_of(body);
    quarantined.push_back(body_slots.template id<BodyId<D>>(body));
}

/// One time step, stage by stage.
template <int D>
void WorldState<D>::step(double dt) {
    require_positive(dt, "dt");
    require_in(dt, 0, 1, "dt");

    begin_step(dt);             // timed impulses; which bodies are awake
    refresh_boxes(dt);          // broad phase: fat boxes that were left are renewed
    drop_pairs();               //   neighbours that parted are forgotten
    find_pairs();               //   new ones become contacts
    take_loose();               // contacts that are looked at one by one
    follow_bodies();            // contacts of bodies that began or ceased to move
    collide(dt);                // narrow phase: manifolds, impulses carried over
    wake_touched(dt);           // sleepers that are being hit
    place_contacts();           // what came out, for the solver
    sum_forces();               // gravity, the user's forces, generators
    solve_contacts(dt);         // bodies in contact: sub-steps of the constraint solver
    fly_free_bodies(dt);        // all others: the integrator
    move_kinematic_bodies(dt);  // what only the user moves
    stop_at_obstacles();        // nothing passes through what stands still
    finish_bodies();            // quarantine, list of moved bodies
    keep_in_boxes(dt);          // queries find the bodies where they are now
    report_contacts();          // what began, ended and hit
    sense();                    // who is inside the sensors
    fall_asleep(dt);            // islands at rest

    time += dt;
    last_step = dt;
    ++step_count;
}

template <int D>
void WorldState<D>::begin_step(double) {
    forces.each_change(
        time - last_step, time, [&](std::uint32_t body) { wake(body); }, [&] { wake_all(); });
    forces.take_impulses(time, [&](BodyId<D> body, const Vec<D>& impulse, const auto& point) {
        const std::uint32_t i = body.index;
        if (masses[i].inverse_mass == 0 || infos[i].disabled) return;
        wake(i);
        const Vec<D> arm = point ? rotate(states[i].rotation, *point - masses[i].center) : Vec<D>{};
        states[i].velocity += free_components<D>(masses[i].locks, impulse * masses[i].inverse_mass);
        states[i].angular_velocity =
            states[i].angular_velocity +
            world_inverse_inertia<D>(masses[i], states[i].rotation) * cross(arm, impulse);
    });
    wake_islands();

    quarantined.clear();
    list_moving();
    plant();
}

/// Brings `awake` up to date. Only who was in it or was roused since can be moving.
template <int D>
void WorldState<D>::list_moving() {
    for (const std::uint32_t i : awake) moving[i] = stands_still;
    roused.insert(roused.end(), awake.begin(), awake.end());
    if (!std::ranges::is_sorted(roused)) std::ranges::sort(roused);
    awake.clear();
    before.clear();
    for (const std::uint32_t i : roused) {
        if (moving[i] != stands_still) continue;  // listed twice
        if (tree_for(i) == of_moving && is_absurd(states[i])) quarantine(i);
        if (tree_for(i) == of_moving)
            list_awake(i);
        else
            change_tree(i, tree_for(i));
    }
    roused.clear();
}

template <int D>
void WorldState<D>::list_awake(std::uint32_t body) {
    change_tree(body, of_moving);
    awake.push_back(body);
    before.push_back(states[body]);
    place[body] = static_cast<std::uint32_t>(awake.size() - 1);
    moving[body] = types[body] == BodyType::dynamic ? moves_freely : moved_by_user;
}

template <int D>
void WorldState<D>::sum_forces() {
    for (const std::uint32_t i : awake) varies[i] = 0;
    forces.mark_fields(time, awake, varies);
    LoadModel<D>{definition.gravity, applied, awake, forces}.sum({states, masses}, time, loads);
}

template <int D>
void WorldState<D>::solve_contacts(double dt) {
    solver.run({states, masses, loads, scheduler.get(), some_locked, dt, definition.substeps,
                definition.restitution_threshold});
}

template <int D>
void WorldState<D>::fly_free_bodies(double dt) {
    flying.clear();
    for (const std::uint32_t i : awake) {
        if (types[i] == BodyType::dynamic && !solver.has_contact(i)) flying.push_back(i);
    }
    const LoadModel<D> model{definition.gravity, applied, flying, forces};
    fly<D>({flying, states, masses, loads, varies, model, time, dt}, definition.integrator);
    for (const std::uint32_t i : awake) applied[i] = {};
}

template <int D>
void WorldState<D>::move_kinematic_bodies(double dt) {
    for (const std::uint32_t i : awake) {
        if (types[i] != BodyType::kinematic) continue;
        states[i].position += dt * states[i].velocity;
        turn<D>(states[i], states[i].angular_velocity * dt);
    }
}

template <int D>
void WorldState<D>::finish_bodies() {
    moved_bodies.clear();
    for (std::size_t k = 0; k < awake.size(); ++k) {
        const std::uint32_t i = awake[k];
        const BodyId<D> id = body_slots.template id<BodyId<D>>(i);
        if (!finite(states[i])) {
            states[i] = before[k];
            quarantine(i);
            continue;
        }
        moved_bodies.push_back({id, infos[i].user_data, frame_of(i)});
    }
}

template void WorldState<2>::list_awake(std::uint32_t);
template void WorldState<3>::list_awake(std::uint32_t);
template void WorldState<2>::step(double);
template void WorldState<3>::step(double);

}  // namespace carom::detail
