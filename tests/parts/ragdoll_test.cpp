#include "carom/parts/ragdoll.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::frame_time;
using test::vec;

template <class T>
class Ragdolls : public testing::Test {};
TYPED_TEST_SUITE(Ragdolls, test::BothDimensions);

/// A trunk with two arms of two bones each that hang down beside it.
template <int D>
RagdollDefinition<D> figure() {
    RagdollDefinition<D> definition;
    const auto add = [&](int parent, const Vec<D>& from, const Vec<D>& to, double radius) {
        Bone<D> bone;
        bone.parent = parent;
        bone.body.position = 0.5 * (from + to);
        bone.body.shapes.push_back({Capsule<D>{0.5 * (from - to), 0.5 * (to - from), radius}});
        bone.body.shapes[0].filter.group = -1;
        if (parent >= 0) {
            if (D == 3 && parent == 0) {
                bone.joint = BallJoint<D>{.anchor = from, .axis = {0, -1, 0}, .swing_limit = 1.5};
            } else {
                bone.joint = HingeJoint<D>{.anchor = from, .limits = JointLimits{-2, 2}};
            }
        }
        definition.bones.push_back(bone);
    };
    add(-1, vec<D>(0, 1), vec<D>(0, 1.5), 0.15);
    for (const double side : {-1.0, 1.0}) {
        const int upper = static_cast<int>(definition.bones.size());
        add(0, vec<D>(0.25 * side, 1.5), vec<D>(0.25 * side, 1.2), 0.06);
        add(upper, vec<D>(0.25 * side, 1.2), vec<D>(0.25 * side, 0.9), 0.05);
    }
    definition.apart = {{2, 4}};
    return definition;
}

template <int D>
double worst_error(const World<D>& world) {
    double worst = 0;
    for (const JointId<D> joint : world.joints()) worst = std::max(worst, world.linear_error(joint));
    return worst;
}

template <int D>
double turn_between(const Rotation<D>& a, const Rotation<D>& b) {
    const Rotation<D> turn = inverse(a) * b;
    if constexpr (D == 2)
        return std::fabs(std::atan2(turn.s, turn.c));
    else
        return 2 * std::atan2(length(Vec3{turn.x, turn.y, turn.z}), std::fabs(turn.w));
}

TYPED_TEST(Ragdolls, StandWhereTheyArePutAndHoldTogether) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> floor;
    floor.type = BodyType::fixed;
    floor.shapes.push_back({Plane<D>{vec<D>(0, 1), 0}});
    world.add_body(floor);
    RagdollPlace<D> place;
    place.placed = {vec<D>(3, 2), test::turn_about_z<D>(1)};
    place.velocity = vec<D>(1, 0);
    place.group = -7;
    const Ragdoll<D> doll = add_ragdoll(world, figure<D>(), place);
    ASSERT_EQ(doll.bodies.size(), 5u);
    EXPECT_FALSE(doll.joints[0]);
    EXPECT_LT(
        length(world.position(doll.bodies[0]) - vec<D>(3 - 1.25 * std::sin(1.0), 2 + 1.25 * std::cos(1.0))),
        1e-12);
    EXPECT_LT(worst_error(world), 1e-12);
    for (const BodyId<D> body : doll.bodies) {
        EXPECT_EQ(world.velocity(body), vec<D>(1, 0));
        EXPECT_EQ(world.shape(world.shapes(body)[0]).filter.group, -7);
    }
    for (int i = 0; i < 600; ++i) {
        world.step(frame_time);
        EXPECT_LT(worst_error(world), 0.03) << i;  // as it strikes the floor
    }
    EXPECT_LT(worst_error(world), 1e-3);
    for (const BodyId<D> body : doll.bodies) EXPECT_LT(world.position(body).y, 0.6);
    remove_ragdoll(world, doll);
    EXPECT_EQ(world.counts().bodies, 1);
    EXPECT_EQ(world.counts().joints, 0);
}

TYPED_TEST(Ragdolls, AreDrivenToAPoseAndGoLimp) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition;
    definition.gravity = {};
    World<D> world(definition);
    Ragdoll<D> doll = add_ragdoll(world, figure<D>());
    std::vector<Rotation<D>> pose = pose_of(world, doll);
    for (const Rotation<D>& turn : pose) EXPECT_LT(turn_between<D>(turn, {}), 1e-12);
    pose[1] = test::turn_about_z<D>(-1.2);
    pose[2] = test::turn_about_z<D>(-0.9);
    pose[4] = test::turn_about_z<D>(0.5);
    drive_to_pose<D>(world, doll, pose);
    EXPECT_EQ(world.counts().joints, 8);
    for (int i = 0; i < 120; ++i) world.step(frame_time);
    const std::vector<Rotation<D>> reached = pose_of(world, doll);
    for (std::size_t i = 1; i < pose.size(); ++i) EXPECT_LT(turn_between(pose[i], reached[i]), 0.01) << i;
    // It follows a pose that changes, with the same muscles.
    pose[2] = test::turn_about_z<D>(0.3);
    drive_to_pose<D>(world, doll, pose);
    EXPECT_EQ(world.counts().joints, 8);
    for (int i = 0; i < 120; ++i) world.step(frame_time);
    EXPECT_LT(turn_between(pose[2], pose_of(world, doll)[2]), 0.01);
    relax(world, doll);
    EXPECT_EQ(world.counts().joints, 4);
}

TYPED_TEST(Ragdolls, RefuseWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const auto refused = [&](auto change, const std::string& message) {
        RagdollDefinition<D> definition = figure<D>();
        change(definition);
        try {
            add_ragdoll(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
        EXPECT_EQ(world.counts().bodies, 0) << message;
    };
    refused([](auto& d) { d.bones.clear(); }, "bones: there are none");
    refused([](auto& d) { d.bones[1].parent = 3; }, "bones[1].parent: 3 is neither -1 nor an earlier bone");
    refused([](auto& d) { d.bones[1].joint = DistanceJoint<D>{}; }, "bones[1].joint: is not a hinge");
    refused([](auto& d) { d.bones[2].body.type = BodyType::fixed; }, "bones[2].body.type: is not dynamic");
    refused([](auto& d) { d.bones[3].body.mass = -1; }, "bones[3]: mass: -1 is not positive");
    refused(
        [](auto& d) {
            d.bones[4].joint = HingeJoint<D>{.limits = JointLimits{1, -1}};
        },
        "bones[4]: limits");
    refused([](auto& d) { d.apart = {{0, 9}}; }, "apart: 9 is not the index of a bone");
    Ragdoll<D> doll = add_ragdoll(world, figure<D>());
    const std::vector<Rotation<D>> short_pose(2);
    EXPECT_THROW(drive_to_pose<D>(world, doll, short_pose), Error);
}

}  // namespace
}  // namespace carom
