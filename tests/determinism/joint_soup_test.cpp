#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "simd/width.hpp"
#include "world/builders.hpp"

// Random soups of joints: the same bits for any lane width and any number of threads, nothing that is not
// finite, and no energy out of nothing.

// GCC 12 takes the values of empty optionals, which a variant moves along, for uninitialised reads.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace carom::test {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
using Kind = decltype(JointDefinition<D>::kind);

Vec3 random_axis(Random& random) { return random.direction<3>(); }

std::optional<JointLimits> sometimes_limits(Random& random, double reach) {
    if (random.below(2) == 0) return {};
    return JointLimits{-random.between(0, reach), random.between(0, reach)};
}

std::optional<JointSpring> sometimes_spring(Random& random) {
    if (random.below(2) == 0) return {};
    return JointSpring{.frequency = random.between(0.2, 20), .damping_ratio = random.between(0, 2)};
}

std::optional<JointMotor> sometimes_motor(Random& random, bool driven) {
    if (random.below(2) == 0) return {};
    if (!driven) return JointMotor{.speed = 0, .max = random.between(0, 10)};  // friction
    return JointMotor{.speed = random.between(-5, 5), .max = random.between(0, 100)};
}

/// A joint with random settings. Those that are not driven can only take energy away.
template <int D>
Kind<D> random_kind(Random& random, const Vec<D>& anchor, bool driven) {
    const Vec3 axis = random_axis(random);
    switch (random.below(9)) {
        case 0:
            return HingeJoint<D>{anchor, axis, sometimes_limits(random, 3), sometimes_motor(random, driven),
                                 sometimes_spring(random)};
        case 1:
            return SliderJoint<D>{anchor, random.direction<D>(), sometimes_limits(random, 1),
                                  sometimes_motor(random, driven), sometimes_spring(random)};
        case 2: {
            Kind<D> kind = BallJoint<D>{};
            auto& ball = std::get<BallJoint<D>>(kind);
            ball.anchor = anchor;
            ball.axis = axis;
            ball.spring = sometimes_spring(random);
            if (D == 3 && random.below(2) == 0) ball.swing_limit = random.between(0.1, pi);
            if (D == 3 && random.below(2) == 0) ball.twist_limits = JointLimits{-0.5, 0.5};
            ball.friction = random.between(0, 2);
            return kind;
        }
        case 3:
            return WeldJoint<D>{{}, sometimes_spring(random), sometimes_spring(random)};
        case 4:
            return DistanceJoint<D>{
                .limits = random.below(2) == 0 ? std::optional(JointLimits{0, 8}) : std::nullopt,
                .spring = sometimes_spring(random)};
        case 5: {
            WheelJoint<D> wheel{.anchor = anchor,
                                .limits = sometimes_limits(random, 0.3),
                                .spring = sometimes_spring(random),
                                .motor = sometimes_motor(random, driven)};
            return wheel;
        }
        case 6:
            return ParallelJoint<D>{.axis = axis};
        case 7:
            return TargetJoint<D>{
                .anchor = anchor, .frequency = random.between(0.5, 10), .max = random.between(0, 1e4)};
        default:
            return MotorJoint<D>{.max_force = random.between(0, 1e3), .max_torque = random.between(0, 1e3)};
    }
}

/// Trees of bodies with random joints between neighbours, and sometimes a loop. Masses differ by up to so
/// many powers of ten.
template <int D>
World<D> soup(std::uint64_t seed, bool driven, bool with_ground, JointMethod method = JointMethod::automatic,
              int decades = 1) {
    Random random(seed);
    WorldDefinition<D> definition = with_ground ? WorldDefinition<D>{} : no_gravity<D>();
    definition.joints = method;
    World<D> world(definition);
    if (with_ground) world.add_body(ground<D>());
    std::vector<BodyId<D>> bodies;
    const int count = 3 + random.below(8);
    for (int i = 0; i < count; ++i) {
        const BodyId<D> parent = i > 0 ? bodies[static_cast<std::size_t>(random.below(i))] : BodyId<D>{};
        const Vec<D> from = parent ? world.position(parent) : vec<D>(0, with_ground ? 6 : 0);
        const Vec<D> way = 0.6 * random.direction<D>();
        BodyDefinition<D> body = body_of<D>(cube<D>(0.5), from + way);
        body.rotation = random.rotation<D>();
        if (!with_ground) body.velocity = random.in_cube<D>(1);
        if (!with_ground) body.shapes[0].filter.mask = 0;  // what overlaps would be pushed apart
        body.mass = std::pow(10, random.below(decades + 1));
        bodies.push_back(world.add_body(body));
        JointDefinition<D> joint;
        if (parent) joint.a = parent;
        joint.b = bodies.back();
        joint.kind = random_kind<D>(random, from + 0.5 * way, driven);
        world.add_joint(joint);
        if (i > 2 && random.below(4) == 0) {  // a loop
            joint.a = bodies[static_cast<std::size_t>(random.below(i - 1))];
            joint.kind = DistanceJoint<D>{.limits = JointLimits{0, 3}};
            world.add_joint(joint);
        }
    }
    return world;
}

std::uint64_t worlds(int own) { return static_cast<std::uint64_t>(trials(own)); }

template <class T>
class JointSoup : public testing::Test {};
TYPED_TEST_SUITE(JointSoup, BothDimensions);

TYPED_TEST(JointSoup, StaysFinite) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 0; seed < worlds(150); ++seed) {
        SCOPED_TRACE(seed);
        World<D> world = soup<D>(seed, true, seed % 2 == 0);
        for (int i = 0; i < 60; ++i) {
            world.step(frame_time);
            ASSERT_TRUE(world.quarantined().empty()) << "step " << i;
        }
    }
}

TYPED_TEST(JointSoup, StaysFiniteWhereAllIsSolvedDirectly) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 200; seed < 240; ++seed) {
        SCOPED_TRACE(seed);
        World<D> world = soup<D>(seed, true, seed % 2 == 0, JointMethod::direct);
        for (int i = 0; i < 60; ++i) {
            world.step(frame_time);
            ASSERT_TRUE(world.quarantined().empty()) << "step " << i;
        }
    }
}

/// Springs begin at rest, so that kinetic energy is all there is. While joints that were torn apart agree,
/// some of it comes and goes; it does not grow.
TYPED_TEST(JointSoup, GainsNoEnergy) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 1000; seed < 1000 + worlds(150); ++seed) {
        SCOPED_TRACE(seed);
        World<D> world = soup<D>(seed, false, false);
        const double start = world.energy().kinetic;
        for (int i = 0; i < 600; ++i) {
            world.step(frame_time);
            ASSERT_LT(world.energy().kinetic, 1.3 * start) << "step " << i;
        }
    }
}

/// Where heavy bodies whip light ones round, directions turn faster than they can be followed. Springs give
/// and take some energy as the mass that they move changes with the pose.
TYPED_TEST(JointSoup, GainsNoEnergyWhereMassesDifferAMillionTimes) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 3000; seed < 3000 + worlds(20); ++seed) {
        SCOPED_TRACE(seed);
        World<D> world = soup<D>(seed, false, false, JointMethod::automatic, 6);
        const double start = world.energy().kinetic;
        for (int i = 0; i < 600; ++i) {
            world.step(frame_time);
            ASSERT_LT(world.energy().kinetic, 5 * start) << "step " << i;
        }
    }
}

TYPED_TEST(JointSoup, AnyLaneWidthGivesTheSameBits) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<std::uint64_t> hashes;
        for (const int width : {1, 4, 8, 16}) {
            if (!detail::can_run_lanes(width)) continue;
            detail::set_lane_width(width);
            World<D> world = soup<D>(seed, true, true);
            run(world, 60);
            hashes.push_back(world.hash());
        }
        detail::set_lane_width(0);
        for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << "seed " << seed;
    }
}

}  // namespace
}  // namespace carom::test
