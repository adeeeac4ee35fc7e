#include "carom/parts/masonry.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::vec;

template <class T>
class Masonry : public testing::Test {};
TYPED_TEST_SUITE(Masonry, test::BothDimensions);

/// A beam of cubes of half a metre that sticks out of a fixed one, to the right.
template <int D>
std::vector<BodyId<D>> add_beam(World<D>& world, int length) {
    std::vector<BodyId<D>> bodies;
    for (int i = 0; i <= length; ++i) {
        BodyDefinition<D> cube;
        cube.type = i == 0 ? BodyType::fixed : BodyType::dynamic;
        cube.position = vec<D>(0.5 * i, 5);
        cube.shapes.push_back({Box<D>{vec<D>(0.5, 0.5, 0.5)}});
        bodies.push_back(world.add_body(cube));
    }
    return bodies;
}

TYPED_TEST(Masonry, ABeamHoldsUntilItsOwnWeightBendsItTooMuch) {
    constexpr int D = TypeParam::value;
    constexpr int length = 4;
    // At the wall the torque is ρ A g L² / 2, and the stress at the rim that over A w / 6.
    const double reach = 0.5 * length;
    const double stress = 1000 * 9.81 * reach * reach / 2 / (0.5 / 6);
    // A load that is there all at once stresses by up to twice as much.
    for (const double share : {0.8, 2.2}) {
        World<D> world;
        const std::vector<BodyId<D>> beam = add_beam(world, length);
        const std::vector<JointId<D>> joints = glue<D>(world, beam, Mortar<D>{.strength = share * stress});
        ASSERT_EQ(joints.size(), 4u);
        std::size_t broken = 0;
        for (int i = 0; i < 120; ++i) {
            world.step(test::frame_time);
            broken += world.joint_breaks().size();
        }
        if (share < 1) {
            EXPECT_GT(broken, 0u);
            EXPECT_LT(world.position(beam.back()).y, 0);
        } else {
            EXPECT_EQ(broken, 0u);
            EXPECT_NEAR(world.position(beam.back()).y, 5, 0.01);
        }
    }
}

TYPED_TEST(Masonry, AWallBreaksWhereItIsHit) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> ground;
    ground.type = BodyType::fixed;
    ground.shapes.push_back({Box<D>{vec<D>(40, 1, 40)}});
    ground.position = vec<D>(0, -0.5);
    std::vector<BodyId<D>> wall{world.add_body(ground)};
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < (D == 2 ? 1 : 5); ++column) {
            BodyDefinition<D> brick;
            brick.position = vec<D>(0, 0.25 + 0.5 * row, column - 2.0 + 0.5 * (row % 2));
            brick.shapes.push_back({Box<D>{vec<D>(0.5, 0.5, 1)}});
            wall.push_back(world.add_body(brick));
        }
    }
    // The shot bends the wall by 8 MPa about its foot if it stops within a step: 15 kN s / (1/60 s) * 2 m on
    // a section of 5 m x 0.5 m in space. It gives way, so it is less.
    const double strength = D == 2 ? 1e7 : 2.5e6;
    const std::vector<JointId<D>> joints = glue<D>(world, wall, Mortar<D>{.strength = strength});
    EXPECT_EQ(joints.size(), D == 2 ? 6u : 5u + 6 * 4 + 5 * 9);
    for (int i = 0; i < 60; ++i) world.step(test::frame_time);
    EXPECT_EQ(world.counts().joints, static_cast<int>(joints.size()));
    BodyDefinition<D> ball;
    ball.position = vec<D>(-4, 2);
    ball.velocity = vec<D>(14, 0);
    ball.shapes.push_back({Ball{0.5}});
    ball.shapes[0].material.density = D == 2 ? 1000 : 2000;
    const BodyId<D> shot = world.add_body(ball);
    std::size_t broken = 0;
    for (int i = 0; i < 240; ++i) {
        world.step(test::frame_time);
        broken += world.joint_breaks().size();
    }
    EXPECT_GT(broken, 0u);
    EXPECT_LT(broken, D == 2 ? 6u : 60u);  // some of it is still whole
    for (const BodyId<D> brick : wall) EXPECT_GT(world.position(brick).y, -1);
    EXPECT_LT(length(world.velocity(shot)), 14);
}

TYPED_TEST(Masonry, GluesFacesAlone) {
    constexpr int D = TypeParam::value;
    World<D> world;
    std::vector<BodyId<D>> bodies = add_beam(world, 1);
    BodyDefinition<D> other;
    other.position = vec<D>(0.5, 5.75);
    other.shapes.push_back({Ball{0.25}});  // touches in a point
    bodies.push_back(world.add_body(other));
    other.position = vec<D>(1.02, 5);
    other.shapes[0].geometry = Box<D>{vec<D>(0.5, 0.5, 0.5)};  // 2 cm away
    bodies.push_back(world.add_body(other));
    EXPECT_EQ(glue<D>(world, bodies).size(), 1u);
    EXPECT_THROW(glue<D>(world, bodies, Mortar<D>{.strength = 0}), Error);
    EXPECT_THROW(glue<D>(world, bodies, Mortar<D>{.reach = -1}), Error);
}

}  // namespace
}  // namespace carom
