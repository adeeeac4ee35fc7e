#include <algorithm>
#include <cmath>

#include "world/bonds.hpp"
#include "world/state.hpp"

namespace carom::detail {

template <int D>
void WorldState<D>::wake(std::uint32_t body) {
    infos[body].rest_time = 0;
    if (infos[body].awake || types[body] != BodyType::dynamic) return;
    infos[body].awake = true;
    to_wake.push_back(body);
}

template <int D>
void WorldState<D>::wake_all() {
    for (const std::uint32_t i : movable) wake(i);
}

template <int D>
void WorldState<D>::wake_neighbours(std::uint32_t body) {
    for (const ContactRecord<D>& c : contacts) {
        if (c.body_a == body) wake(c.body_b);
        if (c.body_b == body) wake(c.body_a);
    }
    each_bond([&](std::uint32_t a, std::uint32_t b) {
        if (a == body) wake(b);
        if (b == body) wake(a);
    });
    wake(body);
}

/// Joins the dynamic bodies that touch, or that a joint or a spring ties together.
template <int D>
void WorldState<D>::join_islands() {
    islands.reset(states.size());
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (types[a] == BodyType::dynamic && types[b] == BodyType::dynamic) islands.join(a, b);
    };
    for (const ContactRecord<D>& c : contacts) {
        if (c.count > 0) join(c.body_a, c.body_b);
    }
    forces.each_spring(join);
    each_bond(join);
}

/// Wakes all that hangs together with a body of `to_wake`.
template <int D>
void WorldState<D>::wake_islands() {
    if (to_wake.empty()) return;
    join_islands();
    std::vector<std::uint8_t> rouse(states.size(), 0);
    for (const std::uint32_t i : to_wake) rouse[islands.root(i)] = 1;
    to_wake.clear();
    for (const std::uint32_t i : movable) {
        if (types[i] != BodyType::dynamic || infos[i].awake || !rouse[islands.root(i)]) continue;
        infos[i].awake = true;
        infos[i].rest_time = 0;
    }
}

/// A sleeper wakes when something that moves touches it, or is about to within this step.
template <int D>
void WorldState<D>::wake_touched(double dt) {
    if (awake.size() == movable.size()) return;  // nobody sleeps
    for (const std::uint32_t contact : loose) {
        const ContactRecord<D>& c = contacts[contact];
        if (c.count == 0 || (moving[c.body_a] == stands_still) == (moving[c.body_b] == stands_still))
            continue;
        const bool sleeper_a = types[c.body_a] == BodyType::dynamic && !is_awake(c.body_a);
        const bool sleeper_b = types[c.body_b] == BodyType::dynamic && !is_awake(c.body_b);
        if (!sleeper_a && !sleeper_b) continue;
        const Vec<D> approach = states[c.body_b].velocity - states[c.body_a].velocity;
        const double closing = dt * std::max(0.0, -dot(narrow<double>(c.normal), approach));
        for (int i = 0; i < c.count; ++i) {
            if (c.points[i].separation > closing) continue;
            wake(sleeper_a ? c.body_a : c.body_b);
            break;
        }
    }
    wake_jointed();
    if (to_wake.empty()) return;
    wake_islands();
    for (const std::uint32_t i : movable) {
        if (types[i] == BodyType::dynamic && is_awake(i) && moving[i] == stands_still) list_awake(i);
    }
    follow_bodies();
}

namespace {

/// How far the body came since it was last known to be at rest: its way, and that of its outermost point as
/// it turned (2 sin of half the angle, times the radius).
template <int D>
double way_since_rest(const BodyState<D>& s, const BodyInfo<D>& info, double radius) {
    const Rotation<D> turn = s.rotation * inverse(info.rest.rotation);
    double chord;
    if constexpr (D == 2) {
        chord = std::fabs(turn.s) + (turn.c < 0 ? 1 : 0);
    } else {
        chord = 2 * std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
    }
    return length(s.position - info.rest.position) + radius * chord;
}

}  // namespace

/// An island falls asleep when each of its bodies has been slow, and has stayed in its place, for a while.
/// Both are asked, so that a slow creep down a slope is not taken for rest.
template <int D>
void WorldState<D>::fall_asleep(double dt) {
    if (!definition.sleep) return;
    bool any = false;
    for (const std::uint32_t i : awake) {
        if (types[i] != BodyType::dynamic || infos[i].disabled) continue;
        const BodyState<D>& s = states[i];
        BodyInfo<D>& info = infos[i];
        const double radius = masses[i].radius;
        const double spin = std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity));
        const bool slow = length(s.velocity) + spin * radius < sleep_speed;
        if (!slow || !info.can_sleep || info.rest_time == 0 || way_since_rest(s, info, radius) > sleep_way) {
            info.rest = {s.position, s.rotation};
            info.rest_time = slow && info.can_sleep ? dt : 0;
        } else {
            info.rest_time += dt;
        }
        any |= info.rest_time >= time_to_sleep;
    }
    if (!any) return;

    join_islands();
    std::vector<std::uint8_t> restless(states.size(), 0);
    for (const std::uint32_t i : awake) {
        if (types[i] == BodyType::dynamic && infos[i].rest_time < time_to_sleep)
            restless[islands.root(i)] = 1;
    }
    for (const ContactRecord<D>& c : contacts) {  // what lies on a moving platform stays awake
        if (c.count == 0) continue;
        if (types[c.body_a] == BodyType::kinematic && is_moving(c.body_a))
            restless[islands.root(c.body_b)] = 1;
        if (types[c.body_b] == BodyType::kinematic && is_moving(c.body_b))
            restless[islands.root(c.body_a)] = 1;
    }
    each_bond([&](std::uint32_t a, std::uint32_t b) {
        if (types[a] == BodyType::kinematic && is_moving(a)) restless[islands.root(b)] = 1;
        if (types[b] == BodyType::kinematic && is_moving(b)) restless[islands.root(a)] = 1;
    });
    for (const std::uint32_t i : awake) {
        if (types[i] != BodyType::dynamic || infos[i].disabled || restless[islands.root(i)]) continue;
        infos[i].awake = false;
        states[i].velocity = {};
        states[i].angular_velocity = {};
    }
}

#define CAROM_INSTANTIATE(D)                                     \
    template void WorldState<D>::wake(std::uint32_t);            \
    template void WorldState<D>::wake_all();                     \
    template void WorldState<D>::wake_neighbours(std::uint32_t); \
    template void WorldState<D>::wake_islands();                 \
    template void WorldState<D>::wake_touched(double);           \
    template void WorldState<D>::fall_asleep(double);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
