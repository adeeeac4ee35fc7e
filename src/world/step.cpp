#include <algorithm>

#include "math/check.hpp"
#include "world/meeting.hpp"
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
    {"judge_ways", &WorldState<D>::judge_ways},                        // who came far, or not where foreseen
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
    plant(scheduler.get());
}

/// Brings `awake` up to date. Only who was in it or was roused since can be moving.
template <int D>
void WorldState<D>::list_moving() {
    for (const std::uint32_t i : awake) moving[i] = stands_still;
    roused.insert(roused.end(), awake.begin(), awake.end());
    if (!std::ranges::is_sorted(roused)) std::ranges::sort(roused);
    awake.clear();
    for (const std::uint32_t i : roused) {
        if (moving[i] != stands_still) continue;  // listed twice
        const TreeKind kind = tree_for(i);
        if (kind == of_moving)
            list_awake(i);
        else
            change_tree(i, kind);
    }
    roused.clear();
    if (keep_states(0)) return;
    for (const std::uint32_t i : awake) {
        if (is_absurd(states[i])) quarantine(i);
    }
    list_moving();
}

/// Brings `before` up to date with `awake`, from a place on. Returns whether all states are such that one can
/// work with them.
template <int D>
bool WorldState<D>::keep_states(std::size_t from) {
    std::atomic<bool> all_well = true;
    before.resize(awake.size());
    each_awake([&](std::size_t begin, std::size_t end) {
        bool well = true;
        for (std::size_t k = std::max(begin, from); k < end; ++k) {
            before[k] = states[awake[k]];
            well &= !is_absurd(before[k]);
        }
        if (!well) all_well.store(false, std::memory_order_relaxed);
    });
    return all_well;
}

template <int D>
void WorldState<D>::list_awake(std::uint32_t body) {
    change_tree(body, of_moving);
    awake.push_back(body);
    place[body] = static_cast<std::uint32_t>(awake.size() - 1);
    moving[body] = types[body] == BodyType::dynamic ? moves_freely : moved_by_user;
}

template <int D>
void WorldState<D>::sum_forces(double dt) {
    const LoadModel<D> model{definition.gravity, applied, awake, forces, solids()};
    each_awake([&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) varies[awake[k]] = 0;
        model.begin(masses, begin, end, loads);
    });
    forces.mark_fields(time, awake, varies);
    model.add({states, masses}, time, loads, dt);
}

template <int D>
void WorldState<D>::solve_constraints(double dt) {
    list_active_joints();
    follow_paths(dt);
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
    fly<D>({flying, states, masses, loads, varies, model, time, dt}, definition.integrator, scheduler.get());
    std::erase_if(applied_to, [&](std::uint32_t i) {
        if (moving[i] == stands_still) return false;
        applied[i] = {};
        return true;
    });
}

template <int D>
void WorldState<D>::move_kinematic_bodies(double dt) {
    for (const std::uint32_t i : awake) {
        if (types[i] != BodyType::kinematic) continue;
        states[i].position += dt * states[i].velocity;
        turn<D>(states[i], states[i].angular_velocity * dt);
    }
}

/// How far each body came, and where it is, once for all who ask.
template <int D>
void WorldState<D>::judge_ways(double dt) {
    outcomes.resize(awake.size());
    moved_bodies.resize(awake.size());
    each_awake([&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = awake[k];
            const BodyState<D>&from = before[k], &to = states[i];
            const BodyMass<D>& mass = masses[i];
            const double turned = mass.radius * chord_between(from.rotation, to.rotation);
            const bool far = length(to.position - from.position) + turned > seen_share * mass.core_radius;
            outcomes[k] = static_cast<std::uint8_t>((far ? went_far : 0) | (finite(to) ? 0 : went_wrong) |
                                                    (is_as_foreseen(k, turned, dt) ? 0 : went_astray));
            moved_bodies[k] = {body_slots.template id<BodyId<D>>(i), infos[i].user_data, frame_of(i)};
        }
    });
}

/// What went wrong is put back, and is not among the moved bodies.
template <int D>
void WorldState<D>::finish_bodies() {
    for (std::size_t k = 0; k < awake.size(); ++k) {
        if (!(outcomes[k] & (went_wrong | was_stopped))) continue;
        if (!finite(states[awake[k]])) {
            states[awake[k]] = before[k];
            quarantine(awake[k]);
        }
        moved_bodies[k].transform = frame_of(awake[k]);
    }
    if (quarantined.empty()) return;
    std::erase_if(moved_bodies, [&](const MovedBody<D>& moved) { return infos[moved.body.index].disabled; });
}

template void WorldState<2>::list_awake(std::uint32_t);
template void WorldState<3>::list_awake(std::uint32_t);
template bool WorldState<2>::keep_states(std::size_t);
template bool WorldState<3>::keep_states(std::size_t);
template void WorldState<2>::step(double);
template void WorldState<3>::step(double);

}  // namespace carom::detail
