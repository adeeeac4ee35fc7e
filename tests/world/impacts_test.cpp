#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Impacts with restitution: at their time, and several at once.

namespace carom::test {
namespace {

template <class T>
class ImpactsIn : public testing::Test {};
TYPED_TEST_SUITE(ImpactsIn, BothDimensions);

Material elastic(double restitution = 1, double friction = 0) {
    Material material;
    material.restitution = restitution;
    material.friction = friction;
    return material;
}

template <int D>
BodyDefinition<D> ball(const Vec<D>& position, double radius, const Material& material) {
    BodyDefinition<D> body;
    body.mass = 1;
    body.position = position;
    body.shapes.push_back({Ball{radius}});
    body.shapes.back().material = material;
    return body;
}

/// Five balls that touch; the first two come.
template <int D>
std::vector<double> speeds_after_cradle(Impacts impacts) {
    WorldDefinition<D> definition;
    definition.gravity = {};
    definition.impacts = impacts;
    World<D> world(definition);
    std::vector<BodyId<D>> ids;
    for (int i = 0; i < 5; ++i) {
        auto d = ball<D>(vec<D>(0.2 * i - (i < 2 ? 0.05 : 0), 0), 0.1, elastic());
        if (i < 2) d.velocity = vec<D>(2, 0);
        ids.push_back(world.add_body(d));
    }
    for (int i = 0; i < 12; ++i) world.step(frame_time);
    std::vector<double> speeds;
    for (const BodyId<D> id : ids) speeds.push_back(world.velocity(id).x);
    return speeds;
}

TYPED_TEST(ImpactsIn, CradlePassesTheBlowOn) {
    constexpr int D = TypeParam::value;
    const std::vector<double> expected{0, 0, 0, 2, 2};
    const auto together = speeds_after_cradle<D>(Impacts::simultaneous);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(together[i], expected[i], 2e-6) << i;
}

TYPED_TEST(ImpactsIn, ComeTogetherOnlyIfTheWorldSaysSo) {
    constexpr int D = TypeParam::value;
    EXPECT_NE(speeds_after_cradle<D>(Impacts::simultaneous), speeds_after_cradle<D>(Impacts::sequential));
}

/// 49 balls in a box; the largest change of their energy in 20 s, as a share of what it was.
template <int D>
double energy_change(double step, bool weightless) {
    WorldDefinition<D> definition;
    definition.restitution_threshold = 0;
    if (weightless) definition.gravity = {};
    World<D> world(definition);
    for (int axis = 0; axis < D; ++axis) {
        for (const double side : {1.0, -1.0}) {
            BodyDefinition<D> wall;
            wall.type = BodyType::fixed;
            Vec<D> normal{};
            normal[axis] = side;
            wall.shapes.push_back({Plane<D>{normal, side > 0 ? 0.0 : -2.0}});
            wall.shapes.back().material = elastic();
            world.add_body(wall);
        }
    }
    Random random(3);
    for (int i = 0; i < 49; ++i) {
        auto d = ball<D>(vec<D>(0.2 + 0.26 * (i % 7), 0.2 + 0.26 * (i / 7), 1 + random.between(-0.1, 0.1)),
                         0.08, elastic());
        for (int k = 0; k < D; ++k) d.velocity[k] = random.between(-2, 2);
        world.add_body(d);
    }
    const double before = world.energy().total();
    double worst = 0;
    for (double time = 0; time < 20; time += step) {
        world.step(step);
        worst = std::max(worst, std::fabs(world.energy().total() / before - 1));
    }
    return worst;
}

TYPED_TEST(ImpactsIn, ElasticBallsKeepTheirEnergy) {
    constexpr int D = TypeParam::value;
    EXPECT_LT(energy_change<D>(1.0 / 100, true), 1e-9);
    EXPECT_LT(energy_change<D>(1.0 / 60, true), 1e-9);
    EXPECT_LT(energy_change<D>(1.0 / 100, false), 1e-5);
    EXPECT_LT(energy_change<D>(1.0 / 60, false), 1e-2);
}

TYPED_TEST(ImpactsIn, DroppedPileGainsNothing) {
    constexpr int D = TypeParam::value;
    for (const double restitution : {0.0, 0.3, 0.7}) {
        World<D> world;
        BodyDefinition<D> floor;
        floor.type = BodyType::fixed;
        floor.shapes.push_back({Plane<D>{vec<D>(0, 1), 0}});
        floor.shapes.back().material = elastic(restitution, 0.5);
        world.add_body(floor);
        constexpr std::size_t side = 6;
        Random random(5);
        for (std::size_t i = 0; i < 216; ++i) {
            const double jitter = random.between(-0.02, 0.02);
            const std::size_t column = D == 2 ? i % (side * side) : i % side;
            const std::size_t row = i / (side * side);
            world.add_body(ball<D>(vec<D>(0.25 * column + jitter, 0.5 + 0.25 * row, 0.25 * (i / side % side)),
                                   0.1, elastic(restitution, 0.5)));
        }
        double energy = world.energy().total();
        for (int i = 0; i < 200; ++i) {
            world.step(frame_time);
            const double now = world.energy().total();
            EXPECT_LT(now, energy * (1 + 2e-3)) << "step " << i << ", restitution " << restitution;
            energy = std::min(energy, now);
        }
    }
}

}  // namespace
}  // namespace carom::test
