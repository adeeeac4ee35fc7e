#include "world/builders.hpp"

// What a step keeps from the one before, and what its stages do side by side.

namespace carom::test {
namespace {

template <class T>
struct Stages : testing::Test {};
TYPED_TEST_SUITE(Stages, BothDimensions);

template <int D>
BodyDefinition<D> body_at(const Vec<D>& position, const Geometry<D>& geometry) {
    BodyDefinition<D> body;
    body.position = position;
    body.shapes.push_back({geometry});
    return body;
}

/// Some lie, some fly, some spin, and some have two shapes.
template <int D>
World<D> crowd(int threads) {
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    if (threads > 1) world.set_scheduler(make_thread_pool(threads));
    Vec<D> floor, unit;
    for (int i = 0; i < D; ++i) floor[i] = i == 1 ? 1 : 4000, unit[i] = 1;
    BodyDefinition<D> ground = body_at<D>(vec<D>(0, -0.5), Box<D>{floor});
    ground.type = BodyType::fixed;
    world.add_body(ground);
    for (int i = 0; i < 1500; ++i) {
        BodyDefinition<D> body =
            body_at<D>(vec<D>(1.25 * i - 900, i % 3 == 0 ? 0.5 : 0.5 + i % 7), Box<D>{unit});
        if (i % 5 == 0) body.shapes = {{Ball{0.4}}};
        if (i % 11 == 0) {
            body.shapes.push_back({Ball{0.3}});
            body.shapes.back().center = vec<D>(0.4, 0.3);
        }
        body.velocity = vec<D>(i % 4, i % 13 == 0 ? 30 : 0);
        body.angular_velocity = spin<D>(i % 6);
        world.add_body(body);
    }
    return world;
}

TYPED_TEST(Stages, AreTheSameForAnyNumberOfThreads) {
    constexpr int D = TypeParam::value;
    std::vector<World<D>> worlds;
    for (const int threads : {1, 2, 3}) worlds.push_back(crowd<D>(threads));
    for (int step = 0; step < 30; ++step) {
        for (World<D>& world : worlds) {
            world.step(frame_time);
            ASSERT_EQ(world.hash(), worlds[0].hash()) << step;
            ASSERT_EQ(world.moved_bodies().size(), worlds[0].moved_bodies().size());
        }
    }
}

TYPED_TEST(Stages, ListTheMovedBodiesWithTheirPlaces) {
    constexpr int D = TypeParam::value;
    World<D> world = crowd<D>(2);
    world.step(frame_time);
    ASSERT_EQ(world.moved_bodies().size(), 1500u);
    for (const MovedBody<D>& moved : world.moved_bodies()) {
        EXPECT_EQ(moved.transform.position, world.transform(moved.body).position);
        EXPECT_EQ(moved.transform.rotation, world.transform(moved.body).rotation);
    }
}

/// A chain that swings from an anchor in the world, of links that are bound by their anchors alone.
template <int D>
struct Chain {
    World<D> world;
    std::vector<BodyId<D>> links;
    std::vector<JointId<D>> joints;

    explicit Chain(JointMethod method) : world(settings(method)) {
        for (int i = 0; i < 12; ++i) {
            links.push_back(world.add_body(body_at<D>(vec<D>(i + 0.5, 0, 0), Ball{0.3})));
            JointDefinition<D> joint;
            if (i > 0) joint.a = links[i - 1];
            joint.b = links[i];
            joint.kind = BallJoint<D>{.anchor = vec<D>(i, 0, 0)};
            joints.push_back(world.add_joint(joint));
        }
    }
    static WorldDefinition<D> settings(JointMethod method) {
        WorldDefinition<D> definition;
        definition.joints = method;
        return definition;
    }
    void expect_same(const Chain& other) const {
        for (std::size_t i = 0; i < links.size(); ++i) {
            EXPECT_EQ(world.transform(links[i]).position, other.world.transform(links[i]).position) << i;
            EXPECT_EQ(world.joint_force(joints[i]), other.world.joint_force(joints[i])) << i;
        }
    }
};

template <int D>
void expect_chain_not_to_care(JointMethod method) {
    Chain<D> alone(method), beside(method);
    const auto step_both = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            alone.world.step(frame_time);
            beside.world.step(frame_time);
        }
        alone.expect_same(beside);
    };
    step_both(20);
    std::array<BodyId<D>, 2> others;
    for (int i = 0; i < 2; ++i)
        others[i] = beside.world.add_body(body_at<D>(vec<D>(100 + i, 0, 0), Ball{0.3}));
    JointDefinition<D> joint;
    joint.a = others[0];
    joint.b = others[1];
    joint.kind = BallJoint<D>{.anchor = vec<D>(100.5, 0, 0)};
    const JointId<D> added = beside.world.add_joint(joint);
    alone.expect_same(beside);
    step_both(20);
    beside.world.remove_joint(added);
    alone.expect_same(beside);
    step_both(20);
    beside.world.remove_body(others[0]);
    step_both(20);
}

TYPED_TEST(Stages, JointsKeepTheirImpulsesWhenOthersComeAndGo) {
    constexpr int D = TypeParam::value;
    expect_chain_not_to_care<D>(JointMethod::iterative);
    expect_chain_not_to_care<D>(JointMethod::automatic);
}

/// A weight that hangs straight down and is made heavier.
TYPED_TEST(Stages, JointsSeeAnotherMass) {
    constexpr int D = TypeParam::value;
    World<D> world(Chain<D>::settings(JointMethod::iterative));
    const BodyId<D> weight = world.add_body(body_at<D>(vec<D>(0, -1), Ball{0.3}));
    JointDefinition<D> joint;
    joint.b = weight;
    joint.kind = BallJoint<D>{.anchor = vec<D>(0, 0)};
    const JointId<D> held = world.add_joint(joint);
    const auto pull = [&] {
        for (int i = 0; i < 20; ++i) world.step(frame_time);
        return length(world.joint_force(held));
    };
    MassProperties<D> mass = world.mass_properties(weight);
    const double weight_before = mass.mass * length(Chain<D>::settings(JointMethod::iterative).gravity);
    EXPECT_NEAR(pull(), weight_before, 1e-3 * weight_before);
    mass.mass *= 2;
    mass.inertia = mass.inertia * 2.0;
    world.set_mass_properties(weight, mass);
    EXPECT_NEAR(pull(), 2 * weight_before, 1e-3 * weight_before);
}

}  // namespace
}  // namespace carom::test
