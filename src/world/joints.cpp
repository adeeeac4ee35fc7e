#include <algorithm>
#include <cmath>

#include "geometry/curve.hpp"
#include "joints/couplings.hpp"
#include "joints/path.hpp"
#include "joints/types.hpp"
#include "math/check.hpp"
#include "world/state.hpp"

// Joints: adding and removing them, changing and reading them, and what a step does about them.

namespace carom {

using namespace detail;

namespace detail {

template <int D>
std::uint32_t WorldState<D>::index(JointId<D> joint) const {
    if (!joint_slots.contains(joint)) throw Error("joint: the handle names nothing in this world");
    return joint.index;
}

/// To where the joint is in the middle of the step, so that its rows lie along the chord of the way.
template <int D>
void WorldState<D>::follow(JointRecord<D>& joint, double dt) const {
    const Vec<D> anchor = apply(frame_of(joint.body_b), joint.anchor_b);
    const auto velocity = [&](std::uint32_t body) {
        const BodyState<D>& s = states[body];
        return s.velocity + cross(s.angular_velocity, anchor - s.position);
    };
    const Vec<D> ahead = (0.5 * dt) * velocity(joint.body_b);
    if (joint.body_a == no_body) return follow_path(joint, anchor + ahead);
    const Vec<D> behind = (0.5 * dt) * velocity(joint.body_a);
    follow_path(joint, apply_inverse(frame_of(joint.body_a), anchor + (ahead - behind)));
}

/// Something is about to change of which joints there are, of what is fixed about one, or of its bodies'
/// masses.
template <int D>
void WorldState<D>::expect_other_joints() {
    joints_are_listed = false;
    solver.let_joints_go(joints);
}

/// The joints of bodies that move freely. These bodies are the solver's and do not fly.
template <int D>
void WorldState<D>::list_active_joints() {
    if (joints_are_listed) return;
    joints_are_listed = true;
    path_joints.clear();
    active_joints.clear();
    active_couplings.clear();
    breakable_joints.clear();
    const auto is_free = [&](std::uint32_t body) { return body != no_body && moving[body] == moves_freely; };
    const auto is_active = [&](const JointRecord<D>& joint) {
        return is_free(joint.body_a) || is_free(joint.body_b);
    };
    for (const JointId<D>& id : joint_ids) {
        const JointRecord<D>& joint = joints[id.index];
        if (joint.layout == no_layout || !is_active(joint)) continue;
        active_joints.push_back(id.index);
        if (joint.path.curve) path_joints.push_back(id.index);
    }
    for (std::uint32_t i = 0; i < couplings.size(); ++i) {
        if (is_active(couplings[i].ends[0]) || is_active(couplings[i].ends[1])) active_couplings.push_back(i);
    }
    const auto list_breakable = [&](std::uint32_t i) {
        const JointDefinition<D>& joint = joint_definitions[i];
        if (std::isinf(joint.break_force) && std::isinf(joint.break_torque)) return;
        breakable_joints.push_back(i);
    };
    for (const std::uint32_t i : active_joints) list_breakable(i);
    for (const std::uint32_t i : active_couplings) list_breakable(couplings[i].joint);
}

template <int D>
void WorldState<D>::follow_paths(double dt) {
    for (const std::uint32_t i : path_joints) follow(joints[i], dt);
}

/// Who hangs on something that moves does not sleep.
template <int D>
void WorldState<D>::wake_jointed() {
    for (const std::uint32_t i : awake) {
        bonds.each(i, [&](std::uint32_t, std::uint32_t other) {
            if (moving[other] == stands_still) wake(other);
        });
    }
}

template <int D>
void WorldState<D>::break_joints(double dt) {
    std::vector<std::uint32_t> broken;
    for (const std::uint32_t i : breakable_joints) {
        const JointDefinition<D>& joint = joint_definitions[i];
        const Load<D> load = joint_load(i, dt);
        const double force = length(load.force), torque = std::sqrt(angular_dot(load.torque, load.torque));
        if (force <= joint.break_force && torque <= joint.break_torque) continue;
        events.joint_breaks.push_back(
            {joint_slots.template id<JointId<D>>(i), joint.a, joint.b, force, torque});
        broken.push_back(i);
    }
    for (const std::uint32_t i : broken) {
        if (joint_slots.in_use(i)) remove_joint(i);
    }
}

/// Force on b and torque about its anchor, on the average of the last step.
template <int D>
Load<D> WorldState<D>::joint_load(std::uint32_t joint, double dt) const {
    if (dt == 0) return {};
    JointRecord<D> j;
    j.total = joints[joint].total;
    solver.read_joint(joint, j);
    const double rate = 1 / dt;
    const Vec<D> force = rate * narrow<double>(j.total.force);
    const Angular<D> torque = narrow<double>(j.total.on_b) * rate;
    return {force, torque - cross(joint_pose(joint).arm_b, force)};
}

namespace {

template <class Joint>
void change_ignored(Joint& jointed, std::uint32_t other, bool add) {
    const auto place = std::ranges::lower_bound(jointed, other);
    if (add)
        jointed.insert(place, other);
    else
        jointed.erase(place);
}

/// The joint begins or ceases to keep its bodies from touching.
template <int D>
void part(WorldState<D>& w, const JointRecord<D>& joint, bool begins) {
    const std::uint32_t a = joint.body_a, b = joint.body_b;
    if (a == no_body) return;
    change_ignored(w.infos[a].own().jointed, b, begins);
    change_ignored(w.infos[b].own().jointed, a, begins);
    if (begins) {
        w.remove_contacts_between(a, b);
    } else {
        for (const ShapeId<D>& id : w.infos[a].shapes) w.meet_anew(id.index);
    }
}

template <int D>
void wake_both(WorldState<D>& w, const JointRecord<D>& joint) {
    if (joint.body_a != no_body) w.wake(joint.body_a);
    w.wake(joint.body_b);
}

}  // namespace

template <int D>
const CouplingRecord<D>* WorldState<D>::coupling_of(std::uint32_t joint) const {
    const auto found = std::ranges::find(couplings, joint, &CouplingRecord<D>::joint);
    return found == couplings.end() ? nullptr : &*found;
}

template <int D>
void WorldState<D>::remove_joint(std::uint32_t joint) {
    const JointId<D> id = joint_slots.template id<JointId<D>>(joint);
    for (std::size_t i = 0; i < couplings.size();) {
        const std::uint32_t other = couplings[i].joint;
        const bool names_it = std::visit(
            [&](const auto& kind) {
                if constexpr (requires { kind.joint_a; }) return kind.joint_a == id || kind.joint_b == id;
                return false;
            },
            joint_definitions[other].kind);
        names_it&& other != joint ? remove_joint(other) : void(++i);
    }
    std::erase_if(couplings, [&](const CouplingRecord<D>& c) { return c.joint == joint; });
    expect_other_joints();
    const JointRecord<D>& record = joints[joint];
    wake_both(*this, record);
    if (record.body_a != no_body) bonds.remove(joint);
    if (!joint_definitions[joint].collide) part(*this, record, false);
    std::erase(joint_ids, id);
    joint_slots.release(joint);
    joints[joint] = {};
    joint_definitions[joint] = {};
}

template <int D>
void WorldState<D>::remove_joints_of(std::uint32_t body) {
    std::vector<std::uint32_t> own;
    for (const JointId<D>& id : joint_ids) {
        if (joints[id.index].body_a == body || joints[id.index].body_b == body) own.push_back(id.index);
    }
    for (const std::uint32_t i : own) {
        if (joint_slots.in_use(i)) remove_joint(i);  // it may have gone with another
    }
}

}  // namespace detail

namespace {

template <int D>
void validate(const JointDefinition<D>& joint) {
    if (!(joint.break_force > 0)) refuse("break_force", joint.break_force, "is not positive");
    if (!(joint.break_torque > 0)) refuse("break_torque", joint.break_torque, "is not positive");
}

/// Throws `Error` unless the joint can push one of its bodies.
template <int D>
void validate_bodies(const WorldState<D>& w, const JointDefinition<D>& joint) {
    const std::uint32_t b = w.index(joint.b);
    const bool a_moves = joint.a && w.types[w.index(*joint.a)] == BodyType::dynamic;
    if (joint.a && joint.a->index == b) throw Error("a: a body is not joined to itself");
    if (!a_moves && w.types[b] != BodyType::dynamic)
        throw Error("b: one of the two bodies has to be dynamic");
}

template <int D>
JointSite<D> site_of(const WorldState<D>& w, const JointDefinition<D>& joint) {
    JointSite<D> site;
    const std::uint32_t b = joint.b.index;
    site.b = w.frame_of(b);
    site.center_b = w.states[b].position;
    if constexpr (D == 2) site.angle = whole_angle(w.states[b]);
    if (joint.a) {
        const std::uint32_t a = joint.a->index;
        site.a = w.frame_of(a);
        site.center_a = w.states[a].position;
        if constexpr (D == 2) site.angle -= whole_angle(w.states[a]);
    }
    return site;
}

template <int D>
double sum_of(const WorldState<D>& w, const CouplingRecord<D>& coupling) {
    double sum = 0;
    for (int k = 0; k < 2; ++k) {
        const JointRecord<D>& end = coupling.ends[k];
        sum += coupling.factors[k] * measure(end.drives[0], pose_of<D>(end, w.states, w.masses)).value;
    }
    return sum;
}

/// What is to be added for a joint: rows of its own, or a coupling.
template <int D>
struct NewJoint {
    JointRecord<D> record;
    std::optional<CouplingRecord<D>> coupling;
};

template <int D, class Kind>
NewJoint<D> make_joint(const WorldState<D>& w, const JointDefinition<D>& joint, const Kind& kind) {
    validate_bodies(w, joint);
    const JointSite<D> site = site_of(w, joint);
    NewJoint<D> made;
    if constexpr (std::is_same_v<Kind, PulleyJoint<D>>) {
        if (!joint.a) throw Error("a: a pulley has two bodies");
        made.coupling = couple(kind, site);
        made.coupling->ends[0].body_b = joint.a->index;
        made.coupling->ends[1].body_b = joint.b.index;
        made.record.layout = no_layout;
        made.record.anchor_a = made.coupling->ends[0].anchor_b;
        made.record.anchor_b = made.coupling->ends[1].anchor_b;
    } else {
        made.record = place(kind, site);
        configure(kind, made.record);
    }
    made.record.body_a = joint.a ? joint.a->index : no_body;
    made.record.body_b = joint.b.index;
    return made;
}

/// A gear or a rack.
template <int D, class Kind>
requires requires(const Kind& kind) { kind.joint_a; }
NewJoint<D> make_joint(const WorldState<D>& w, const JointDefinition<D>& joint, const Kind& kind) {
    if (joint.a || joint.b) throw Error("b: a gear or rack names joints and no bodies");
    const auto find = [&](JointId<D> id, const char* field) -> CoupledJoint<D> {
        if (!w.joint_slots.contains(id))
            throw Error(std::string(field) + ": the handle names nothing in this world");
        return {w.joint_definitions[id.index], w.joints[id.index]};
    };
    const CoupledJoint<D> a = find(kind.joint_a, "joint_a"), b = find(kind.joint_b, "joint_b");
    if (a.record.body_b == b.record.body_b) throw Error("joint_b: turns the same body as joint_a");
    NewJoint<D> made;
    made.coupling = couple(kind, a, b);
    made.record.layout = no_layout;
    made.record.body_a = a.record.body_b;
    made.record.body_b = b.record.body_b;
    made.record.anchor_a = a.record.anchor_b;
    made.record.anchor_b = b.record.anchor_b;
    return made;
}

template <int D>
NewJoint<D> make_joint(const WorldState<D>& w, const JointDefinition<D>& joint) {
    validate(joint);
    NewJoint<D> made = std::visit([&](const auto& kind) { return make_joint(w, joint, kind); }, joint.kind);
    if (made.coupling) made.coupling->sum = sum_of(w, *made.coupling);
    return made;
}

}  // namespace

template <int D>
JointId<D> World<D>::add_joint(const JointDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    NewJoint<D> made = make_joint(w, definition);
    w.expect_other_joints();
    const std::uint32_t i = w.joint_slots.acquire();
    if (i == w.joints.size()) {
        w.joints.emplace_back();
        w.joint_definitions.emplace_back();
    }
    w.joints[i] = std::move(made.record);
    w.joint_definitions[i] = definition;
    if (made.coupling) {
        made.coupling->joint = i;
        w.couplings.push_back(std::move(*made.coupling));
    }
    const auto id = w.joint_slots.template id<JointId<D>>(i);
    w.joint_ids.push_back(id);
    if (w.joints[i].body_a != no_body) w.bonds.add(i, w.joints[i].body_a, w.joints[i].body_b);
    if (!definition.collide) part(w, w.joints[i], true);
    wake_both(w, w.joints[i]);
    return id;
}

template <int D>
void World<D>::remove_joint(JointId<D> joint) {
    state_->remove_joint(state_->index(joint));
}

template <int D>
void World<D>::set_joint(JointId<D> joint, const decltype(JointDefinition<D>::kind)& kind) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(joint);
    if (kind.index() != w.joint_definitions[i].kind.index())
        throw Error("kind: the joint is of another type");
    if (w.coupling_of(i)) throw Error("kind: pulleys, gears and racks do not change");
    w.expect_other_joints();
    JointRecord<D> changed = w.joints[i];
    std::visit(
        [&](const auto& k) {
            if constexpr (requires { configure(k, changed); }) configure(k, changed);
        },
        kind);
    w.joints[i] = std::move(changed);
    w.joint_definitions[i].kind = kind;
    wake_both(w, w.joints[i]);
}

namespace {

/// Changes one member of the joint's type with `change`, which says whether it has that.
template <int D, class Change>
void change_kind(World<D>& world, JointId<D> joint, const char* what, const Change& change) {
    auto kind = world.joint(joint).kind;
    const bool has = std::visit([&](auto& k) { return change(k); }, kind);
    if (!has) throw Error(std::string(what) + ": joints of this type have none");
    world.set_joint(joint, kind);
}

}  // namespace

template <int D>
void World<D>::set_motor(JointId<D> joint, const std::optional<JointMotor>& motor) {
    change_kind(*this, joint, "motor", [&](auto& kind) {
        constexpr bool has = requires { kind.motor; };
        if constexpr (has) kind.motor = motor;
        return has;
    });
}

template <int D>
void World<D>::set_spring(JointId<D> joint, const std::optional<JointSpring>& spring) {
    change_kind(*this, joint, "spring", [&](auto& kind) {
        constexpr bool has = requires { kind.spring; };
        if constexpr (has) kind.spring = spring;
        return has;
    });
}

template <int D>
void World<D>::set_limits(JointId<D> joint, const std::optional<JointLimits>& limits) {
    change_kind(*this, joint, "limits", [&](auto& kind) {
        constexpr bool has = requires { kind.limits; };
        if constexpr (has) kind.limits = limits;
        return has;
    });
}

template <int D>
void World<D>::set_steering(JointId<D> joint, const std::optional<JointMotor>& steering) requires(D == 3) {
    change_kind(*this, joint, "steering", [&](auto& kind) {
        constexpr bool has = requires { kind.steering; };
        if constexpr (has) kind.steering = steering;
        return has;
    });
}

template <int D>
void World<D>::set_target(JointId<D> joint, const Vec<D>& target) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(joint);
    auto* kind = std::get_if<TargetJoint<D>>(&w.joint_definitions[i].kind);
    if (!kind) throw Error("target: joints of this type have none");
    require_finite(target, "target");
    kind->target = target;
    JointRecord<D>& record = w.joints[i];
    record.anchor_a = record.body_a == no_body ? target : apply_inverse(w.frame_of(record.body_a), target);
    wake_both(w, record);
}

template <int D>
bool World<D>::contains(JointId<D> joint) const {
    return state_->joint_slots.contains(joint);
}
template <int D>
std::span<const JointId<D>> World<D>::joints() const {
    return state_->joint_ids;
}
template <int D>
const JointDefinition<D>& World<D>::joint(JointId<D> joint) const {
    return state_->joint_definitions[state_->index(joint)];
}
template <int D>
std::span<const JointBreak<D>> World<D>::joint_breaks() const {
    return state_->events.joint_breaks;
}

namespace {

/// The anchor of b, and the point of the path that is nearest to it.
template <int D>
std::array<Vec<D>, 2> anchors_on_path(const WorldState<D>& w, const JointRecord<D>& joint) {
    const Transform<D> a = joint.body_a == no_body ? Transform<D>{} : w.frame_of(joint.body_a);
    const Vec<D> b = apply(w.frame_of(joint.body_b), joint.anchor_b);
    const Curve<D>& curve = *joint.path.curve;
    return {apply(a, curve.at(curve.nearest(apply_inverse(a, b), joint.path.place)).point), b};
}

}  // namespace

template <int D>
std::array<Vec<D>, 2> World<D>::anchors(JointId<D> joint) const {
    const std::uint32_t i = state_->index(joint);
    const JointRecord<D>& j = state_->joints[i];
    if (j.path.curve) return anchors_on_path(*state_, j);
    const Vec<D> a = j.body_a == no_body ? j.anchor_a : apply(state_->frame_of(j.body_a), j.anchor_a);
    return {a, apply(state_->frame_of(j.body_b), j.anchor_b)};
}

template <int D>
double World<D>::coordinate(JointId<D> joint) const {
    const std::uint32_t i = state_->index(joint);
    if (const CouplingRecord<D>* coupling = state_->coupling_of(i)) return sum_of(*state_, *coupling);
    if (state_->joints[i].drives.empty()) throw Error("coordinate: joints of this type have none");
    return measure(state_->joints[i].drives[0], state_->joint_pose(i)).value;
}

template <int D>
double World<D>::coordinate_speed(JointId<D> joint) const {
    const std::uint32_t i = state_->index(joint);
    if (const CouplingRecord<D>* coupling = state_->coupling_of(i)) {
        double sum = 0;
        for (int k = 0; k < 2; ++k) {
            const JointRecord<D>& end = coupling->ends[k];
            sum += coupling->factors[k] *
                   measure(end.drives[0], pose_of<D>(end, state_->states, state_->masses)).speed;
        }
        return sum;
    }
    if (state_->joints[i].drives.empty()) throw Error("coordinate: joints of this type have none");
    return measure(state_->joints[i].drives[0], state_->joint_pose(i)).speed;
}

template <int D>
double World<D>::linear_error(JointId<D> joint) const {
    const std::uint32_t i = state_->index(joint);
    const CouplingRecord<D>* coupling = state_->coupling_of(i);
    if (!coupling) return errors(state_->joints[i], state_->joint_pose(i)).linear;
    const bool is_angle = std::holds_alternative<GearJoint<D>>(state_->joint_definitions[i].kind);
    const double error = sum_of(*state_, *coupling) - coupling->sum;
    if (coupling->is_rope) return std::max(error, 0.0);
    return is_angle ? 0 : std::fabs(error);
}

template <int D>
double World<D>::angular_error(JointId<D> joint) const {
    const std::uint32_t i = state_->index(joint);
    const CouplingRecord<D>* coupling = state_->coupling_of(i);
    if (!coupling) return errors(state_->joints[i], state_->joint_pose(i)).angular;
    const bool is_angle = std::holds_alternative<GearJoint<D>>(state_->joint_definitions[i].kind);
    return is_angle ? std::fabs(sum_of(*state_, *coupling) - coupling->sum) : 0;
}

template <int D>
Vec<D> World<D>::joint_force(JointId<D> joint) const {
    return state_->joint_load(state_->index(joint), state_->last_step).force;
}
template <int D>
Angular<D> World<D>::joint_torque(JointId<D> joint) const {
    return state_->joint_load(state_->index(joint), state_->last_step).torque;
}

// The members defined in this file.
template class World<2>;
template class World<3>;

#define CAROM_INSTANTIATE(D)                                    \
    template void detail::WorldState<D>::expect_other_joints(); \
    template void detail::WorldState<D>::list_active_joints();  \
    template void detail::WorldState<D>::follow_paths(double);  \
    template void detail::WorldState<D>::wake_jointed();        \
    template void detail::WorldState<D>::break_joints(double);  \
    template void detail::WorldState<D>::remove_joints_of(std::uint32_t);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom
