#include <gtest/gtest.h>

#include "scene_3.hpp"

namespace carom::test::space {

namespace {

void expect_right(const Scene& scene) {
    const auto found = separation<3>(scene.a, scene.a_placed, scene.b, scene.b_placed);
    ASSERT_TRUE(found);
    const Body3 a = scene.oracle_a(), b = scene.oracle_b();
    const double tolerance = 1e-6 * smaller_size(a, b) + a.vagueness() + b.vagueness();
    EXPECT_NEAR(length(found->axis), 1, 1e-12);
    EXPECT_NEAR(gap_along(a, b, found->axis), found->distance, tolerance) << "the axis has that gap";
    EXPECT_GE(found->distance, widest_gap(a, b) - tolerance) << "no axis has a wider gap";
    EXPECT_EQ(overlap<3>(scene.a, scene.a_placed, scene.b, scene.b_placed), found->distance <= 0);
}

class EveryPair : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(EveryPair, AxisAndDepthMatchTheOracle) {
    const auto [i, j] = GetParam();
    const auto kind_a = static_cast<Kind>(i), kind_b = static_cast<Kind>(j);
    if (kind_a == Kind::plane && kind_b == Kind::plane) return;
    Random random(static_cast<std::uint64_t>(100 * i + j));
    for (int n = 0; n < 150; ++n) {
        Scene scene(kind_a, kind_b, n % 3 == 0, random);
        scene.bring_to(random);
        SCOPED_TRACE(name_of(kind_a) + " on " + name_of(kind_b) + ", case " + std::to_string(n));
        expect_right(scene);
    }
}

TEST_P(EveryPair, AgreesWithTheOracleWhereOneShapeIsAtTheHeartOfTheOther) {
    const auto [i, j] = GetParam();
    const auto kind_a = static_cast<Kind>(i), kind_b = static_cast<Kind>(j);
    if (kind_a == Kind::plane || kind_b == Kind::plane) return;
    Random random(static_cast<std::uint64_t>(5000 + 100 * i + j));
    for (int n = 0; n < 8; ++n) {
        Scene scene(kind_a, kind_b, n % 2 == 0, random);
        scene.b_placed.position = scene.a_placed.position;
        if (n % 4 < 2) scene.b_placed.rotation = scene.a_placed.rotation;
        if (n < 4 && kind_a == kind_b) scene.b = scene.a;
        SCOPED_TRACE(name_of(kind_a) + " in " + name_of(kind_b) + ", case " + std::to_string(n));
        expect_right(scene);
        const Manifold<3> found = collide<3>(scene.a, scene.a_placed, scene.b, scene.b_placed, 0);
        ASSERT_EQ(found.count > 0, overlap<3>(scene.a, scene.a_placed, scene.b, scene.b_placed));
        if (found.count == 0) continue;
        EXPECT_NEAR(length(found.normal), 1, 1e-9);
        for (int k = 0; k < found.count; ++k) {
            EXPECT_TRUE(std::isfinite(length(found.points[static_cast<std::size_t>(k)].position)));
            EXPECT_TRUE(std::isfinite(found.points[static_cast<std::size_t>(k)].separation));
        }
    }
}

TEST(Separation3, ACapsuleWithoutLengthIsABall) {
    const Geometry<3> ball = Ball{0.3}, capsule = Capsule3{{0, 0, 0}, {0, 0, 0}, 0.3};
    Random random(3);
    for (int kind = 0; kind < kinds; ++kind) {
        for (int n = 0; n < 50; ++n) {
            const Geometry<3> other = random_geometry(static_cast<Kind>(kind), 1, random);
            const Transform3 placed = random.placement<3>(0.8), here = random.placement<3>(0.1);
            const auto of_ball = separation<3>(ball, here, other, placed);
            const auto of_capsule = separation<3>(capsule, here, other, placed);
            EXPECT_NEAR(of_ball->distance, of_capsule->distance, 1e-6) << name_of(static_cast<Kind>(kind));
            const Manifold<3> by_ball = collide<3>(ball, here, other, placed, 0.1);
            const Manifold<3> by_capsule = collide<3>(capsule, here, other, placed, 0.1);
            EXPECT_EQ(by_ball.count, by_capsule.count) << name_of(static_cast<Kind>(kind));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Space, EveryPair,
                         testing::Combine(testing::Range(0, kinds), testing::Range(0, kinds)),
                         [](const auto& pair) { return name_of_pair(pair.param); });

}  // namespace

}  // namespace carom::test::space
