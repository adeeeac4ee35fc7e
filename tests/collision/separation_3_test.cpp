#include <gtest/gtest.h>

#include "oracle_3.hpp"

namespace carom::test::space {

namespace {

/// Two shapes of the given kinds and sizes, placed so that along a random direction they are `gap` apart.
struct Scene {
    Scene(Kind kind_a, Kind kind_b, double size_a, double size_b, Random& random)
        : a(random_geometry(kind_a, size_a, random)), b(random_geometry(kind_b, size_b, random)) {
        a_placed.rotation = random.below(3) ? random.rotation<3>() : Rotation3{};
        b_placed.rotation = random.below(3) ? random.rotation<3>() : Rotation3{};
        a_placed.position = random.in_cube<3>(size_a);
        b_placed.position = a_placed.position;
    }

    Body3 oracle_a() const { return {a, a_placed}; }
    Body3 oracle_b() const { return {b, b_placed}; }

    /// Moves b along the direction of the widest gap of the present placement until that gap is `gap`.
    void shift(const Vec3& direction, double by) { b_placed.position += by * direction; }

    Geometry<3> a, b;
    Transform3 a_placed, b_placed;
};

double extent(const Body3& a, const Body3& b) {
    const double smaller = std::min(a.is_plane() ? 1e300 : a.size(), b.is_plane() ? 1e300 : b.size());
    return smaller;
}

void expect_right(const Scene& scene, const std::string& what) {
    SCOPED_TRACE(what);
    const auto found = separation<3>(scene.a, scene.a_placed, scene.b, scene.b_placed);
    ASSERT_TRUE(found);
    const Body3 a = scene.oracle_a(), b = scene.oracle_b();
    const double size = extent(a, b), rounding = 1e-11 * (a.size() + b.size() + length(scene.b_placed.position));
    EXPECT_NEAR(length(found->axis), 1, 1e-12);
    EXPECT_NEAR(gap_along(a, b, found->axis), found->distance, 1e-6 * size + rounding) << "the axis has that gap";
    EXPECT_GE(found->distance, widest_gap(a, b) - 1e-6 * size - rounding) << "no axis has a wider gap";
    EXPECT_EQ(overlap<3>(scene.a, scene.a_placed, scene.b, scene.b_placed), found->distance <= 0);
}

class EveryPair : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(EveryPair, AxisAndDepthMatchTheOracle) {
    const auto [i, j] = GetParam();
    const auto kind_a = static_cast<Kind>(i), kind_b = static_cast<Kind>(j);
    if (kind_a == Kind::plane && kind_b == Kind::plane) return;
    Random random(static_cast<std::uint64_t>(100 * i + j));
    for (int n = 0; n < (getenv("N") ? atoi(getenv("N")) : 100); ++n) {
        const double size_a = std::pow(10, random.between(-2, 2)), size_b = size_a * std::pow(10, random.between(-0.5, 0.5));
        Scene scene(kind_a, kind_b, size_a, size_b, random);
        const Vec3 direction = random.direction<3>();
        scene.shift(direction, random.between(0, size_a + size_b));
        if (n % 2) {
            const auto found = separation<3>(scene.a, scene.a_placed, scene.b, scene.b_placed);
            const double gap = std::min(size_a, size_b) * (n % 4 == 1 ? 1e-3 : 1e-6) * random.between(-1, 1);
            scene.shift(found->axis, gap - found->distance);
        }
        expect_right(scene, name_of(kind_a) + " on " + name_of(kind_b) + ", case " + std::to_string(n));
    }
}

INSTANTIATE_TEST_SUITE_P(Space, EveryPair, testing::Combine(testing::Range(0, kinds), testing::Range(0, kinds)),
                         [](const auto& pair) {
                             return name_of(static_cast<Kind>(std::get<0>(pair.param))) + "_" +
                                    name_of(static_cast<Kind>(std::get<1>(pair.param)));
                         });

}  // namespace

}  // namespace carom::test::space
