#include "builders.hpp"
#include "collision/random.hpp"

// What is fast meets what is in its way.

namespace carom::test {
namespace {

template <class T>
struct Continuous : testing::Test {};
TYPED_TEST_SUITE(Continuous, BothDimensions);

constexpr double far = 10000;

/// A wall at x = 0 that is thin or has no thickness at all.
Geometry<2> wall(std::integral_constant<int, 2>, int kind) {
    if (kind == 0) return Box<2>{{0.02, 2 * far}};
    Chain chain;
    chain.two_sided = kind == 1;
    chain.points = {{0, -far}, {0, -2}, {0, 1}, {0, far}};  // the solid is on the right
    return chain;
}
Geometry<3> wall(std::integral_constant<int, 3>, int kind) {
    if (kind == 0) return Box<3>{{0.02, 2 * far, 2 * far}};
    Mesh mesh;
    mesh.two_sided = kind == 1;
    constexpr std::uint32_t cells = 12;
    for (std::uint32_t i = 0; i <= cells; ++i) {
        for (std::uint32_t k = 0; k <= cells; ++k)
            mesh.vertices.push_back(
                {0, -far + i * (2 * far / cells) + (i % 3), -far + k * (2 * far / cells)});
    }
    for (std::uint32_t i = 0; i < cells; ++i) {
        for (std::uint32_t k = 0; k < cells; ++k) {
            const std::uint32_t a = i * (cells + 1) + k, b = a + 1, c = a + cells + 1, d = c + 1;
            mesh.triangles.push_back({a, b, c});  // looks to −x
            mesh.triangles.push_back({b, d, c});
        }
    }
    return mesh;
}

Geometry<2> bullet(std::integral_constant<int, 2>, Random& random) {
    switch (random.below(4)) {
        case 0:
            return Ball{random.between(0.1, 0.3)};
        case 1:
            return Box<2>{{random.between(0.1, 1.1), random.between(0.02, 0.3)}};
        case 2:
            return Capsule<2>{{-0.3, 0}, {random.between(0, 0.3), 0}, random.between(0.05, 0.15)};
        default:
            return Hull<2>{{{-0.4, -0.1}, {random.between(0, 0.5), 0}, {0, 0.3}}};
    }
}
Geometry<3> bullet(std::integral_constant<int, 3>, Random& random) {
    switch (random.below(6)) {
        case 0:
            return Ball{random.between(0.1, 0.3)};
        case 1:
            return Box<3>{{random.between(0.1, 1.1), random.between(0.02, 0.3), random.between(0.1, 0.4)}};
        case 2:
            return Capsule<3>{{-0.3, 0, 0}, {random.between(0, 0.3), 0, 0}, random.between(0.05, 0.15)};
        case 3:
            return Cylinder{random.between(0.1, 0.3), random.between(0.1, 0.6)};
        case 4:
            return Cone{random.between(0.1, 0.3), random.between(0.1, 0.6)};
        default:
            return Hull<3>{{{-0.4, -0.1, 0}, {random.between(0, 0.5), 0, 0.1}, {0, 0.3, 0}, {0, 0.1, 0.4}}};
    }
}

template <int D>
Angular<D> any_spin(Random& random) {
    if constexpr (D == 2)
        return random.between(-100, 100);
    else
        return {random.between(-57, 57), random.between(-57, 57), random.between(-57, 57)};
}

TYPED_TEST(Continuous, nothing_passes_through_a_thin_wall) {
    constexpr int D = TypeParam::value;
    Random random(3);
    const int count = trials(600);
    for (int trial = 0; trial < count; ++trial) {
        World<D> world(no_gravity<D>());
        world.add_body(fixed_of<D>(wall(TypeParam{}, trial % 3)));
        BodyDefinition<D> body = body_of<D>(bullet(TypeParam{}, random));
        const double speed = std::exp(random.between(0, std::log(1000.0))), angle = random.between(-1.4, 1.4);
        body.position = vec<D>(random.between(-4, -0.9), random.between(-1, 1), random.between(-1, 1));
        body.velocity = vec<D>(speed * std::cos(angle), speed * std::sin(angle));
        body.angular_velocity = any_spin<D>(random);
        body.shapes[0].material.restitution = trial % 4 == 0 ? 0.5 : 0;
        const BodyId<D> id = world.add_body(body);
        double furthest = -1;
        for (int i = 0; i < 60; ++i) {
            world.step(frame_time);
            furthest = std::max(furthest, world.center_of_mass(id).x);
        }
        ASSERT_LT(furthest, 0.02) << "trial " << trial << ", speed " << speed;
    }
}

TYPED_TEST(Continuous, a_bullet_does_not_pass_through_what_moves) {
    constexpr int D = TypeParam::value;
    for (const double speed : {50.0, 300.0, 1000.0}) {
        World<D> world(no_gravity<D>());
        BodyDefinition<D> target = body_of<D>(Box<D>{vec<D>(0.05, 4, 4)});
        target.velocity = vec<D>(-3, 0);
        const BodyId<D> plate = world.add_body(target);
        BodyDefinition<D> shot = body_of<D>(Box<D>{vec<D>(0.3, 0.1, 0.1)}, vec<D>(-2, 0.3));
        shot.velocity = vec<D>(speed, 0);
        shot.angular_velocity = spin<D>(40);
        shot.bullet = true;
        const BodyId<D> bullet_body = world.add_body(shot);
        for (int i = 0; i < 12; ++i) {
            world.step(frame_time);
            const Vec<D> apart = world.center_of_mass(bullet_body) - world.center_of_mass(plate);
            const Vec<D> seen = unrotate(world.rotation(plate), apart);
            if (std::fabs(seen.y) > 2) break;  // it has slid off the end
            ASSERT_LT(seen.x, 0) << "speed " << speed << ", step " << i;
        }
        EXPECT_GT(world.velocity(plate).x, -3) << speed;
    }
}

TYPED_TEST(Continuous, a_flat_impact_without_restitution_ends_at_rest) {
    constexpr int D = TypeParam::value;
    for (const double rounding : {0.0, 0.1}) {
        for (const double speed : {1.0, 5.0, 20.0}) {
            World<D> world(sleepless<D>());
            Material smooth;
            smooth.friction = 0;
            world.add_body(fixed_of<D>(Box<D>{vec<D>(40, 1, 20)}, vec<D>(0, -0.5), smooth));
            world.add_body(fixed_of<D>(Box<D>{vec<D>(1, 1, 20)}, vec<D>(3.5, 0.5), smooth));
            BodyDefinition<D> box = body_of<D>(Box<D>{vec<D>(1, 1, 1), rounding}, vec<D>(0, 0.5), smooth);
            box.velocity = vec<D>(speed, 0);
            const BodyId<D> id = world.add_body(box);
            double backwards = 0;
            for (int i = 0; i < static_cast<int>(150 / speed) + 60; ++i) {
                world.step(frame_time);
                backwards = std::max(backwards, -world.velocity(id).x);
            }
            EXPECT_LT(backwards, 1e-4 * speed) << "speed " << speed << ", rounding " << rounding;
            EXPECT_NEAR(world.position(id).x, 2.5, 1e-3) << "speed " << speed << ", rounding " << rounding;
            EXPECT_LT(spin_speed<D>(world.angular_velocity(id)), 1e-3) << "speed " << speed;
        }
    }
}

}  // namespace
}  // namespace carom::test
