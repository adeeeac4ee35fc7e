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

namespace {

/// A stage of a step: what it is called, and what it does, with the length of the step or without.
template <int D>
struct Stage {
    const char* name;
    void (WorldState<D>::*run)() = nullptr;
    void (WorldState<D>::*run_for)(double dt) = nullptr;

    constexpr Stage(const char* stage, void (WorldState<D>::*work)()) : name(stage), run(work) {}
    constexpr Stage(const char* stage, void (WorldState<D>::*work)(double)) : name(stage), run_for(work) {}
    void operator()(WorldState<D>& world, double dt) const { run ? (world.*run)() : (world.*run_for)(dt); }
};

/// One time step, stage by stage.
template <int D>
constexpr Stage<D> stages[] = {
    {"begin_step", &WorldState<D>::begin_step},          // timed impulses; which bodies are awake
    {"refresh_boxes", &WorldState<D>::refresh_boxes},    // fat boxes that were left are renewed
    {"drop_pairs", &WorldState<D>::drop_pairs},          // neighbours that parted are forgotten
    {"find_pairs", &WorldState<D>::find_pairs},          // new ones become contacts
    {"take_loose", &WorldState<D>::take_loose},          // contacts that are looked at one by one
    {"follow_bodies", &WorldState<D>::follow_bodies},    // contacts of bodies that began or ceased to move
    {"collide", &WorldState<D>::collide},                // manifolds, impulses carried over
    {"wake_touched", &WorldState<D>::wake_touched},      // sleepers that are being hit
    {"place_contacts", &WorldState<D>::place_contacts},  // what came out, for the solver
    {"sum_forces", &WorldState<D>::sum_forces},          // gravity, the user's forces, generators
    {"solve_constraints", &WorldState<D>::solve_constraints},  // bodies in contact or on joints: the solver
    {"fly_free_bodies", &WorldState<D>::fly_free_bodies},      // all others: the integrator
    {"move_kinematic_bodies", &WorldState<D>::move_kinematic_bodies},  // what only the user moves
    {"stop_at_obstacles", &WorldState<D>::stop_at_obstacles},  // nothing passes through what stands still
    {"finish_bodies", &WorldState<D>::finish_bodies},          // quarantine, list of moved bodies
    {"keep_in_boxes", &WorldState<D>::keep_in_boxes},          // queries find the bodies where they are now
    {"report_contacts", &WorldState<D>::report_contacts},      // what began, ended and hit
    {"sense", &WorldState<D>::sense},                          // who is inside the sensors
    {"break_joints", &WorldState<D>::break_joints},            // those that were pulled too hard
    {"fall_asleep", &WorldState<D>::fall_asleep},              // islands at rest
};

}  // namespace

template <int D>
void WorldState<D>::step(double dt) {
    require_positive(dt, "dt");
    require_in(dt, 0, 1, "dt");
    if (profiler) profiler->begin_step();
    for (const Stage<D>& stage : stages<D>) {
        stage(*this, dt);
        if (profiler) profiler->end_stage(stage.name);
    }
    if (profiler) {
        profiler->end_step();
        count_work(profiler->profile);
    }
    time += dt;
    last_step = dt;
    ++step_count;
}

template <int D>
void WorldState<D>::count_work(StepProfile& profile) const {
    profile.awake = awake.size();
    profile.pairs = contacts.size() + sensor_pairs.size();
    profile.solved = solver.contacts();
    profile.looked_at = loose.size();
    profile.largest_colour = solver.largest_colour();
    profile.without_colour = solver.without_colour();
    profile.workers = scheduler ? scheduler->workers() : 1;
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
void WorldState<D>::sum_forces(double dt) {
    for (const std::uint32_t i : awake) varies[i] = 0;
    forces.mark_fields(time, awake, varies);
    LoadModel<D>{definition.gravity, applied, awake, forces, solids()}.sum({states, masses}, time, loads, dt);
}

template <int D>
void WorldState<D>::solve_constraints(double dt) {
    list_active_joints(dt);
    solver.run({states, masses, loads, scheduler.get(), some_locked, dt, definition.substeps,
                definition.restitution_threshold, definition.impacts == Impacts::simultaneous,
                definition.joints, joints, active_joints, couplings, active_couplings});
}

template <int D>
void WorldState<D>::fly_free_bodies(double dt) {
    flying.clear();
    for (const std::uint32_t i : awake) {
        if (types[i] == BodyType::dynamic && !solver.moves(i)) flying.push_back(i);
    }
    const LoadModel<D> model{definition.gravity, applied, flying, forces, solids()};
    // The loads are those of water half a step ahead, which is what the default integrator and the solver
    // make of them a method of second order; the others ask for themselves.
    if (definition.integrator != Integrator::semi_implicit_euler && !forces.waters(time).empty()) {
        model.sum({states, masses}, time, loads);
        for (const std::uint32_t i : flying) varies[i] = 1;
    }
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
