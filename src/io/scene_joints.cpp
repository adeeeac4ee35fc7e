#include <fmt/format.h>

#include <array>
#include <set>

#include "io/names.hpp"
#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

template <int D>
using Kind = decltype(JointDefinition<D>::kind);

/// Names that joints may mention.
struct Names {
    const IndexByName& bodies;
    IndexByName& joints;
};

/// Positive and finite numbers; `what` says what is wrong with others.
Field positive(std::string_view key, double& target) {
    return {key, [&target](const Value& value) {
                read(value, target);
                if (!(target > 0)) value.refuse("is not positive");
            }};
}

void read_limits(const Value& value, std::optional<JointLimits>& limits) {
    Vec2 range;
    if (!value.json().is_array() || value.json().size() != 2) value.refuse("is not a list [low, high]");
    read(value, range);
    if (range.x > range.y) value.refuse("has its lower limit above the upper one");
    limits = JointLimits{range.x, range.y};
}

void read_spring(const Value& value, std::optional<JointSpring>& target) {
    JointSpring& spring = target.emplace();
    read_object(value, {positive("frequency", spring.frequency),
                        not_negative("damping_ratio", spring.damping_ratio), field("rest", spring.rest)});
}

/// A motor goes at a speed or to a target; the one makes no sense beside the other.
void read_motor(const Value& value, std::optional<JointMotor>& target) {
    JointMotor& motor = target.emplace();
    read_object(value, {field("speed", motor.speed), field("target", motor.target),
                        positive("frequency", motor.frequency),
                        not_negative("damping_ratio", motor.damping_ratio), not_negative("max", motor.max)});
    const bool has_speed = value.json().contains("speed"), has_target = value.json().contains("target");
    if (has_speed == has_target) value.fail("has to have either \"speed\" or \"target\"");
}

Field limits_field(std::string_view key, std::optional<JointLimits>& limits) {
    return {key, [&limits](const Value& value) { read_limits(value, limits); }};
}
Field spring_field(std::string_view key, std::optional<JointSpring>& spring) {
    return {key, [&spring](const Value& value) { read_spring(value, spring); }};
}
Field motor_field(std::string_view key, std::optional<JointMotor>& motor) {
    return {key, [&motor](const Value& value) { read_motor(value, motor); }};
}

/// A direction of any length but zero.
template <int D>
Field direction(std::string_view key, Vec<D>& target) {
    return {key, [&target](const Value& value) {
                read(value, target);
                if (target == Vec<D>{}) value.refuse("has no direction");
            }};
}

/// Fields that only space has.
template <int D>
Fields in_space(Fields fields) {
    return D == 3 ? std::move(fields) : Fields{};
}

template <int D>
Fields hinge_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<HingeJoint<D>>();
    return Fields{required("anchor", joint.anchor), limits_field("limits", joint.limits),
                  motor_field("motor", joint.motor), spring_field("spring", joint.spring)} +
           in_space<D>({direction("axis", joint.axis)});
}

template <int D>
Fields slider_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<SliderJoint<D>>();
    return {required("anchor", joint.anchor), direction("axis", joint.axis),
            limits_field("limits", joint.limits), motor_field("motor", joint.motor),
            spring_field("spring", joint.spring)};
}

template <int D>
Fields ball_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<BallJoint<D>>();
    return Fields{required("anchor", joint.anchor), spring_field("spring", joint.spring),
                  not_negative("friction", joint.friction)} +
           in_space<D>({direction("axis", joint.axis), field("cone_axis", joint.cone_axis),
                        field("swing_limit", joint.swing_limit),
                        limits_field("twist_limits", joint.twist_limits)});
}

template <int D>
Fields weld_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<WeldJoint<D>>();
    return {field("anchor", joint.anchor), spring_field("spring", joint.spring),
            spring_field("angular_spring", joint.angular_spring)};
}

template <int D>
Fields distance_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<DistanceJoint<D>>();
    const auto length = [&joint](const Value& value) {
        not_negative("length", joint.length.emplace()).read(value);
    };
    return {field("anchor_a", joint.anchor_a), field("anchor_b", joint.anchor_b),
            field("length", length),           limits_field("limits", joint.limits),
            motor_field("motor", joint.motor), spring_field("spring", joint.spring)};
}

template <int D>
Fields wheel_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<WheelJoint<D>>();
    return Fields{required("anchor", joint.anchor), direction("axis", joint.axis),
                  limits_field("limits", joint.limits), motor_field("motor", joint.motor),
                  spring_field("spring", joint.spring)} +
           in_space<D>({direction("spin_axis", joint.spin_axis), motor_field("steering", joint.steering),
                        limits_field("steering_limits", joint.steering_limits)});
}

template <int D>
Fields pulley_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<PulleyJoint<D>>();
    return {field("anchor_a", joint.anchor_a), field("anchor_b", joint.anchor_b),
            required("ground_a", joint.ground_a), required("ground_b", joint.ground_b),
            positive("ratio", joint.ratio)};
}

template <class Joint, int D>
Fields coupled_fields(const Names& names, Kind<D>& kind) {
    auto& joint = kind.template emplace<Joint>();
    const auto name = [&names](JointId<D>& target) {
        return [&names, &target](const Value& value) {
            target = {names.joints.find(value, "an earlier joint"), 0};
        };
    };
    const auto ratio = [&joint](const Value& value) {
        read(value, joint.ratio);
        if (joint.ratio == 0) value.refuse("is zero");
    };
    return {required("joint_a", name(joint.joint_a)), required("joint_b", name(joint.joint_b)),
            field("ratio", ratio)};
}

template <int D>
Fields pose_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<MotorJoint<D>>();
    return {field("position", joint.position),          field(D == 2 ? "angle" : "rotation", joint.rotation),
            positive("frequency", joint.frequency),     not_negative("damping_ratio", joint.damping_ratio),
            not_negative("max_force", joint.max_force), not_negative("max_torque", joint.max_torque)};
}

template <int D>
Fields target_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<TargetJoint<D>>();
    return {required("anchor", joint.anchor), field("target", joint.target),
            positive("frequency", joint.frequency), not_negative("damping_ratio", joint.damping_ratio),
            not_negative("max", joint.max)};
}

template <int D>
Fields parallel_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<ParallelJoint<D>>();
    if constexpr (D == 2)
        return {spring_field("spring", joint.spring)};
    else
        return {direction("axis", joint.axis)};
}

template <int D>
Fields ratchet_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<RatchetJoint<D>>();
    return Fields{required("anchor", joint.anchor), not_negative("pitch", joint.pitch),
                  field("backward", joint.backward), motor_field("motor", joint.motor),
                  spring_field("spring", joint.spring)} +
           in_space<D>({direction("axis", joint.axis)});
}

template <int D>
Fields path_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<PathJoint<D>>();
    return {required("points", joint.points),     field("loop", joint.loop),
            field("smooth", joint.smooth),        field("anchor", joint.anchor),
            limits_field("limits", joint.limits), motor_field("motor", joint.motor),
            spring_field("spring", joint.spring)};
}

/// An axis of a generic joint is "locked", "free", or an object that says what it does.
void read_axis(const Value& value, JointAxis& axis) {
    axis.limits.reset();
    if (value.json().is_object())
        return read_object(value, {limits_field("limits", axis.limits), motor_field("motor", axis.motor),
                                   spring_field("spring", axis.spring)});
    const std::array<std::string_view, 2> names{"locked", "free"};
    if (read_choice(value, names) == 0) axis.limits = JointLimits{0, 0};
}

template <std::size_t count>
Field axes_field(std::string_view key, std::array<JointAxis, count>& axes) {
    return {key, [&axes](const Value& value) {
                if (!value.json().is_array() || value.json().size() != count)
                    value.refuse(fmt::format("is not a list of {}", count));
                std::size_t next = 0;
                for_each_element(value, [&](const Value& axis) { read_axis(axis, axes[next++]); });
            }};
}

template <int D>
Fields generic_fields(const Names&, Kind<D>& kind) {
    auto& joint = kind.template emplace<GenericJoint<D>>();
    return Fields{required("anchor", joint.anchor), direction("axis", joint.axis),
                  axes_field("ways", joint.ways), axes_field("turns", joint.turns)} +
           in_space<D>({direction("second_axis", joint.second_axis)});
}

/// A type of joint: its name, a function that makes it and says how its fields are read, and whether it names
/// bodies (or joints).
template <int D>
struct JointType {
    std::string_view name;
    Fields (*fields)(const Names&, Kind<D>&);
    bool has_bodies = true;
};

template <int D>
constexpr std::array<JointType<D>, 15> joint_types = {{{"hinge", hinge_fields<D>},
                                                       {"slider", slider_fields<D>},
                                                       {"ball", ball_fields<D>},
                                                       {"weld", weld_fields<D>},
                                                       {"distance", distance_fields<D>},
                                                       {"wheel", wheel_fields<D>},
                                                       {"pulley", pulley_fields<D>},
                                                       {"gear", coupled_fields<GearJoint<D>, D>, false},
                                                       {"rack", coupled_fields<RackJoint<D>, D>, false},
                                                       {"motor", pose_fields<D>},
                                                       {"target", target_fields<D>},
                                                       {"parallel", parallel_fields<D>},
                                                       {"ratchet", ratchet_fields<D>},
                                                       {"path", path_fields<D>},
                                                       {"generic", generic_fields<D>}}};

template <int D>
const JointType<D>& read_type(const Value& value) {
    std::vector<std::string_view> names;
    for (const auto& type : joint_types<D>) names.push_back(type.name);
    return joint_types<D>[read_choice(value, names)];
}

template <int D>
void read_joint(const Value& value, const Names& names, JointDefinition<D>& joint, std::uint32_t index) {
    const Value type_value(value, member(value, "type"), "type");
    const JointType<D>& type = read_type<D>(type_value);
    const auto name = [&](const Value& v) {
        read(v, joint.name);
        names.joints.add(v, joint.name, index, "joint");
    };
    Fields common{field("type", [](const Value&) {}), field("collide", joint.collide),
                  positive("break_force", joint.break_force), positive("break_torque", joint.break_torque)};
    if (type.has_bodies) {
        common.push_back(field("a", [&](const Value& v) {
            joint.a = BodyId<D>{names.bodies.find(v, "a body"), 0};
        }));
        common.push_back(required("b", [&](const Value& v) {
            joint.b = {names.bodies.find(v, "a body"), 0};
        }));
    }
    // A joint is known by its name only after it has been read: it cannot name itself.
    read_object(value, common + type.fields(names, joint.kind) + Fields{field("name", name)});
}

}  // namespace

template <int D>
void read_joints(const Value& value, SceneData<D>& scene) {
    IndexByName bodies, joints;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        bodies.add(scene.bodies[i].name, static_cast<std::uint32_t>(i));
    for_each_element(value, [&](const Value& joint) {
        const auto index = static_cast<std::uint32_t>(scene.joints.size());
        read_joint(joint, Names{bodies, joints}, scene.joints.emplace_back(), index);
    });
}

template void read_joints(const Value&, SceneData<2>&);
template void read_joints(const Value&, SceneData<3>&);

}  // namespace carom::io
