#include <gtest/gtest.h>

#include <cstdlib>

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
    for (int n = 0; n < (getenv("N") ? atoi(getenv("N")) : 100); ++n) {
        Scene scene(kind_a, kind_b, n % 3 == 0, random);
        scene.bring_to(random);
        SCOPED_TRACE(name_of(kind_a) + " on " + name_of(kind_b) + ", case " + std::to_string(n));
        expect_right(scene);
    }
}

INSTANTIATE_TEST_SUITE_P(Space, EveryPair, testing::Combine(testing::Range(0, kinds), testing::Range(0, kinds)),
                         [](const auto& pair) { return name_of_pair(pair.param); });

}  // namespace

}  // namespace carom::test::space
