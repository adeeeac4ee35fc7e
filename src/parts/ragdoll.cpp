#include "carom/parts/ragdoll.hpp"

#include <type_traits>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

std::string name_of(std::size_t bone) { return component("bones", static_cast<int>(bone)); }

template <int D>
bool can_hold_bones(const decltype(JointDefinition<D>::kind)& joint) {
    return std::holds_alternative<HingeJoint<D>>(joint) || std::holds_alternative<BallJoint<D>>(joint) ||
           std::holds_alternative<WeldJoint<D>>(joint);
}

template <int D>
void check(const RagdollDefinition<D>& figure, const RagdollPlace<D>& place) {
    if (figure.bones.empty()) throw Error("bones: there are none");
    const int count = static_cast<int>(figure.bones.size());
    for (int i = 0; i < count; ++i) {
        const Bone<D>& bone = figure.bones[static_cast<std::size_t>(i)];
        const std::string name = component("bones", i);
        if (bone.parent < -1 || bone.parent >= i)
            refuse(name + ".parent", bone.parent, "is neither -1 nor an earlier bone");
        if (bone.parent >= 0 && !can_hold_bones<D>(bone.joint))
            throw Error(name + ".joint: is not a hinge, ball or weld joint");
        if (bone.body.type != BodyType::dynamic) throw Error(name + ".body.type: is not dynamic");
    }
    for (const auto& [a, b] : figure.apart) {
        for (const int bone : {a, b}) {
            if (bone < 0 || bone >= count) refuse("apart", bone, "is not the index of a bone");
        }
        if (a == b) refuse("apart", a, "stands twice in a pair");
    }
    require_finite(place.placed.position, "placed.position");
    require_unit(place.placed.rotation, "placed.rotation");
    require_finite(place.velocity, "velocity");
}

template <int D>
BodyDefinition<D> body_of(const Bone<D>& bone, const RagdollPlace<D>& place) {
    BodyDefinition<D> body = bone.body;
    body.position = apply(place.placed, body.position);
    body.rotation = normalized(place.placed.rotation * body.rotation);
    body.velocity = rotate(place.placed.rotation, body.velocity) + place.velocity;
    body.angular_velocity = rotate_angular(place.placed.rotation, body.angular_velocity);
    for (ShapeDefinition<D>& shape : body.shapes) {
        if (shape.filter.group != 0 && place.group != 0) shape.filter.group = place.group;
    }
    return body;
}

/// The joint in the world in place of the figure's frame.
template <int D>
decltype(JointDefinition<D>::kind) placed_joint(decltype(JointDefinition<D>::kind) joint,
                                                const Transform<D>& placed) {
    std::visit(
        [&](auto& kind) {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, WeldJoint<D>>) {
                if (kind.anchor) kind.anchor = apply(placed, *kind.anchor);
            } else if constexpr (std::is_same_v<Kind, HingeJoint<D>> || std::is_same_v<Kind, BallJoint<D>>) {
                kind.anchor = apply(placed, kind.anchor);
                if constexpr (D == 3) {
                    kind.axis = rotate(placed.rotation, kind.axis);
                    if constexpr (std::is_same_v<Kind, BallJoint<D>>) {
                        if (kind.cone_axis) kind.cone_axis = rotate(placed.rotation, *kind.cone_axis);
                    }
                }
            }
        },
        joint);
    return joint;
}

/// Adds the bones one by one; what was added is taken away again when one is refused.
template <int D>
void add_bones(World<D>& world, const RagdollDefinition<D>& figure, const RagdollPlace<D>& place,
               Ragdoll<D>& made) {
    for (std::size_t i = 0; i < figure.bones.size(); ++i) {
        const Bone<D>& bone = figure.bones[i];
        try {
            made.bodies.push_back(world.add_body(body_of(bone, place)));
            std::optional<JointId<D>> joint;
            if (bone.parent >= 0) {
                JointDefinition<D> definition;
                definition.kind = placed_joint<D>(bone.joint, place.placed);
                definition.a = made.bodies[static_cast<std::size_t>(bone.parent)];
                definition.b = made.bodies.back();
                joint = world.add_joint(definition);
            }
            made.joints.push_back(joint);
        } catch (const Error& error) {
            remove_ragdoll(world, made);
            throw Error(name_of(i) + ": " + error.what());
        }
        made.parents.push_back(bone.parent);
    }
}

}  // namespace

template <int D>
Ragdoll<D> add_ragdoll(World<D>& world, const RagdollDefinition<D>& definition,
                       const RagdollPlace<D>& place) {
    check(definition, place);
    Ragdoll<D> made;
    add_bones(world, definition, place, made);
    for (const auto& [a, b] : definition.apart)
        world.set_collision(made.bodies[static_cast<std::size_t>(a)],
                            made.bodies[static_cast<std::size_t>(b)], false);
    made.muscles.resize(made.bodies.size());
    return made;
}

template <int D>
void remove_ragdoll(World<D>& world, const Ragdoll<D>& ragdoll) {
    for (const BodyId<D> body : ragdoll.bodies) world.remove_body(body);
}

template <int D>
std::vector<Rotation<D>> pose_of(const World<D>& world, const Ragdoll<D>& ragdoll) {
    std::vector<Rotation<D>> pose;
    for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i) {
        const Rotation<D> own = world.rotation(ragdoll.bodies[i]);
        const int parent = ragdoll.parents[i];
        pose.push_back(parent < 0
                           ? own
                           : inverse(world.rotation(ragdoll.bodies[static_cast<std::size_t>(parent)])) * own);
    }
    return pose;
}

template <int D>
void drive_to_pose(World<D>& world, Ragdoll<D>& ragdoll, std::span<const Rotation<D>> pose,
                   const Muscles& muscles) {
    if (pose.size() != ragdoll.bodies.size())
        throw Error("pose: " + std::to_string(pose.size()) + " turns for " +
                    std::to_string(ragdoll.bodies.size()) + " bones");
    require_positive(muscles.frequency, "frequency");
    require_not_negative(muscles.damping_ratio, "damping_ratio");
    if (!(muscles.max_torque >= 0)) refuse("max_torque", muscles.max_torque, "is negative");
    for (std::size_t i = 0; i < pose.size(); ++i)
        require_unit(pose[i], component("pose", static_cast<int>(i)));
    for (std::size_t i = 0; i < pose.size(); ++i) {
        if (!ragdoll.joints[i] || !world.contains(*ragdoll.joints[i])) continue;
        MotorJoint<D> motor;
        motor.rotation = pose[i];
        motor.frequency = muscles.frequency;
        motor.damping_ratio = muscles.damping_ratio;
        motor.max_force = 0;
        motor.max_torque = muscles.max_torque;
        std::optional<JointId<D>>& muscle = ragdoll.muscles[i];
        if (muscle && world.contains(*muscle)) {
            world.set_joint(*muscle, motor);
        } else {
            JointDefinition<D> definition;
            definition.kind = motor;
            definition.a = ragdoll.bodies[static_cast<std::size_t>(ragdoll.parents[i])];
            definition.b = ragdoll.bodies[i];
            muscle = world.add_joint(definition);
        }
    }
}

template <int D>
void relax(World<D>& world, Ragdoll<D>& ragdoll) {
    for (std::optional<JointId<D>>& muscle : ragdoll.muscles) {
        if (muscle && world.contains(*muscle)) world.remove_joint(*muscle);
        muscle.reset();
    }
}

template Ragdoll<2> add_ragdoll(World<2>&, const RagdollDefinition<2>&, const RagdollPlace<2>&);
template Ragdoll<3> add_ragdoll(World<3>&, const RagdollDefinition<3>&, const RagdollPlace<3>&);
template void remove_ragdoll(World<2>&, const Ragdoll<2>&);
template void remove_ragdoll(World<3>&, const Ragdoll<3>&);
template std::vector<Rotation<2>> pose_of(const World<2>&, const Ragdoll<2>&);
template std::vector<Rotation<3>> pose_of(const World<3>&, const Ragdoll<3>&);
template void drive_to_pose(World<2>&, Ragdoll<2>&, std::span<const Rotation<2>>, const Muscles&);
template void drive_to_pose(World<3>&, Ragdoll<3>&, std::span<const Rotation<3>>, const Muscles&);
template void relax(World<2>&, Ragdoll<2>&);
template void relax(World<3>&, Ragdoll<3>&);

}  // namespace carom
