#include <gtest/gtest.h>

#include <limits>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Whatever one does to a world, it stays one: no state becomes non-finite, nothing sinks through the floor.

namespace carom::test {
namespace {

template <int D>
Hull<D> random_hull(Random& random, double size) {
    Hull<D> hull;
    const int corners = D + 2 + random.below(8);
    for (int i = 0; i < corners; ++i) hull.points.push_back(size * random.direction<D>());
    return hull;
}

/// Any kind of shape, about as large as a ball of that radius.
template <int D>
Geometry<D> random_shape(Random& random, double size) {
    const Vec<D> half = (0.5 * size) * random.direction<D>();
    Vec<D> sides;
    for (int i = 0; i < D; ++i) sides[i] = size * random.between(0.5, 1.8);
    switch (random.below(D == 2 ? 5 : 7)) {
        case 0:
            return Ball{size};
        case 1:
            return Box<D>{sides};
        case 2:
            return Capsule<D>{-half, half, 0.5 * size};
        case 3:
            return random_hull<D>(random, size);
        case 4:
            return Box<D>{sides, 0.1 * size};
    }
    if constexpr (D == 3) {
        const double height = size * random.between(0.5, 2);
        if (random.below(2)) return Cylinder{size * random.between(0.4, 1), height};
        return Cone{size, height};
    }
    return Ball{size};
}

template <int D>
bool all_finite(const World<D>& world) {
    for (const BodyId<D>& body : world.bodies()) {
        double sum = spin_speed<D>(world.angular_velocity(body));
        for (int i = 0; i < D; ++i)
            sum += std::fabs(world.position(body)[i]) + std::fabs(world.velocity(body)[i]);
        const Vec<D> x = rotate(world.rotation(body), vec<D>(1, 0));
        if (!std::isfinite(sum) || std::fabs(length(x) - 1) > 1e-9) return false;
    }
    return true;
}

/// The lowest centre of mass, m.
template <int D>
double lowest(const World<D>& world) {
    double y = std::numeric_limits<double>::infinity();
    for (const BodyId<D>& body : world.bodies()) {
        if (world.type(body) == BodyType::dynamic) y = std::min(y, world.center_of_mass(body).y);
    }
    return y;
}

/// A floor that is a plane or a block, and four walls.
template <int D>
void add_pit(World<D>& world, bool plane, double size) {
    if (plane)
        world.add_body(ground<D>());
    else
        world.add_body(fixed_of<D>(Box<D>{vec<D>(4 * size, size, 4 * size)}, vec<D>(0, -0.5 * size)));
    for (int axis = 0; axis < D; ++axis) {
        if (axis == 1) continue;
        for (const double side : {-1.0, 1.0}) {
            Vec<D> sides = vec<D>(4 * size, 8 * size, 4 * size), place{};
            sides[axis] = size;
            place[axis] = 1.5 * side * size;
            world.add_body(fixed_of<D>(Box<D>{sides}, place));
        }
    }
}

template <class T>
class Piles : public testing::Test {};
TYPED_TEST_SUITE(Piles, BothDimensions);

TYPED_TEST(Piles, OfAllShapesComeToRest) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        World<D> world;
        add_pit(world, seed % 2 == 0, 3);
        for (int i = 0; i < 40; ++i) {
            const double size = random.between(0.2, 0.5);
            BodyDefinition<D> d = body_of<D>(random_shape<D>(random, size));
            d.position = random.in_cube<D>(0.8);
            d.position.y = 1 + 0.5 * i;
            d.rotation = random.rotation<D>();
            d.angular_velocity = spin<D>(random.between(-5, 5));
            world.add_body(d);
        }
        run(world, 900);
        const double low = lowest(world), overlap = deepest_overlap(world);
        ASSERT_TRUE(all_finite(world));
        EXPECT_GT(low, 0) << "seed " << seed << ": through the floor";
        EXPECT_LT(fastest(world), 6) << "seed " << seed << ": more than a round one that still rolls";
        EXPECT_LT(overlap, 0.05) << "seed " << seed;
        EXPECT_TRUE(world.quarantined().empty());
    }
}

/// Gravel of one centimetre to blocks of a hundred metres, each on its own floor.
TYPED_TEST(Piles, OfExtremeSizes) {
    constexpr int D = TypeParam::value;
    for (const double size : {0.01, 0.1, 10.0, 100.0}) {
        Random random(3);
        World<D> world;
        add_pit(world, true, 8 * size);
        for (int i = 0; i < 20; ++i) {
            BodyDefinition<D> d = body_of<D>(random_shape<D>(random, size));
            d.position = random.in_cube<D>(2 * size);
            d.position.y = size * (2 + 1.5 * i);
            d.rotation = random.rotation<D>();
            world.add_body(d);
        }
        const double before = world.energy().total();
        // Large things fall slowly: as many steps as the fall and as much again.
        run(world, 300 + static_cast<int>(4 * 60 * std::sqrt(60 * size / 9.81)));
        ASSERT_TRUE(all_finite(world)) << "size " << size;
        EXPECT_GT(lowest(world), 0) << "size " << size;
        EXPECT_LT(deepest_overlap(world), 0.1 * size + 0.02) << "size " << size;
        EXPECT_LT(world.energy().kinetic, 1e-2 * before) << "size " << size;
    }
}

/// Light things under heavy ones, ten thousand to one.
TYPED_TEST(Piles, OfExtremeMassRatios) {
    constexpr int D = TypeParam::value;
    Random random(4);
    World<D> world;
    add_pit(world, true, 3);
    for (int i = 0; i < 24; ++i) {
        BodyDefinition<D> d = body_of<D>(random_shape<D>(random, 0.4));
        d.mass = i % 2 ? 1 : 10000;
        d.position = random.in_cube<D>(0.8);
        d.position.y = 1 + i;
        world.add_body(d);
    }
    for (int i = 0; i < 600; ++i) {
        world.step(frame_time);
        ASSERT_TRUE(all_finite(world)) << "step " << i;
        ASSERT_GT(lowest(world), -0.2) << "step " << i;
        // A light one shoots out from between heavy ones: at up to 213 m/s in sixty such piles.
        ASSERT_LT(fastest(world), 300) << "step " << i;
    }
}

/// Bodies that are put into one another come apart, and not like shrapnel.
TYPED_TEST(Piles, OfBodiesInOnePlaceComeApart) {
    constexpr int D = TypeParam::value;
    Random random(5);
    World<D> world;
    world.add_body(ground<D>());
    for (int i = 0; i < 20; ++i) {
        BodyDefinition<D> d = body_of<D>(random_shape<D>(random, 0.4));
        d.position = vec<D>(0, 0.5) + random.in_cube<D>(0.1);
        world.add_body(d);
    }
    // Two in exactly the same place and turn, too.
    world.add_body(body_of<D>(cube<D>(0.5), vec<D>(5, 0.5)));
    world.add_body(body_of<D>(cube<D>(0.5), vec<D>(5, 0.5)));
    world.add_body(body_of<D>(Ball{0.5}, vec<D>(9, 0.5)));
    world.add_body(body_of<D>(Ball{0.5}, vec<D>(9, 0.5)));
    double fast = 0;
    for (int i = 0; i < 600; ++i) {
        world.step(frame_time);
        ASSERT_TRUE(all_finite(world)) << "step " << i;
        fast = std::max(fast, fastest(world, 0));
    }
    EXPECT_LT(fast, 30);
    EXPECT_GT(lowest(world), 0);
    EXPECT_LT(deepest_overlap(world), 0.02);
}

/// A body deep under the surface of a plane or block is pushed out.
TYPED_TEST(Piles, DeepOverlapWithFixedBodiesIsPushedOut) {
    constexpr int D = TypeParam::value;
    for (const bool plane : {true, false}) {
        World<D> world;
        add_pit(world, plane, 20);
        const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, -1.5)));
        run(world, 300);
        EXPECT_NEAR(world.position(box).y, 0.5, 0.01);
    }
}

/// Fast, but not absurdly so: balls thrown at floor and walls at up to 100 m/s stay in the pit.
TYPED_TEST(Piles, FastBallsStayInside) {
    constexpr int D = TypeParam::value;
    Random random(6);
    World<D> world(sleepless<D>());
    add_pit(world, false, 4);
    world.add_body(fixed_of<D>(Box<D>{vec<D>(16, 4, 16)}, vec<D>(0, 18)));  // and a lid
    int inside = 0, all = 0;
    for (int i = 0; i < 30; ++i) {
        Material bouncy;
        bouncy.restitution = 0.5;
        BodyDefinition<D> d = body_of<D>(Ball{0.2}, random.in_cube<D>(1.5) + vec<D>(0, 2), bouncy);
        const double speed = random.between(20, 100);
        d.velocity = speed * random.direction<D>();
        if (d.velocity.y > 5) d.velocity.y = -d.velocity.y;
        world.add_body(d);
    }
    run(world, 300);
    for (const BodyId<D>& body : world.bodies()) {
        if (world.type(body) != BodyType::dynamic) continue;
        ++all;
        bool in = world.position(body).y > 0;
        for (int i = 0; i < D; ++i) in = in && (i == 1 || std::fabs(world.position(body)[i]) < 4.1);
        inside += in;
    }
    EXPECT_TRUE(all_finite(world));
    EXPECT_EQ(inside, all);
}

/// Velocities, spins, forces and places beyond reason: the world goes on.
TYPED_TEST(Piles, SurviveAbsurdNumbers) {
    constexpr int D = TypeParam::value;
    for (const double absurd : {1e4, 1e8, 1e20, 1e60, 1e155, 1e300}) {
        World<D> world;
        world.add_body(ground<D>());
        std::vector<BodyId<D>> victims, quiet;
        for (int i = 0; i < 6; ++i) {
            victims.push_back(world.add_body(body_of<D>(cube<D>(1), vec<D>(3 * i, 0.5))));
            quiet.push_back(world.add_body(body_of<D>(cube<D>(1), vec<D>(-2000 - 3 * i, 0.5))));
        }
        run(world, 5);
        world.set_velocity(victims[0], vec<D>(0, absurd));
        world.set_velocity(victims[1], vec<D>(0, -absurd));
        world.set_angular_velocity(victims[2], spin<D>(absurd));
        world.apply_force(victims[3], vec<D>(0, absurd), vec<D>(absurd, 0));
        world.set_transform(victims[4], {vec<D>(absurd, absurd), {}});
        world.add_force({ConstantForce<D>{victims[5], vec<D>(0, absurd)}});
        run(world, 200);
        ASSERT_TRUE(all_finite(world)) << absurd;
        for (const BodyId<D>& body : quiet) {
            ASSERT_NEAR(world.position(body).y, 0.5, 2e-3) << absurd << ": a bystander was harmed";
            ASSERT_LT(length(world.velocity(body)), 1e-2) << absurd;
        }
        const BodyId<D> late = world.add_body(body_of<D>(cube<D>(1), vec<D>(-50, 0.6)));
        run(world, 120);
        EXPECT_NEAR(world.position(late).y, 0.5, 2e-3) << absurd << ": the world no longer works";
    }
}

/// Quarantine: the body is put back to where it was, reported once, and nothing touches it any more.
TYPED_TEST(Piles, ABodyThatTurnsNonFiniteIsQuarantined) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> sick = world.add_body(body_of<D>(Ball{0.5}, vec<D>(1, 2)));
    const BodyId<D> well = world.add_body(body_of<D>(Ball{0.5}, vec<D>(9, 2)));
    run(world, 3);
    world.set_velocity(sick, vec<D>(1e300, 0));
    world.set_velocity(well, vec<D>(1, 0));
    run(world, 1);
    ASSERT_EQ(world.quarantined().size(), 1u);
    EXPECT_EQ(world.quarantined()[0], sick);
    EXPECT_EQ(world.position(sick), vec<D>(1, 2));
    EXPECT_EQ(world.velocity(sick), Vec<D>{});
    EXPECT_FALSE(world.awake(sick));
    EXPECT_NEAR(world.position(well).x, 9 + frame_time, 1e-12) << "the rest goes on";
    run(world, 1);
    EXPECT_TRUE(world.quarantined().empty());
    world.set_transform(well, {vec<D>(-1, 2), {}});
    run(world, 240);
    EXPECT_NEAR(world.position(well).x, 3, 1e-12) << "it passes through";
    EXPECT_EQ(world.position(sick), vec<D>(1, 2));
    world.remove_body(sick);
    EXPECT_FALSE(world.contains(sick));
    run(world, 1);
}

/// Random commands of every kind on a pile, for long.
TYPED_TEST(Piles, SurviveRandomCommands) {
    constexpr int D = TypeParam::value;
    Random random(7);
    World<D> world;
    add_pit(world, true, 4);
    const std::size_t fixed = world.bodies().size();
    for (int i = 0; i < 3000; ++i) {
        const std::size_t count = world.bodies().size() - fixed;
        if (count < 5 || (count < 30 && random.below(20) == 0)) {
            BodyDefinition<D> d = body_of<D>(random_shape<D>(random, random.between(0.1, 0.6)));
            d.position = random.in_cube<D>(2);
            d.position.y += 4;
            d.rotation = random.rotation<D>();
            d.type = random.below(6) == 0 ? BodyType::kinematic : BodyType::dynamic;
            world.add_body(d);
        }
        const BodyId<D> body = world.bodies()[fixed + random.bits() % (world.bodies().size() - fixed)];
        switch (random.below(40)) {
            case 0:
                world.remove_body(body);
                break;
            case 1:
                world.set_velocity(body, random.in_cube<D>(10));
                break;
            case 2:
                world.set_angular_velocity(body, spin<D>(random.between(-20, 20)));
                break;
            case 3: {
                const Vec<D> place = random.in_cube<D>(2) + vec<D>(0, 4);
                world.set_transform(body, {place, random.rotation<D>()});
                break;
            }
            case 4:
                world.set_type(body, random.below(2) ? BodyType::dynamic : BodyType::kinematic);
                break;
            case 5:
                world.add_shape(body, shape_of<D>(random_shape<D>(random, 0.2)));
                break;
            case 6:
                if (world.type(body) == BodyType::dynamic) world.put_to_sleep(body);
                break;
            case 7:
                world.set_locks(body,
                                {random.below(4) == 0, false, false, false, false, random.below(3) == 0});
                break;
            case 8: {
                const Vec<D> impulse = random.in_cube<D>(500), arm = random.in_cube<D>(1);
                world.apply_impulse(body, impulse, world.position(body) + arm);
                break;
            }
            case 9: {
                Spring<D> spring;
                spring.b = body;
                spring.stiffness = random.between(0, 2000);
                spring.damping = 10;
                if (world.counts().forces < 10) world.add_force({spring});
                break;
            }
            default:
                run(world, 1);
        }
        ASSERT_TRUE(all_finite(world)) << "command " << i;
        ASSERT_TRUE(world.quarantined().empty()) << "command " << i;
    }
}

}  // namespace
}  // namespace carom::test
