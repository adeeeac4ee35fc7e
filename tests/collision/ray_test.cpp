#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "sample.hpp"

namespace carom::test {
namespace {

template <class T>
class RayTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RayTest, Dimensions);

/// Along a ray the distance from a convex shape is a convex function: its least value tells if the ray meets
/// the shape, and from there backwards it falls through zero where the ray enters.
template <int D>
void expect_right(const Sample<D>& sample, const Vec<D>& origin, const Vec<D>& way) {
    const double tolerance = 10 * sample.vagueness + 1e-15 * length(sample.base) + 1e-15 * length(way);
    const auto height = [&](double t) { return sample.height(origin + t * way); };
    const auto hit = cast_ray<D>(sample.solid, sample.placed, origin, way);
    const double best = least_at(height), least = std::min({height(best), height(0), height(1)});
    if (least > tolerance) {
        ASSERT_FALSE(hit) << "a ray that passes at " << least;
    }
    if (least < -tolerance) {
        ASSERT_TRUE(hit) << "a ray that goes " << -least << " deep";
    }
    if (!hit) return;
    EXPECT_GE(hit->fraction, 0);
    EXPECT_LE(hit->fraction, 1);
    if (hit->fraction == 0) {
        EXPECT_LE(height(0), tolerance);
        EXPECT_EQ(hit->point, origin);
        return;
    }
    EXPECT_NEAR(length(hit->point - (origin + hit->fraction * way)), 0, tolerance);
    EXPECT_NEAR(sample.height(hit->point), 0, tolerance) << "the hit is on the surface";
    EXPECT_NEAR(length(hit->normal), 1, 1e-12);
    EXPECT_LE(dot(hit->normal, way), 1e-9 * length(way)) << "the ray comes from outside";
    for (const double before : {0.3, 0.9, 0.999})
        EXPECT_GE(height(before * hit->fraction), -tolerance) << "nothing is in the way";
    // All of the shape is below the surface at the hit, so a little way out no point of it is nearer.
    const double out = 1e-3 * sample.size;
    EXPECT_NEAR(sample.height(hit->point + out * hit->normal), out, 1e-3 * out + 2 * tolerance);
}

TYPED_TEST(RayTest, enters_every_kind_of_shape_where_the_oracle_says) {
    constexpr int D = TypeParam::value;
    Random random(1);
    for (int kind = 0; kind < sample_kinds<D>; ++kind) {
        for (int i = 0; i < 400; ++i) {
            SCOPED_TRACE("kind " + std::to_string(kind) + ", case " + std::to_string(i));
            const double size = std::pow(10, random.between(-2, 2));
            const Sample<D> sample = random_sample<D>(kind, size, random);
            const Vec<D> origin = random.in_cube<D>(3 * size), through = random.in_cube<D>(1.5 * size);
            expect_right<D>(sample, origin, random.between(0.2, 3) * (through - origin));
        }
    }
}

TYPED_TEST(RayTest, is_exact_ten_thousand_kilometres_away) {
    constexpr int D = TypeParam::value;
    Random random(2);
    for (int kind = 0; kind < sample_kinds<D>; ++kind) {
        for (int i = 0; i < 100; ++i) {
            SCOPED_TRACE("kind " + std::to_string(kind) + ", case " + std::to_string(i));
            const Vec<D> base = 1e7 * random.direction<D>();
            const Sample<D> sample = random_sample<D>(kind, 1, random, base);
            const Vec<D> origin = base + random.in_cube<D>(3);
            expect_right<D>(sample, origin, random.between(0.5, 2) * (base + random.in_cube<D>(1) - origin));
        }
    }
}

TYPED_TEST(RayTest, along_the_axes_of_a_shape_and_through_its_corners) {
    constexpr int D = TypeParam::value;
    Random random(3);
    for (int kind = 0; kind < sample_kinds<D>; ++kind) {
        for (int i = 0; i < 300; ++i) {
            SCOPED_TRACE("kind " + std::to_string(kind) + ", case " + std::to_string(i));
            const Sample<D> sample = random_sample<D>(kind, 2, random);
            Vec<D> from{}, way{};
            for (int k = 0; k < D; ++k) {
                from[k] = 0.5 * (random.below(9) - 4);
                way[k] = 2 * (random.below(3) - 1);
            }
            from = apply(sample.placed, from);
            way = rotate(sample.placed.rotation, way);
            if (way != Vec<D>{}) expect_right<D>(sample, from, 3.0 * way);
        }
    }
}

TYPED_TEST(RayTest, without_length_is_a_point) {
    constexpr int D = TypeParam::value;
    Random random(4);
    for (int kind = 0; kind < sample_kinds<D>; ++kind) {
        for (int i = 0; i < 400; ++i) {
            const Sample<D> sample = random_sample<D>(kind, 1, random);
            const Vec<D> point = random.in_cube<D>(1.5);
            const double height = sample.height(point);
            const bool inside = contains<D>(sample.solid, sample.placed, point);
            const auto hit = cast_ray<D>(sample.solid, sample.placed, point, {});
            EXPECT_EQ(hit.has_value(), inside);
            if (hit) {
                EXPECT_EQ(hit->fraction, 0);
                EXPECT_EQ(hit->point, point);
                EXPECT_EQ(hit->normal, Vec<D>{});
            }
            if (std::fabs(height) > 10 * sample.vagueness) {
                EXPECT_EQ(inside, height < 0) << "kind " << kind;
            }
        }
    }
}

TYPED_TEST(RayTest, that_begins_inside_hits_at_once_against_its_direction) {
    constexpr int D = TypeParam::value;
    Vec<D> way{};
    way.x = 4;
    const auto hit = cast_ray<D>(Geometry<D>(Ball{1}), Transform<D>{}, Vec<D>{}, way);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->fraction, 0);
    EXPECT_EQ(hit->point, Vec<D>{});
    EXPECT_EQ(hit->normal, -0.25 * way);
}

TYPED_TEST(RayTest, ends_and_surfaces_belong_to_it) {
    constexpr int D = TypeParam::value;
    Vec<D> left{}, way{};
    left.x = -3;
    way.x = 2;
    const Solid<D> ball{Geometry<D>(Ball{1})};
    const auto hit = cast_ray<D>(ball, Transform<D>{}, left, way);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->fraction, 1);
    EXPECT_FALSE(cast_ray<D>(ball, Transform<D>{}, left, 0.999999 * way));
    const auto away = cast_ray<D>(ball, Transform<D>{}, left + way, -way);
    ASSERT_TRUE(away) << "to touch is to overlap";
    EXPECT_EQ(away->fraction, 0);
}

TYPED_TEST(RayTest, from_very_far_is_as_exact_as_its_numbers) {
    constexpr int D = TypeParam::value;
    Vec<D> origin{}, way{};
    origin.x = -1e9;
    origin.y = 0.5;
    way.x = 2e9;
    const auto hit = cast_ray<D>(Geometry<D>(Ball{1}), Transform<D>{}, origin, way);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.x, -std::sqrt(0.75), 1e-6);
    EXPECT_NEAR(length(hit->normal), 1, 1e-12);
    EXPECT_NEAR(hit->normal.y, 0.5, 1e-12);
}

TYPED_TEST(RayTest, refuses_what_is_not_finite) {
    constexpr int D = TypeParam::value;
    Vec<D> lost{};
    lost.y = std::numeric_limits<double>::quiet_NaN();
    const Solid<D> ball{Geometry<D>(Ball{1})};
    const auto refusal = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "not refused";
    };
    const Transform<D> here;
    EXPECT_EQ(refusal([&] { cast_ray<D>(ball, here, lost, {}); }), "origin[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { cast_ray<D>(ball, here, {}, lost); }), "translation[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { contains<D>(ball, here, lost); }), "point[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { cast_shape<D>(ball, here, lost, ball, here); }),
              "translation[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { time_of_impact<D>(ball, {}, ball, {}, 0); }), "tolerance: 0 is not positive");
    EXPECT_EQ(refusal([&] { time_of_impact<D>(ball, {}, ball, {.start = here, .translation = lost}); }),
              "b_sweep.translation[1]: nan is not finite");
}

}  // namespace
}  // namespace carom::test
