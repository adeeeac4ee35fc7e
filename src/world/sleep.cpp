#include <algorithm>
#include <cmath>

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
    each_contact_of(body, [&](std::uint32_t contact) {
        const ContactRecord<D>& c = contacts[contact];
        wake(c.body_a == body ? c.body_b : c.body_a);
    });
    bonds.each(body, [&](std::uint32_t, std::uint32_t other) { wake(other); });
    wake(body);
}

/// Calls `visit(other)` for the bodies that can be moved and touch this one or are tied to it by a joint or a
/// spring.
template <int D>
template <class Visit>
void WorldState<D>::each_tied(std::uint32_t body, const Visit& visit) const {
    each_contact_of(body, false, [&](std::uint32_t contact) {
        const ContactRecord<D>& c = contacts[contact];
        if (c.count > 0) visit(c.body_a == body ? c.body_b : c.body_a);
    });
    bonds.each(body, [&](std::uint32_t, std::uint32_t other) { visit(other); });
    forces.each_tied(body, visit);
}

/// Wakes all that hangs together with a body of `to_wake`.
template <int D>
void WorldState<D>::wake_islands() {
    for (std::size_t i = 0; i < to_wake.size(); ++i)  // grows on the way
        each_tied(to_wake[i], [&](std::uint32_t other) { wake(other); });
    roused.insert(roused.end(), to_wake.begin(), to_wake.end());
    to_wake.clear();
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
    std::ranges::sort(roused);
    const std::size_t listed = awake.size();
    for (const std::uint32_t i : roused) list_awake(i);
    roused.clear();
    keep_states(listed);
    follow_bodies();
}

namespace {

/// The greatest speed that a point of the body may have.
template <int D>
double outer_speed(const BodyState<D>& s, double radius) {
    return length(s.velocity) + std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity)) * radius;
}

/// How far the body came since it was last known to be at rest: its way, and that of its outermost point as
/// it turned.
template <int D>
double way_since_rest(const BodyState<D>& s, const BodyInfo<D>& info, double radius) {
    return length(s.position - info.rest.position) + radius * chord_between(info.rest.rotation, s.rotation);
}

}  // namespace

/// Keeps the account of how long the body has been at rest; true when that is long enough to fall asleep.
template <int D>
bool WorldState<D>::note_rest(std::uint32_t body, double dt) {
    const BodyState<D>& s = states[body];
    BodyInfo<D>& info = infos[body];
    if (types[body] != BodyType::dynamic || info.disabled) return false;
    const double radius = masses[body].radius;
    const bool slow = outer_speed(s, radius) < sleep_speed;
    if (!slow || !info.can_sleep || info.rest_time == 0 || way_since_rest(s, info, radius) > sleep_way) {
        info.rest = {s.position, s.rotation};
        info.rest_time = slow && info.can_sleep ? dt : 0;
    } else {
        info.rest_time += dt;
    }
    return info.rest_time >= time_to_sleep;
}

/// An island falls asleep when each of its bodies has been slow, and has stayed in its place, for a while.
/// Both are asked, so that a slow creep down a slope is not taken for rest.
template <int D>
void WorldState<D>::fall_asleep(double dt) {
    if (!definition.sleep) return;
    rest.resize(awake.size());
    each_awake([&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            rest[k] = note_rest(awake[k], dt) ? Rest::possible : Rest::none;
    });
    for (std::size_t k = 0; k < awake.size(); ++k) {
        if (rest[k] != Rest::possible) continue;
        const bool rests = gather_resting(awake[k]);
        for (const std::uint32_t i : island) {
            if (!rests) {
                rest[place[i]] = Rest::none;
                continue;
            }
            infos[i].awake = false;
            states[i].velocity = {};
            states[i].angular_velocity = {};
        }
    }
}

/// Fills `island` with the bodies that hang together with this one; false as soon as one turns up that does
/// not rest, as what lies on a moving platform does not. So a restless pile is not walked through in each
/// step.
template <int D>
bool WorldState<D>::gather_resting(std::uint32_t body) {
    island.assign(1, body);
    rest[place[body]] = Rest::seen;
    bool all = true;
    for (std::size_t i = 0; all && i < island.size(); ++i) {
        each_tied(island[i], [&](std::uint32_t other) {
            if (moving[other] == stands_still) return;
            Rest& its = rest[place[other]];
            if (its == Rest::none) all = false;
            if (its != Rest::possible) return;
            its = Rest::seen;
            island.push_back(other);
        });
    }
    return all;
}

namespace {

/// Does a motor of the joint push the body about?
template <int D>
bool drives(const JointDefinition<D>& joint, BodyId<D> body) {
    if (joint.b != body && joint.a != body) return false;
    const auto pushes = [](const std::optional<JointMotor>& motor) {
        return motor && motor->max > 0 && (motor->speed != 0 || motor->target);
    };
    const auto visit = [&](const auto& kind) {
        using Kind = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<Kind, MotorJoint<D>> || std::is_same_v<Kind, TargetJoint<D>>)
            return true;
        else if constexpr (requires { kind.motor; })
            return pushes(kind.motor);
        else
            return false;
    };
    return std::visit(visit, joint.kind);
}

/// What about the body itself keeps it awake: nothing where it has rested long enough, or does not count.
template <int D>
Wakefulness own_reason(const WorldState<D>& w, std::uint32_t body) {
    if (!w.is_moving(body)) return Wakefulness::none;
    if (w.types[body] != BodyType::dynamic) return Wakefulness::moving;
    const BodyInfo<D>& info = w.infos[body];
    if (!w.definition.sleep || !info.can_sleep) return Wakefulness::sleep_off;
    if (outer_speed(w.states[body], w.masses[body].radius) < sleep_speed)
        return info.rest_time < time_to_sleep ? Wakefulness::settling : Wakefulness::none;
    const BodyId<D> id = w.body_slots.template id<BodyId<D>>(body);
    const bool driven = std::ranges::any_of(
        w.joint_ids, [&](JointId<D> joint) { return drives<D>(w.joint_definitions[joint.index], id); });
    return driven ? Wakefulness::driven : Wakefulness::moving;
}

}  // namespace
}  // namespace carom::detail

namespace carom {

template <int D>
AwakeReason<D> World<D>::awake_reason(BodyId<D> body) const {
    const detail::WorldState<D>& w = *state_;
    const std::uint32_t start = w.index(body);
    if (w.types[start] != BodyType::dynamic || !w.is_awake(start)) return {};
    if (const Wakefulness own = detail::own_reason(w, start); own != Wakefulness::none) return {own};
    // Outwards through what hangs together, until a body turns up that does not rest.
    std::vector<std::uint32_t> island{start};
    std::vector<bool> seen(w.states.size());
    seen[start] = true;
    AwakeReason<D> reason{Wakefulness::settling};
    for (std::size_t i = 0; i < island.size() && !reason.because_of; ++i)
        w.each_tied(island[i], [&](std::uint32_t other) {
            if (seen[other] || !w.is_moving(other) || reason.because_of) return;
            seen[other] = true;
            island.push_back(other);
            if (detail::own_reason(w, other) != Wakefulness::none)
                reason = {Wakefulness::neighbour, w.body_slots.template id<BodyId<D>>(other)};
        });
    return reason;
}

template AwakeReason<2> World<2>::awake_reason(BodyId<2>) const;
template AwakeReason<3> World<3>::awake_reason(BodyId<3>) const;

}  // namespace carom

namespace carom::detail {

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
