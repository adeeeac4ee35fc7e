#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Momentum, angular momentum and energy of bodies that collide in free space, and of piles.

namespace carom::test {
namespace {

template <int D>
Vec<D> momentum(const World<D>& world) {
    Vec<D> sum{};
    for (const BodyId<D>& body : world.bodies())
        sum += world.mass_properties(body).mass * world.velocity(body);
    return sum;
}

/// About the origin of the world.
template <int D>
Angular<D> angular_momentum(const World<D>& world) {
    Angular<D> sum{};
    for (const BodyId<D>& body : world.bodies()) {
        const MassProperties<D> m = world.mass_properties(body);
        const Angular<D> w = world.angular_velocity(body);
        if constexpr (D == 2)
            sum += m.inertia * w;
        else
            sum += rotate(world.rotation(body), m.inertia * unrotate(world.rotation(body), w));
        sum = sum + cross(world.center_of_mass(body), m.mass * world.velocity(body));
    }
    return sum;
}

/// Bodies of many kinds that fly towards the origin.
template <int D>
void add_swarm(World<D>& world, Random& random, int count, double restitution, double friction) {
    Material material;
    material.restitution = restitution;
    material.friction = friction;
    for (int i = 0; i < count; ++i) {
        Geometry<D> geometry = Ball{0.4};
        const Vec<D> half = random.in_cube<D>(0.4);
        if (i % 3 == 1) geometry = Box<D>{vec<D>(0.8, 0.6, 0.7)};
        if (i % 3 == 2) geometry = Capsule<D>{-half, half, 0.25};
        BodyDefinition<D> d = body_of<D>(geometry, random.in_cube<D>(4), material);
        d.rotation = random.rotation<D>();
        d.velocity = -1.5 * d.position + random.in_cube<D>(1);
        if constexpr (D == 2)
            d.angular_velocity = random.between(-3, 3);
        else
            d.angular_velocity = random.in_cube<3>(3);
        world.add_body(d);
    }
}

template <class T>
class Conservation : public testing::Test {};
TYPED_TEST_SUITE(Conservation, BothDimensions);

TYPED_TEST(Conservation, OfMomentumInASwarm) {
    constexpr int D = TypeParam::value;
    for (const double restitution : {0.0, 0.5, 1.0}) {
        for (const double friction : {0.0, 0.6}) {
            Random random(7);
            World<D> world(no_gravity<D>());
            add_swarm(world, random, 24, restitution, friction);
            run(world, 1);
            const Vec<D> before = momentum(world);
            const Angular<D> turning = angular_momentum(world);
            double size = 0, turning_size = 0;
            for (const BodyId<D>& body : world.bodies()) {
                const double m = world.mass_properties(body).mass * length(world.velocity(body));
                size += m;
                turning_size += m * length(world.position(body));
            }
            int contacts = 0;
            for (int i = 0; i < 240; ++i) {
                world.step(frame_time);
                contacts += world.counts().contacts;
            }
            const double off = length(momentum(world) - before) / size;
            const double turned = spin_speed<D>(angular_momentum(world) - turning) / turning_size;
            EXPECT_LT(off, 1e-6);
            EXPECT_LT(turned, 5e-3);
            EXPECT_GT(contacts, 100) << "they should meet";
        }
    }
}

TYPED_TEST(Conservation, EnergyNeverGrowsInASwarm) {
    constexpr int D = TypeParam::value;
    for (const double restitution : {0.0, 0.5, 1.0}) {
        Random random(8);
        World<D> world(no_gravity<D>());
        add_swarm(world, random, 24, restitution, 0.5);
        const double start = world.energy().total();
        double most = 0;
        for (int i = 0; i < 300; ++i) {
            world.step(frame_time);
            most = std::max(most, world.energy().total() / start);
        }
        EXPECT_LT(most, 1.02) << "restitution " << restitution;
    }
}

/// Two balls meet head on: the closed form for every restitution and ratio of masses.
TYPED_TEST(Conservation, HeadOnCollisionsFollowNewton) {
    constexpr int D = TypeParam::value;
    for (const double e : {0.0, 0.3, 0.7, 1.0}) {
        for (const double ratio : {1.0, 3.0, 100.0}) {
            World<D> world(no_gravity<D>());
            Material material;
            material.restitution = e;
            BodyDefinition<D> a = body_of<D>(Ball{0.5}, vec<D>(-1.3, 0), material);
            BodyDefinition<D> b = body_of<D>(Ball{0.5}, vec<D>(1.3, 0), material);
            a.mass = 1;
            b.mass = ratio;
            a.velocity = vec<D>(6, 0);
            b.velocity = vec<D>(-2, 0);
            const BodyId<D> left = world.add_body(a), right = world.add_body(b);
            run(world, 60);
            const double common = (6 - 2 * ratio) / (1 + ratio);
            EXPECT_NEAR(world.velocity(left).x, common - e * 8 * ratio / (1 + ratio), 2e-5);
            EXPECT_NEAR(world.velocity(right).x, common + e * 8 / (1 + ratio), 2e-5);
            // They met at t = 1.6 / 8 s, and have flown since.
            EXPECT_NEAR(world.position(left).x, -1.3 + 6 * 0.2 + 0.8 * world.velocity(left).x, 0.02);
        }
    }
}

/// A ball meets one at rest off the centre: without friction the one leaves along the line of centres and the
/// other across it.
TYPED_TEST(Conservation, AnObliqueCollisionParts) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    Material smooth;
    smooth.friction = 0;
    smooth.restitution = 1;
    BodyDefinition<D> a = body_of<D>(Ball{0.5}, vec<D>(-3, std::sqrt(0.5)), smooth);
    a.velocity = vec<D>(10, 0);
    const BodyId<D> cue = world.add_body(a);
    const BodyId<D> object = world.add_body(body_of<D>(Ball{0.5}, {}, smooth));
    run(world, 60);
    // The normal is that of the start of the step, when the balls were up to 17 cm apart.
    EXPECT_NEAR(length(world.velocity(object)), 10 * std::sqrt(0.5), 0.1);
    EXPECT_NEAR(world.velocity(object).y / world.velocity(object).x, -1, 0.03);
    EXPECT_NEAR(dot(world.velocity(cue), world.velocity(object)), 0, 1e-4);
    EXPECT_NEAR(world.energy().kinetic / (0.5 * world.mass_properties(cue).mass * 100), 1, 1e-6);
}

/// A rod is struck at one end by a ball with e = 1: momentum, angular momentum and energy give the three
/// unknowns. m is the ball's mass, M and I the rod's, d the arm: J = 2 v / (1/m + 1/M + d²/I).
TYPED_TEST(Conservation, ARodThatIsStruckTurns) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    Material elastic;
    elastic.restitution = 1;
    elastic.friction = 0;
    BodyDefinition<D> rod = body_of<D>(Box<D>{vec<D>(0.2, 2, 0.2)}, {}, elastic);
    rod.mass = 2;
    BodyDefinition<D> ball = body_of<D>(Ball{0.1}, vec<D>(-1, 0.75), elastic);
    ball.mass = 1;
    ball.velocity = vec<D>(5, 0);
    const BodyId<D> r = world.add_body(rod), b = world.add_body(ball);
    run(world, 20);
    const double inertia = 2 * (4 + 0.04) / 12;
    const double blow = 2 * 5 / (1 + 0.5 + 0.75 * 0.75 / inertia);
    EXPECT_NEAR(world.velocity(b).x, 5 - blow, 0.01);
    EXPECT_NEAR(world.velocity(r).x, blow / 2, 0.01);
    EXPECT_NEAR(spin_speed<D>(world.angular_velocity(r)), 0.75 * blow / inertia, 0.02);
    EXPECT_NEAR(world.energy().kinetic, 12.5, 0.05);
}

/// In a pile the energy only falls: bodies are poured on the ground, and the total never rises over a step by
/// more than a little (overlaps that are pushed apart lift bodies).
TYPED_TEST(Conservation, EnergyNeverGrowsInAPile) {
    constexpr int D = TypeParam::value;
    Random random(9);
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    for (const double x : {-3.0, 3.0}) world.add_body(fixed_of<D>(Box<D>{vec<D>(1, 12, 12)}, vec<D>(x, 6)));
    for (const double z : {-3.0, 3.0})
        if (D == 3) world.add_body(fixed_of<D>(Box<D>{vec<D>(12, 12, 1)}, vec<D>(0, 6, z)));
    for (int i = 0; i < 40; ++i) {
        const double x = random.between(-1.5, 1.5), z = random.between(-1.5, 1.5);
        BodyDefinition<D> d = body_of<D>(i % 2 ? Geometry<D>{Ball{0.35}} : Geometry<D>{cube<D>(0.6)},
                                         vec<D>(x, 1 + 0.8 * i * (D == 2 ? 0.6 : 0.3), z));
        d.rotation = random.rotation<D>();
        world.add_body(d);
    }
    double lowest = world.energy().total(), rise = 0;
    const double scale = lowest;
    for (int i = 0; i < 600; ++i) {
        world.step(frame_time);
        const double now = world.energy().total();
        rise = std::max(rise, (now - lowest) / scale);
        lowest = std::min(lowest, now);
    }
    EXPECT_LT(rise, 0.005);
    EXPECT_LT(world.energy().kinetic / scale, 1e-3) << "and it comes to rest";
}

}  // namespace
}  // namespace carom::test
