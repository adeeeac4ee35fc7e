#include <gtest/gtest.h>

#include "world/builders.hpp"

// Joints that are solved at once.

namespace carom::test {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
using Kind = decltype(JointDefinition<D>::kind);

template <int D>
JointId<D> join(World<D>& world, const Kind<D>& kind, std::optional<BodyId<D>> a, BodyId<D> b) {
    JointDefinition<D> joint;
    joint.kind = kind;
    joint.a = a;
    joint.b = b;
    return world.add_joint(joint);
}

template <int D>
World<D> world_with(JointMethod method) {
    WorldDefinition<D> definition = sleepless<D>();
    definition.joints = method;
    return World<D>(definition);
}

/// Links of 1 kg from the origin downwards, `angle` off the vertical, and a heavy ball at the end.
template <int D>
BodyId<D> hang_chain(World<D>& world, int links, double mass, double angle) {
    const Vec<D> way = 0.2 * vec<D>(std::sin(angle), -std::cos(angle));
    std::optional<BodyId<D>> before;
    for (int i = 0; i <= links; ++i) {
        BodyDefinition<D> link = body_of<D>(Ball{0.05}, (i + (i < links ? 0.5 : 0.0)) * way);
        link.mass = i < links ? 1 : mass;
        const BodyId<D> body = world.add_body(link);
        join<D>(world, HingeJoint<D>{.anchor = static_cast<double>(i) * way}, before, body);
        before = body;
    }
    return *before;
}

template <int D>
double stretch(const World<D>& world) {
    double sum = 0;
    for (const JointId<D>& joint : world.joints()) sum += world.linear_error(joint);
    return sum;
}

template <class T>
class DirectJoints : public testing::Test {};
TYPED_TEST_SUITE(DirectJoints, BothDimensions);

TYPED_TEST(DirectJoints, HeavyEndsDoNotStretchChains) {
    constexpr int D = TypeParam::value;
    World<D> world = world_with<D>(JointMethod::automatic);
    hang_chain<D>(world, 20, 1e4, 0.5);
    const double start = world.energy().total();
    for (int i = 0; i < 240; ++i) {
        world.step(frame_time);
        ASSERT_LT(stretch<D>(world), 1e-3) << "step " << i;
        ASSERT_NEAR(world.energy().total(), start, 1e-4 * 1e4 * 9.81 * 4) << "step " << i;
    }
}

/// Sweeps would leave it a metre too long, so the world has to have chosen by itself.
TYPED_TEST(DirectJoints, AWorldChoosesByWhatHangsOnAJoint) {
    constexpr int D = TypeParam::value;
    const auto hash_after = [](JointMethod method, int links, double mass) {
        World<D> world = world_with<D>(method);
        hang_chain<D>(world, links, mass, 0.5);
        run(world, 20);
        return world.position(world.bodies().back());
    };
    EXPECT_EQ(hash_after(JointMethod::automatic, 5, 50), hash_after(JointMethod::direct, 5, 50));
    EXPECT_EQ(hash_after(JointMethod::automatic, 15, 1), hash_after(JointMethod::direct, 15, 1));
    EXPECT_EQ(hash_after(JointMethod::automatic, 5, 1), hash_after(JointMethod::iterative, 5, 1));
}

/// A ring of hinged rods between two fixed points: in space some rows say what others say.
/// Two rods with a light body between and a heavy one at the end, let go from level. Where the rods fold over
/// each other the light body is thrown round within a few sub-steps.
TYPED_TEST(DirectJoints, AHeavyEndThatThrowsALightBodyRoundGainsNoEnergy) {
    constexpr int D = TypeParam::value;
    for (const int substeps : {4, 16}) {
        for (const double heavy : {10.0, 100.0, 1000.0}) {
            SCOPED_TRACE(std::to_string(substeps) + " sub-steps, " + std::to_string(heavy));
            WorldDefinition<D> definition = sleepless<D>();
            definition.joints = JointMethod::direct;
            definition.substeps = substeps;
            World<D> world(definition);
            std::optional<BodyId<D>> before;
            for (const auto& [at, mass] : {std::pair{0.25, 1.0}, std::pair{0.75, heavy}}) {
                BodyDefinition<D> ball = body_of<D>(Ball{0.05}, vec<D>(at, 0));
                ball.mass = mass;
                JointDefinition<D> rod;
                rod.a = before;
                before = rod.b = world.add_body(ball);
                DistanceJoint<D> kind;
                if (!rod.a) kind.anchor_a = Vec<D>{};
                rod.kind = kind;
                world.add_joint(rod);
            }
            const double start = world.energy().total(), least = -0.75 * 9.81 * heavy;
            for (int i = 0; i < 600; ++i) {
                world.step(frame_time);
                ASSERT_LT(world.energy().total() - start, -0.02 * least) << "step " << i;
            }
        }
    }
}

TYPED_TEST(DirectJoints, LoopsAndRedundantRowsHold) {
    constexpr int D = TypeParam::value;
    World<D> world = world_with<D>(JointMethod::direct);
    std::optional<BodyId<D>> before;
    for (int i = 0; i < 12; ++i) {
        const double from = pi * i / 12, to = pi * (i + 1) / 12;
        const Vec<D> a = vec<D>(-std::cos(from), -std::sin(from)), b = vec<D>(-std::cos(to), -std::sin(to));
        const BodyId<D> rod = world.add_body(body_of<D>(Ball{0.05}, 0.5 * (a + b)));
        join<D>(world, HingeJoint<D>{.anchor = a}, before, rod);
        before = rod;
    }
    join<D>(world, HingeJoint<D>{.anchor = vec<D>(1, 0)}, {}, *before);
    // Twice the same joint.
    join<D>(world, HingeJoint<D>{.anchor = vec<D>(1, 0)}, {}, *before);
    const double start = world.energy().total();
    for (int i = 0; i < 600; ++i) {
        world.step(frame_time);
        ASSERT_LT(stretch<D>(world), 1e-3) << "step " << i;
        ASSERT_LT(world.energy().total(), start + 1e-3 * std::fabs(start)) << "step " << i;
    }
}

/// Motors, springs and limits do alike in both methods where one joint is alone.
TYPED_TEST(DirectJoints, DrivesFollowTheSameLaws) {
    constexpr int D = TypeParam::value;
    const std::pair<const char*, HingeJoint<D>> kinds[] = {
        {"motor", {.motor = JointMotor{.speed = 3, .max = 5}}},
        {"motor at its limit", {.limits = JointLimits{-1, 0.5}, .motor = JointMotor{.speed = 3, .max = 5}}},
        {"spring", {.spring = JointSpring{.frequency = 2, .damping_ratio = 0.2, .rest = 0.7}}},
        {"target", {.motor = JointMotor{.target = 1, .frequency = 3, .damping_ratio = 1, .max = 2}}},
        {"friction", {.motor = JointMotor{.speed = 0, .max = 1}}},
        {"held", {.limits = JointLimits{0, 0}}}};
    for (const auto& [name, kind] : kinds) {
        SCOPED_TRACE(name);
        std::array<double, 2> angles{}, torques{};
        for (const bool direct : {false, true}) {
            World<D> world = world_with<D>(direct ? JointMethod::direct : JointMethod::iterative);
            BodyDefinition<D> body = body_of<D>(cube<D>(0.3), vec<D>(0.1, 0));
            body.gravity_scale = 0.2;
            const JointId<D> joint = join<D>(world, kind, {}, world.add_body(body));
            run(world, 90);
            angles[direct] = world.coordinate(joint);
            torques[direct] = spin_speed<D>(world.joint_torque(joint));
        }
        EXPECT_NEAR(angles[1], angles[0], 2e-3);
        EXPECT_NEAR(torques[1], torques[0], 0.02 + 0.02 * std::fabs(torques[0]));
    }
}

/// A rope that is slack lets its end fall freely, and holds it when it is taut.
TYPED_TEST(DirectJoints, LimitsLetGo) {
    constexpr int D = TypeParam::value;
    World<D> world = world_with<D>(JointMethod::direct);
    const BodyId<D> upper = world.add_body(body_of<D>(Ball{0.1}, vec<D>(0, -1)));
    const BodyId<D> lower = world.add_body(body_of<D>(Ball{0.1}, vec<D>(0, -1.5)));
    join<D>(world, DistanceJoint<D>{.anchor_a = Vec<D>{}}, {}, upper);
    const JointId<D> rope = join<D>(world, DistanceJoint<D>{.limits = JointLimits{0, 1}}, upper, lower);
    run(world, 12);
    EXPECT_NEAR(world.position(lower).y, -1.5 - 0.5 * 9.81 * 0.04, 1e-3);
    EXPECT_EQ(length(world.joint_force(rope)), 0);
    run(world, 120);
    EXPECT_NEAR(world.position(lower).y, -2, 1e-3);
    EXPECT_NEAR(length(world.joint_force(rope)), world.mass_properties(lower).mass * 9.81, 1e-2);
    world.set_velocity(lower, vec<D>(0, 1));
    run(world, 6);
    EXPECT_GT(world.position(lower).y, -2 + 0.04);
}

/// What hangs on joints stands on the ground with all its weight.
TYPED_TEST(DirectJoints, ContactsComeToRestWithThem) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition;
    definition.joints = JointMethod::direct;
    World<D> world(definition);
    world.add_body(ground<D>());
    std::optional<BodyId<D>> before;
    std::vector<BodyId<D>> boxes;
    double weight = 0;
    for (int i = 0; i < 5; ++i) {
        const BodyId<D> box = world.add_body(body_of<D>(cube<D>(0.5), vec<D>(1.1 * i, 0.35)));
        if (before) join<D>(world, WeldJoint<D>{.anchor = vec<D>(1.1 * i - 0.55, 0.35)}, *before, box);
        weight += 9.81 * world.mass_properties(box).mass;
        before = box;
        boxes.push_back(box);
    }
    run(world, 240);
    double carried = 0;
    for (const Contact<D>& contact : world.contacts()) {
        for (int i = 0; i < contact.count; ++i)
            carried += contact.points[static_cast<std::size_t>(i)].impulse / frame_time;
    }
    EXPECT_NEAR(carried, weight, 0.01 * weight);
    EXPECT_LT(stretch<D>(world), 1e-3);
    for (const BodyId<D>& box : boxes) EXPECT_NEAR(world.position(box).y, 0.25, 5e-3);
    EXPECT_EQ(world.counts().awake, 0);
}

TYPED_TEST(DirectJoints, AnyNumberOfThreadsGivesTheSameBits) {
    constexpr int D = TypeParam::value;
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 4}) {
        World<D> world = world_with<D>(JointMethod::direct);
        if (threads > 1) world.set_scheduler(make_thread_pool(threads));
        for (int i = 0; i < 20; ++i) {
            std::optional<BodyId<D>> before;
            for (int k = 0; k < 12; ++k) {
                const BodyId<D> link =
                    world.add_body(body_of<D>(Ball{0.05}, vec<D>(3 * i + 0.2 * k + 0.1, 0)));
                join<D>(world, HingeJoint<D>{.anchor = vec<D>(3 * i + 0.2 * k, 0)}, before, link);
                before = link;
            }
        }
        run(world, 30);
        hashes.push_back(world.hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace carom::test
