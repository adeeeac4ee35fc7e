#include <gtest/gtest.h>

#include <functional>

#include "world/builders.hpp"

// Bodies at rest fall asleep, and wake when something happens to them.

namespace carom::test {
namespace {

/// Two boxes on one another and a third apart, all asleep.
template <int D>
struct Sleepers {
    World<D> world;
    BodyId<D> floor, lower, upper, apart;

    Sleepers() {
        floor = world.add_body(ground<D>());
        lower = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
        upper = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 1.5)));
        apart = world.add_body(body_of<D>(cube<D>(1), vec<D>(5, 0.5)));
        run(world, 180);
    }
    std::vector<bool> awake() const { return {world.awake(lower), world.awake(upper), world.awake(apart)}; }
};

using Awake = std::vector<bool>;

template <class T>
class Sleep : public testing::Test {};
TYPED_TEST_SUITE(Sleep, BothDimensions);

TYPED_TEST(Sleep, ComesWithRest) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    EXPECT_EQ(s.awake(), (Awake{false, false, false}));
    EXPECT_EQ(s.world.counts().awake, 0);
    EXPECT_TRUE(s.world.moved_bodies().empty());
    EXPECT_EQ(s.world.velocity(s.lower), Vec<D>{});
    EXPECT_EQ(spin_speed<D>(s.world.angular_velocity(s.upper)), 0);
    const Transform<D> before = s.world.transform(s.upper);
    run(s.world, 600);
    EXPECT_EQ(s.world.transform(s.upper), before);
    EXPECT_EQ(s.awake(), (Awake{false, false, false}));
}

TYPED_TEST(Sleep, ComesHalfASecondAfterRest) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 28);
    EXPECT_TRUE(world.awake(box));
    run(world, 12);
    EXPECT_FALSE(world.awake(box));
}

TYPED_TEST(Sleep, CanBeForbidden) {
    constexpr int D = TypeParam::value;
    World<D> restless(sleepless<D>());
    restless.add_body(ground<D>());
    const BodyId<D> box = restless.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(restless, 300);
    EXPECT_TRUE(restless.awake(box));

    // One body that cannot sleep keeps awake what it touches, and only that.
    World<D> world;
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5));
    d.can_sleep = false;
    const BodyId<D> guard = world.add_body(d);
    const BodyId<D> on_it = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 1.5)));
    const BodyId<D> apart = world.add_body(body_of<D>(cube<D>(1), vec<D>(5, 0.5)));
    run(world, 300);
    EXPECT_TRUE(world.awake(guard));
    EXPECT_TRUE(world.awake(on_it));
    EXPECT_FALSE(world.awake(apart));
}

TYPED_TEST(Sleep, DoesNotComeInFlight) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> thrown = world.add_body(body_of<D>(Ball{0.5}));
    BodyDefinition<D> slow = body_of<D>(Ball{0.5}, vec<D>(20, 0));
    slow.gravity_scale = 0;
    slow.velocity = vec<D>(0.06, 0);
    const BodyId<D> drifts = world.add_body(slow);
    run(world, 300);
    EXPECT_TRUE(world.awake(thrown));
    EXPECT_TRUE(world.awake(drifts));
}

/// Whatever is done to a sleeper wakes it and what hangs together with it, and nothing else.
TYPED_TEST(Sleep, EndsByWhateverIsDone) {
    constexpr int D = TypeParam::value;
    using S = Sleepers<D>;
    const std::vector<std::pair<const char*, std::function<void(S&)>>> deeds{
        {"wake", [](S& s) { s.world.wake(s.lower); }},
        {"velocity", [](S& s) { s.world.set_velocity(s.lower, vec<D>(0.1, 0)); }},
        {"spin", [](S& s) { s.world.set_angular_velocity(s.lower, spin<D>(0.1)); }},
        {"transform",
         [](S& s) {
             s.world.set_transform(s.lower, {vec<D>(0.05, 0.5), {}});
         }},
        {"type", [](S& s) { s.world.set_type(s.lower, BodyType::kinematic); }},
        {"gravity scale", [](S& s) { s.world.set_gravity_scale(s.lower, 0.5); }},
        {"damping", [](S& s) { s.world.set_damping(s.lower, 0.5, 0); }},
        {"locks", [](S& s) { s.world.set_locks(s.lower, {true}); }},
        {"mass", [](S& s) { s.world.set_mass_properties(s.lower, s.world.mass_properties(s.lower)); }},
        {"force", [](S& s) { s.world.apply_force(s.lower, vec<D>(1, 0)); }},
        {"torque", [](S& s) { s.world.apply_torque(s.lower, spin<D>(1)); }},
        {"impulse", [](S& s) { s.world.apply_impulse(s.lower, vec<D>(1, 0)); }},
        {"angular impulse", [](S& s) { s.world.apply_angular_impulse(s.lower, spin<D>(1)); }},
        {"new shape", [](S& s) { s.world.add_shape(s.lower, shape_of<D>(Ball{0.1})); }},
        {"constant force",
         [](S& s) {
             s.world.add_force({ConstantForce<D>{s.lower, vec<D>(1, 0)}});
         }},
        {"removed body", [](S& s) { s.world.remove_body(s.lower); }},
    };
    for (const auto& [name, deed] : deeds) {
        S s;
        ASSERT_EQ(s.awake(), (Awake{false, false, false}));
        deed(s);
        s.world.step(frame_time);
        EXPECT_TRUE(s.world.awake(s.upper)) << name;
        EXPECT_FALSE(s.world.awake(s.apart)) << name;
        if (s.world.contains(s.lower)) {
            EXPECT_TRUE(s.world.awake(s.lower)) << name;
        }
    }
}

TYPED_TEST(Sleep, IsNotLeftThroughUserDataAndReading) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    const std::uint64_t before = s.world.hash();
    s.world.set_user_data(s.lower, 9);
    s.world.contacts();
    s.world.energy();
    EXPECT_EQ(s.world.hash(), before);
    EXPECT_EQ(s.awake(), (Awake{false, false, false}));
}

TYPED_TEST(Sleep, EndsForAllWhenGravityChanges) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    s.world.set_gravity(vec<D>(0, 3));
    s.world.step(frame_time);
    EXPECT_EQ(s.awake(), (Awake{true, true, true}));
}

TYPED_TEST(Sleep, EndsByAHit) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    BodyDefinition<D> d = body_of<D>(Ball{0.3}, vec<D>(-3, 0.5));
    d.velocity = vec<D>(8, 0);
    s.world.add_body(d);
    run(s.world, 5);
    EXPECT_EQ(s.awake(), (Awake{false, false, false})) << "not before";
    run(s.world, 15);
    EXPECT_EQ(s.awake(), (Awake{true, true, false}));
    EXPECT_GT(s.world.position(s.lower).x, 1e-3);
}

TYPED_TEST(Sleep, EndsWhenTheSupportGoes) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    s.world.remove_body(s.floor);
    run(s.world, 30);
    EXPECT_EQ(s.awake(), (Awake{true, true, true}));
    EXPECT_LT(s.world.position(s.upper).y, 0.5);
}

TYPED_TEST(Sleep, EndsWhenTheSupportIsMovedAway) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    s.world.set_transform(s.floor, {vec<D>(0, -3), {}});
    run(s.world, 12);
    EXPECT_EQ(s.awake(), (Awake{true, true, true}));
    EXPECT_LT(s.world.position(s.upper).y, 1.4);
}

TYPED_TEST(Sleep, EndsWhenAKinematicNeighbourStarts) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(4, 1, 4)}, vec<D>(0, -0.5));
    d.type = BodyType::kinematic;
    const BodyId<D> lift = world.add_body(d);
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 120);
    ASSERT_FALSE(world.awake(box));
    world.set_velocity(lift, vec<D>(0, 0.5));
    run(world, 3);
    EXPECT_TRUE(world.awake(box));
}

TYPED_TEST(Sleep, EndsWhenAForceBegins) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    const BodyId<D> pushed = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    const BodyId<D> hit = world.add_body(body_of<D>(cube<D>(1), vec<D>(3, 0.5)));
    const BodyId<D> other = world.add_body(body_of<D>(cube<D>(1), vec<D>(6, 0.5)));
    world.add_force({ConstantForce<D>{pushed, vec<D>(8000, 0)}, 2, 3});
    world.add_force({TimedImpulse<D>{hit, vec<D>(2000, 0), std::nullopt, 2.5}});
    run(world, 119);
    EXPECT_FALSE(world.awake(pushed));
    run(world, 10);
    EXPECT_TRUE(world.awake(pushed));
    EXPECT_FALSE(world.awake(hit));
    run(world, 25);
    EXPECT_TRUE(world.awake(hit));
    EXPECT_FALSE(world.awake(other));
}

/// What lies beside an awake body, near but not touching, sleeps on and stays where it is.
TYPED_TEST(Sleep, IsNotDisturbedByAQuietNeighbour) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    const Transform<D> before = s.world.transform(s.apart);
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(6.01, 0.5));
    d.can_sleep = false;
    s.world.add_body(d);
    run(s.world, 120);
    EXPECT_LT(length(s.world.position(s.apart) - before.position), 1e-4);
    EXPECT_EQ(s.world.velocity(s.apart), Vec<D>{});
}

TYPED_TEST(Sleep, CanBeOrdered) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(Ball{0.5}, vec<D>(0, 9));
    d.velocity = vec<D>(1, 1);
    const BodyId<D> body = world.add_body(d);
    world.put_to_sleep(body);
    EXPECT_FALSE(world.awake(body));
    EXPECT_EQ(world.velocity(body), Vec<D>{});
    run(world, 60);
    EXPECT_EQ(world.position(body), vec<D>(0, 9)) << "asleep it hangs in the air";
    world.wake(body);
    EXPECT_TRUE(world.awake(body));
    run(world, 60);
    EXPECT_NEAR(world.velocity(body).y, -9.81, 1e-12);
    // A wake that has not come to a step yet does not outlive the order.
    world.put_to_sleep(body);
    world.apply_force(body, vec<D>(0, 0));
    world.put_to_sleep(body);
    run(world, 1);
    EXPECT_FALSE(world.awake(body));
}

/// A body that is set to sleep and is woken again continues as if nothing had been: a stack stands.
TYPED_TEST(Sleep, LeavesNoTrace) {
    constexpr int D = TypeParam::value;
    Sleepers<D> s;
    const Vec<D> before = s.world.position(s.upper);
    for (int i = 0; i < 10; ++i) {
        s.world.wake(s.lower);
        run(s.world, 20);
        EXPECT_LT(fastest(s.world), 1e-3) << "round " << i;
        run(s.world, 60);
    }
    EXPECT_LT(length(s.world.position(s.upper) - before), 1e-3);
}

/// Slow is not at rest.
TYPED_TEST(Sleep, DoesNotStopACreep) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition;
    definition.gravity = {};
    World<D> drifting(definition);
    BodyDefinition<D> d = body_of<D>(Ball{0.5});
    d.velocity = vec<D>(0.01, 0);
    const BodyId<D> body = drifting.add_body(d);
    run(drifting, 600);
    EXPECT_TRUE(drifting.awake(body));
    EXPECT_NEAR(drifting.position(body).x, 0.1, 1e-12);
}

TYPED_TEST(Sleep, TakesSpringsAlong) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    const BodyId<D> a = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    const BodyId<D> b = world.add_body(body_of<D>(cube<D>(1), vec<D>(4, 0.5)));
    Spring<D> spring;
    spring.a = a;
    spring.b = b;
    spring.stiffness = 100;
    world.add_force({spring});
    run(world, 120);
    EXPECT_FALSE(world.awake(a));
    world.set_velocity(b, vec<D>(0.5, 0));
    world.step(frame_time);
    EXPECT_TRUE(world.awake(a)) << "one end wakes the other";
}

}  // namespace
}  // namespace carom::test
