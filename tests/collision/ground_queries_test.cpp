#include <gtest/gtest.h>

#include "carom/collide.hpp"
#include "random.hpp"

namespace carom::test {
namespace {

/// Waves of ground, as a height field and as a chain or mesh of the same facets.
double wave(int i, int k) { return 0.3 * ((i * 7 + k * 5) % 4); }

template <int D>
Solid<D> field() {
    HeightField<D> ground;
    if constexpr (D == 2) {
        for (int i = 0; i < 21; ++i) ground.heights.push_back(wave(i, 0));
        ground.spacing = {0.5};
    } else {
        for (int k = 0; k < 21; ++k) {
            auto& row = ground.heights.emplace_back();
            for (int i = 0; i < 21; ++i) row.push_back(wave(i, k));
        }
        ground.spacing = {0.5, 0.5};
    }
    return Geometry<D>(ground);
}

template <int D>
Vec<D> vec(double x, double y, [[maybe_unused]] double z) {
    if constexpr (D == 2)
        return {x, y};
    else
        return {x, y, z};
}

template <class T>
class GroundQueriesTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GroundQueriesTest, Dimensions);

/// A ray from above finds the ground, and so does a tiny ball that falls or that spins as it falls.
TYPED_TEST(GroundQueriesTest, rays_casts_and_impacts_agree) {
    constexpr int D = TypeParam::value;
    const Solid<D> ground = field<D>(), ball{Geometry<D>(Ball{1e-6})};
    Random random(5);
    for (int n = 0; n < 300; ++n) {
        const Vec<D> base = n % 2 ? Vec<D>{} : vec<D>(1e7, -1e7, 1e7);
        const Transform<D> placed{base, {}};
        const Vec<D> from = base + vec<D>(random.between(1, 9), random.between(2, 6), random.between(1, 9));
        const Vec<D> way = vec<D>(random.between(-1, 1), -8, random.between(-1, 1));
        const auto ray = cast_ray<D>(ground, placed, from, way);
        ASSERT_TRUE(ray) << "no gaps between facets";
        EXPECT_GT(ray->normal.y, 0);
        EXPECT_NEAR(closest_points<D>(ground, placed, Geometry<D>(Ball{1e-9}), {ray->point, {}}).distance, 0,
                    1e-8);
        EXPECT_FALSE(cast_ray<D>(ground, placed, from + way, -way)) << "from behind";
        EXPECT_FALSE(contains<D>(ground, placed, from + way)) << "ground has no inside";
        const auto cast = cast_shape<D>(ball, {from, {}}, way, ground, placed);
        ASSERT_TRUE(cast);
        EXPECT_NEAR(cast->fraction, ray->fraction, 1e-5);
        const auto other = cast_shape<D>(ground, placed, -way, ball, {from, {}});
        ASSERT_TRUE(other);
        EXPECT_NEAR(other->fraction, cast->fraction, 1e-6);
        EXPECT_NEAR(length(other->normal + cast->normal), 0, 1e-3);
        Sweep<D> fall{.start = {from, {}}, .translation = way};
        if constexpr (D == 2)
            fall.rotation = 3;
        else
            fall.rotation = {1, 2, 3};
        const auto impact = time_of_impact<D>(ground, {.start = placed}, ball, fall, 1e-6);
        ASSERT_TRUE(impact);
        EXPECT_NEAR(impact->fraction, ray->fraction, 1e-5);
        EXPECT_GT(dot(impact->normal, way), 0) << "out of the ball";
    }
}

TYPED_TEST(GroundQueriesTest, closest_points_are_those_of_the_nearest_facet) {
    constexpr int D = TypeParam::value;
    const Solid<D> ground = field<D>();
    Vec<D> size;
    for (int i = 0; i < D; ++i) size[i] = 0.4;
    const Solid<D> box{Geometry<D>(Box<D>{size})};
    Random random(6);
    for (int n = 0; n < 300; ++n) {
        const Transform<D> placed{vec<D>(random.between(1, 9), random.between(1.3, 6), random.between(1, 9)),
                                  random.rotation<D>()};
        const auto found = closest_points<D>(box, placed, ground, {});
        const auto apart = separation<D>(box, placed, ground, {});
        ASSERT_TRUE(apart);
        EXPECT_NEAR(found.distance, std::max(apart->distance, 0.0), 1e-9);
        EXPECT_NEAR(length(found.on_b - found.on_a), found.distance, 1e-9);
    }
}

}  // namespace
}  // namespace carom::test
