#include "scenes/ragdoll.hpp"

#include <cmath>

#include "carom/parts/ragdoll.hpp"

namespace carom::bench {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// A bone, where it is in a human that stands at the origin, and its joint with its parent. Joints are given
/// by a frame on either bone: hinges turn about the z axis, ball joints have it in the middle of their cone.
struct BoneOfTable {
    int parent;
    Vec3 position;
    Rotation3 rotation;
    Vec3 from, to;
    double radius;
    bool in_group;
    Vec3 anchor_a;
    Rotation3 frame_a;
    Vec3 anchor_b;
    Rotation3 frame_b;
    bool is_hinge;
    double swing, least_twist, most_twist;  ///< degrees
    double friction;
};

const BoneOfTable bones[] = {
    // clang-format off
    // pelvis
    {-1, {0, 0.932087, -0.051708}, {0.739169, 0, 0, 0.67352}, {0.07, 0, -0.08},
     {-0.07, 0, -0.08}, 0.13, false, {}, {}, {}, {}, false, 0, 0, 0, 0},
    // spine_01
    {0, {0, 1.1135, -0.03481}, {0.739973, 0, 0, 0.672637}, {0.06, 0, -0.052264},
     {-0.06, 0, -0.052264}, 0.12, true, {0, 0, -0.182204}, {-0.999999, 0, 0, 0.001194},
     {0, 0, -0.007736}, {-1, 0, 0, 0}, false, 25, -15, 15, 1},
    // spine_02
    {1, {0, 1.19434, -0.027087}, {0.703611, 0, 0, 0.710586}, {0.08, -0.015133, -0.091801},
     {-0.08, -0.015133, -0.091801}, 0.1, false, {0, 0, -0.088935}, {-0.998619, 0, 0, -0.05254},
     {0, 0, -0.008199}, {-1, 0, 0, 0}, false, 25, -15, 15, 1},
    // spine_03
    {2, {0, 1.31043, -0.028232}, {0.669856, 1e-06, -1e-06, 0.742491}, {0.11, -0.039753, -0.13},
     {-0.11, -0.039753, -0.13}, 0.145, false, {0, 0, -0.124298}, {-0.998921, 1e-06, -1e-06, -0.046434},
     {0, 0, 0}, {-1, 0, -1e-06, 0}, false, 15, -10, 10, 1},
    // neck
    {3, {0, 1.57558, -0.055837}, {0.879922, 0, 0, 0.475118}, {-1e-06, 0, -0.02},
     {0, -0.005, -0.08}, 0.07, false, {1e-06, -0.000259, -0.266585}, {-0.942192, -1e-06, 0, 0.335074},
     {0, 0, 0}, {-1, 0, -1e-06, 0}, false, 45, -15, 15, 0.8},
    // head
    {4, {0, 1.65335, -0.003241}, {0.750288, 0, 0, 0.661111}, {-1e-06, 0.016892, -0.05869},
     {0, -0.003629, -0.115072}, 0.0975, false, {0, 0.001321, -0.093873}, {-0.974301, 0, 0, -0.225251},
     {0, 0.001268, -0.005104}, {-1, 0, 0, 0}, false, 15, -15, 15, 0.4},
    // thigh_l
    {0, {0.090416, 0.986104, -0.03509}, {-0.703287, -0.070715, 0.053866, 0.705327}, {0.023719, 0.006008, -0.039068},
     {-0.064492, -0.004664, -0.424718}, 0.09, true, {0.05, 0.011537, -0.055325}, {-0.714896, -0.022305, -0.698361, -0.02679},
     {0, 0, 0}, {-0.002064, 0.758987, 0.017046, 0.65088}, false, 10, -60, 40, 1},
    // calf_l
    {6, {0.101198, 0.527027, -0.037374}, {-0.653328, -0.06686, 0.058582, 0.751838}, {0.001778, 0, 0.009841},
     {-0.078577, 0.014707, -0.41816}, 0.075, false, {-0.069989, 0.000253, -0.453844}, {-0.000677, 0.760087, 0.105674, 0.641171},
     {0, 0, 0}, {-0.044589, 0.76554, 0.053368, 0.639619}, true, 0, -5, 45, 1},
    // thigh_r
    {0, {-0.090416, 0.986104, -0.03509}, {-0.703287, 0.070715, -0.053865, 0.705326}, {-0.023719, 0.006008, -0.039068},
     {0.064492, -0.004664, -0.424718}, 0.09, true, {-0.05, 0.011537, -0.055326}, {-0.039089, -0.714094, 0.043177, 0.697623},
     {0, 0, 0}, {0.758805, -0.019886, -0.651012, -0.001759}, false, 10, -30, 60, 1},
    // calf_r
    {8, {-0.101198, 0.527027, -0.037373}, {-0.653327, 0.06686, -0.058582, 0.751839}, {-0.00182, 0, 0.010071},
     {0.077883, 0.014825, -0.418047}, 0.075, false, {0.069988, 0.000253, -0.453844}, {0.760086, -0.000675, -0.641171, -0.105676},
     {0, 0, 0}, {0.76554, -0.044589, -0.639619, -0.053368}, true, 0, -45, 5, 1},
    // upper_arm_l
    {3, {0.20378, 1.48428, -0.115897}, {0.143082, 0.69598, -0.69013, 0.13733}, {0, 0, 0},
     {-0.091118, 0.037775, 0.229719}, 0.075, false, {0.20378, -0.069369, -0.181921}, {-0.278486, 0.4456, -0.097014, 0.845266},
     {0, 0, 0}, {-0.201396, -0.001586, 0.90185, 0.382234}, false, 60, -5, 5, 1},
    // lower_arm_l
    {10, {0.305614, 1.24291, -0.117599}, {0.165048, 0.563437, -0.802002, 0.109959}, {0, 0, 0},
     {-0.142406, 0.039392, 0.261092}, 0.05, false, {-0.095482, 0.039584, 0.240723}, {0.512487, -0.180629, 0.839474, 0.003742},
     {0, 0, 0}, {0.503803, -0.029831, 0.858168, 0.094017}, true, 0, -5, 60, 1},
    // upper_arm_r
    {3, {-0.20378, 1.48428, -0.115899}, {0.143083, -0.695978, 0.690132, 0.137329}, {0, 0, 0},
     {0.091118, 0.037775, 0.229718}, 0.075, false, {-0.203779, -0.069371, -0.181922}, {-0.253621, -0.414842, 0.106962, 0.867261},
     {0, 0, 0}, {-0.201397, 0.001587, -0.90185, 0.382233}, false, 60, -5, 5, 1},
    // lower_arm_r
    {12, {-0.305614, 1.24291, -0.117599}, {0.165048, -0.563437, 0.802002, 0.109959}, {0, 0, 0},
     {0.142406, 0.039392, 0.261092}, 0.05, false, {0.095484, 0.039585, 0.240723}, {-0.180627, 0.512487, -0.003744, -0.839474},
     {0, 0, 0}, {-0.029831, 0.503803, -0.094017, -0.858169}, true, 0, -60, 5, 1},
    // clang-format on
};

/// The turn of b against a about the z axis of their frames.
double twist_of(const Rotation3& a, const Rotation3& b) {
    const Rotation3 q = inverse(a) * b;
    return std::remainder(2 * std::atan2(q.z, q.w), 360 * degree);
}

Transform3 placed(const BoneOfTable& bone) { return {bone.position, normalized(bone.rotation)}; }

decltype(JointDefinition3::kind) joint_of(const BoneOfTable& bone) {
    const Transform3 parent = placed(bones[bone.parent]);
    const Rotation3 frame_a = parent.rotation * normalized(bone.frame_a);
    const Rotation3 frame_b = placed(bone).rotation * normalized(bone.frame_b);
    const Vec3 axis_a = rotate(frame_a, Vec3{0, 0, 1}), axis_b = rotate(frame_b, Vec3{0, 0, 1});
    const double start = twist_of(frame_a, frame_b);
    const JointLimits twist{bone.least_twist * degree - start, bone.most_twist * degree - start};
    const JointSpring spring{.frequency = 1, .damping_ratio = 0.7};
    const Vec3 anchor = apply(parent, bone.anchor_a);
    if (bone.is_hinge) {
        JointSpring hinge_spring = spring;
        hinge_spring.rest = -start;
        JointMotor friction;
        friction.max = 5 * bone.friction;
        return HingeJoint<3>{
            .anchor = anchor, .axis = axis_a, .limits = twist, .motor = friction, .spring = hinge_spring};
    }
    return BallJoint<3>{.anchor = anchor,
                        .axis = axis_b,
                        .cone_axis = axis_a,
                        .swing_limit = bone.swing * degree,
                        .twist_limits = twist,
                        .spring = spring,
                        .friction = 5 * bone.friction};
}

RagdollDefinition<3> make_human(int group) {
    RagdollDefinition<3> human;
    for (const BoneOfTable& of_table : bones) {
        Bone<3>& bone = human.bones.emplace_back();
        bone.parent = of_table.parent;
        bone.body.position = of_table.position;
        bone.body.rotation = normalized(of_table.rotation);
        ShapeDefinition<3>& shape = bone.body.shapes.emplace_back();
        shape.geometry = Capsule<3>{of_table.from, of_table.to, of_table.radius};
        shape.material.friction = 0.6;
        shape.material.rolling_resistance = 0.2;
        if (of_table.in_group) shape.filter.group = group;
        if (bone.parent >= 0) bone.joint = joint_of(of_table);
    }
    constexpr int left_thigh = 6, right_thigh = 8;
    human.apart = {{left_thigh, right_thigh}};
    return human;
}

}  // namespace

std::vector<BodyId3> add_human(World3& world, const Vec3& position, int group) {
    static const RagdollDefinition<3> human = make_human(-1), without_group = make_human(0);
    return add_ragdoll<3>(world, group != 0 ? human : without_group,
                          {.placed = {position, {}}, .group = -group})
        .bodies;
}

namespace {

/// A bone of the flat human, that hangs at `y` from its parent by a hinge at `pivot`.
struct FlatBone {
    int parent;
    double y, low, high, radius, damping;  ///< capsule from `low` to `high`
    double pivot, least, most;             ///< limits in units of π
    double friction;
    double turned = 0;  ///< of the frame on the parent, in units of π
};

constexpr FlatBone flat_bones[] = {
    {-1, 0.95, -0.02, 0.02, 0.095, 0, 0, 0, 0, 0},                 // hip
    {0, 1.2, -0.135, 0.135, 0.09, 0, 1.0, -0.25, 0, 0.5},          // torso
    {1, 1.475, -0.038, 0.039, 0.075, 0.1, 1.4, -0.3, 0.1, 0.25},   // head
    {0, 0.775, -0.125, 0.125, 0.06, 0, 0.9, -0.05, 0.4, 1},        // left upper leg
    {3, 0.475, -0.155, 0.125, 0.045, 0, 0.625, -0.5, -0.02, 0.5},  // left lower leg
    {0, 0.775, -0.125, 0.125, 0.06, 0, 0.9, -0.05, 0.4, 1},        // right upper leg
    {5, 0.475, -0.155, 0.125, 0.045, 0, 0.625, -0.5, -0.02, 0.5},  // right lower leg
    {1, 1.225, -0.125, 0.125, 0.035, 0, 1.35, -0.1, 0.8, 0.5},     // left upper arm
    {7, 0.975, -0.125, 0.125, 0.03, 0.1, 1.1, -0.2, 0.3, 0.1, 0.25},
    {1, 1.225, -0.125, 0.125, 0.035, 0, 1.35, -0.1, 0.8, 0.5},  // right upper arm
    {9, 0.975, -0.125, 0.125, 0.03, 0.1, 1.1, -0.2, 0.3, 0.1, 0.25},
};

ShapeDefinition<2> foot() {
    ShapeDefinition<2> shape;
    shape.geometry = Hull<2>{{{-0.03, -0.185}, {0.11, -0.185}, {0.11, -0.16}, {-0.03, -0.14}}, 0.015};
    shape.material.friction = 0.05;
    shape.filter.mask = 1;
    return shape;
}

RagdollDefinition<2> make_flat_human() {
    constexpr double pi = 180 * degree;
    RagdollDefinition<2> human;
    for (const FlatBone& of_table : flat_bones) {
        Bone<2>& bone = human.bones.emplace_back();
        bone.parent = of_table.parent;
        bone.body.position = {0, of_table.y};
        bone.body.linear_damping = of_table.damping;
        ShapeDefinition<2>& shape = bone.body.shapes.emplace_back();
        shape.geometry = Capsule<2>{{0, of_table.low}, {0, of_table.high}, of_table.radius};
        shape.material.friction = 0.2;
        shape.filter.mask = 3;
        if (of_table.radius == 0.045) bone.body.shapes.push_back(foot());
        for (ShapeDefinition<2>& part : bone.body.shapes) {
            part.material.density = 1;
            part.filter.category = 2;
            part.filter.group = -1;
        }
        if (bone.parent < 0) continue;
        // Angles count from the frame on the parent.
        const double zero = of_table.turned * pi;
        bone.joint =
            HingeJoint<2>{.anchor = {0, of_table.pivot},
                          .limits = JointLimits{of_table.least * pi + zero, of_table.most * pi + zero},
                          .motor = JointMotor{.speed = 0, .max = 0.05 * of_table.friction},
                          .spring = JointSpring{.frequency = 5, .damping_ratio = 0.5, .rest = zero}};
    }
    return human;
}

}  // namespace

std::vector<BodyId2> add_human(World2& world, const Vec2& position, int group) {
    static const RagdollDefinition<2> human = make_flat_human();
    return add_ragdoll<2>(world, human, {.placed = {position, {}}, .group = -group}).bodies;
}

}  // namespace carom::bench
