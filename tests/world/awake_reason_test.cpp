#include <gtest/gtest.h>

#include "world/builders.hpp"

// Why bodies are awake.

namespace carom::test {
namespace {

template <class T>
class AwakeReasons : public testing::Test {};
TYPED_TEST_SUITE(AwakeReasons, BothDimensions);

TYPED_TEST(AwakeReasons, FollowABodyFromItsFallToItsSleep) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> floor = world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 1)));
    run(world, 6);
    EXPECT_EQ(world.awake_reason(box).why, Wakefulness::moving);
    EXPECT_EQ(world.awake_reason(floor).why, Wakefulness::none);
    bool settled = false;
    for (int i = 0; i < 300 && world.awake(box); ++i) {
        world.step(1.0 / 60);
        settled = settled || world.awake_reason(box).why == Wakefulness::settling;
    }
    EXPECT_TRUE(settled);
    EXPECT_FALSE(world.awake(box));
    EXPECT_EQ(world.awake_reason(box).why, Wakefulness::none);
    world.wake(box);
    EXPECT_EQ(world.awake_reason(box).why, Wakefulness::settling);
}

TYPED_TEST(AwakeReasons, NameTheSettings) {
    constexpr int D = TypeParam::value;
    World<D> restless(sleepless<D>());
    restless.add_body(ground<D>());
    const BodyId<D> box = restless.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(restless, 120);
    EXPECT_EQ(restless.awake_reason(box).why, Wakefulness::sleep_off);
    EXPECT_FALSE(restless.awake_reason(box).because_of);
}

TYPED_TEST(AwakeReasons, NameTheNeighbourThatDoesNotRest) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5));
    d.can_sleep = false;
    const BodyId<D> guard = world.add_body(d);
    const BodyId<D> on_it = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 1.5)));
    const BodyId<D> on_top = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 2.5)));
    const BodyId<D> apart = world.add_body(body_of<D>(cube<D>(1), vec<D>(5, 0.5)));
    run(world, 300);
    EXPECT_EQ(world.awake_reason(guard).why, Wakefulness::sleep_off);
    for (const BodyId<D> body : {on_it, on_top}) {
        const AwakeReason<D> reason = world.awake_reason(body);
        EXPECT_EQ(reason.why, Wakefulness::neighbour);
        EXPECT_EQ(reason.because_of, guard);
    }
    EXPECT_EQ(world.awake_reason(apart).why, Wakefulness::none);
}

TYPED_TEST(AwakeReasons, NameTheMotorAndThePlatform) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 5));
    d.gravity_scale = 0;
    const BodyId<D> wheel = world.add_body(d);
    JointDefinition<D> joint;
    joint.kind = HingeJoint<D>{.anchor = vec<D>(0, 5), .motor = JointMotor{.speed = 2}};
    joint.b = wheel;
    const JointId<D> hinge = world.add_joint(joint);

    BodyDefinition<D> slab = body_of<D>(cube<D>(4), vec<D>(20, 0));
    slab.type = BodyType::kinematic;
    slab.velocity = vec<D>(0.03, 0);
    const BodyId<D> platform = world.add_body(slab);
    const BodyId<D> rider = world.add_body(body_of<D>(cube<D>(1), vec<D>(20, 2.5)));
    run(world, 240);
    EXPECT_EQ(world.awake_reason(wheel).why, Wakefulness::driven);
    EXPECT_EQ(world.awake_reason(platform).why, Wakefulness::none) << "it is not dynamic";

    // The rider is slow enough to rest but for the way it comes.
    const Wakefulness why = world.awake_reason(rider).why;
    EXPECT_TRUE(why == Wakefulness::settling || why == Wakefulness::neighbour);

    world.set_motor(hinge, std::nullopt);
    world.step(1.0 / 60);
    EXPECT_EQ(world.awake_reason(wheel).why, Wakefulness::moving) << "it goes on turning without";
}

TYPED_TEST(AwakeReasons, RefuseStaleHandles) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1)));
    world.remove_body(box);
    EXPECT_THROW(world.awake_reason(box), Error);
}

}  // namespace
}  // namespace carom::test
