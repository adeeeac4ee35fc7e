#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "sample.hpp"

namespace carom::test {
namespace {

template <class T>
class CastTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CastTest, Dimensions);

template <int D, class Check>
void for_pairs(std::uint64_t seed, int cases, const Check& check) {
    for (int i = 0; i < sample_kinds<D>; ++i) {
        for (int j = 0; j < sample_kinds<D>; ++j) {
            Random random(seed + std::uint64_t(100 * i + j));
            for (int n = 0; n < cases; ++n) {
                SCOPED_TRACE("kinds " + std::to_string(i) + " and " + std::to_string(j) + ", case " +
                             std::to_string(n));
                const Vec<D> base = n % 4 ? Vec<D>{} : 1e7 * random.direction<D>();
                const double size = n % 4 ? std::pow(10, random.between(-2, 2)) : 1.0;
                const double ratio = std::pow(10, random.between(-1, 1));
                const Sample<D> a = random_sample<D>(i, size, random, base),
                                b = random_sample<D>(j, ratio * size, random, base);
                check(a, b, (1 + ratio) * size, random);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

template <int D>
double distance(const Sample<D>& a, const Sample<D>& b, const Transform<D>& b_placed) {
    return closest_points<D>(a.solid, a.placed, b.solid, b_placed).distance;
}

TYPED_TEST(CastTest, closest_points_lie_on_both_surfaces) {
    constexpr int D = TypeParam::value;
    for_pairs<D>(1, 40, [](const Sample<D>& a, const Sample<D>& b, double size, Random& random) {
        const Transform<D> b_placed{b.placed.position + random.in_cube<D>(size), b.placed.rotation};
        const auto found = closest_points<D>(a.solid, a.placed, b.solid, b_placed);
        const double tolerance = 1e-9 * size + a.vagueness + b.vagueness + 1e-15 * length(a.base);
        const auto b_height = [&](const Vec<D>& p) {
            return b.height(p - (b_placed.position - b.placed.position));
        };
        if (const auto apart = separation<D>(a.solid, a.placed, b.solid, b_placed)) {
            EXPECT_NEAR(found.distance, std::max(apart->distance, 0.0), tolerance);
            if (found.distance > 1e-3 * size) {
                EXPECT_NEAR(length(found.axis - apart->axis), 0, 1e-5);
            }
        }
        if (found.distance > 0) {
            EXPECT_NEAR(a.height(found.on_a), 0, tolerance);
            EXPECT_NEAR(b_height(found.on_b), 0, tolerance);
            EXPECT_NEAR(length(found.axis), 1, 1e-12);
            EXPECT_NEAR(length(found.on_b - found.on_a - found.distance * found.axis), 0, tolerance);
        } else {
            EXPECT_EQ(found.on_a, found.on_b);
            EXPECT_EQ(found.axis, Vec<D>{});
            // Two planes may meet far away.
            const double there = tolerance + 1e-12 * length(found.on_a - a.base);
            EXPECT_LE(a.height(found.on_a), there);
            EXPECT_LE(b_height(found.on_a), there);
        }
    });
}

/// The distance of convex shapes is a convex function of the way.
TYPED_TEST(CastTest, of_a_shape_ends_where_it_touches) {
    constexpr int D = TypeParam::value;
    for_pairs<D>(2, 40, [](const Sample<D>& a, const Sample<D>& b, double size, Random& random) {
        const Transform<D> from{b.placed.position + 2 * size * random.direction<D>(), b.placed.rotation};
        const Vec<D> aim = a.placed.position - from.position + random.in_cube<D>(0.7 * size);
        const Vec<D> way = random.between(0.5, 4) * aim;
        const auto at = [&](double t) { return Transform<D>{from.position + t * way, from.rotation}; };
        const auto gap = [&](double t) { return distance(a, b, at(t)); };
        const double tolerance = 1e-9 * size + 4e-15 * length(a.base);
        const auto hit = cast_shape<D>(b.solid, from, way, a.solid, a.placed);
        if (!hit) {
            EXPECT_GT(gap(least_at(gap)), 0);
            EXPECT_GT(gap(1), 0);
            return;
        }
        EXPECT_NEAR(length(hit->normal), 1, 1e-9);
        if (hit->fraction == 0) {
            EXPECT_LE(gap(0), tolerance);
            return;
        }
        EXPECT_LE(gap(hit->fraction), tolerance);
        for (const double before : {0.5, 0.9, 0.999, 1 - 1e-6}) EXPECT_GT(gap(before * hit->fraction), 0);
        EXPECT_NEAR(a.height(hit->point), 0, 2 * tolerance + a.vagueness + 1e-6 * size);
        EXPECT_LE(dot(hit->normal, way), 0);
        // Further on, the shapes overlap as deep as the slope along the normal says, or less.
        const auto deeper = separation<D>(a.solid, a.placed, b.solid, at(hit->fraction + 1e-4));
        if (deeper) {
            EXPECT_GE(deeper->distance, 1e-4 * dot(hit->normal, way) - 1e-7 * size);
        }
    });
}

TYPED_TEST(CastTest, of_a_ball_is_a_ray_at_a_grown_shape) {
    constexpr int D = TypeParam::value;
    Random random(3);
    for (int n = 0; n < 300; ++n) {
        const Solid<D> target{Geometry<D>(Ball{random.between(0.1, 2)})};
        const double radius = random.between(0.01, 2);
        const Solid<D> grown{Geometry<D>(Ball{target.shape().radius + radius})};
        const Transform<D> placed = random.placement<D>(1);
        const Vec<D> origin = random.in_cube<D>(6), way = 2.0 * (random.in_cube<D>(3) - origin);
        const auto ray = cast_ray<D>(grown, placed, origin, way);
        const auto cast =
            cast_shape<D>(Geometry<D>(Ball{radius}), Transform<D>{origin, {}}, way, target, placed);
        ASSERT_EQ(ray.has_value(), cast.has_value());
        if (!ray) continue;
        EXPECT_NEAR(ray->fraction, cast->fraction, 1e-9);
        if (ray->fraction > 0) {
            EXPECT_NEAR(length(ray->normal - cast->normal), 0, 1e-6);
        }
    }
}

/// The motion at many instants: never an overlap before the impact, and at the impact the gap that was asked
/// for.
TYPED_TEST(CastTest, time_of_impact_misses_nothing_however_fast_shapes_turn) {
    constexpr int D = TypeParam::value;
    int hits = 0, misses = 0;
    for_pairs<D>(4, 5, [&](const Sample<D>& a, const Sample<D>& b, double size, Random& random) {
        const auto sweep = [&](const Sample<D>& s, const Vec<D>& start, const Vec<D>& way) {
            Sweep<D> result;
            result.start = {start, s.placed.rotation};
            result.translation = way;
            if (s.plane) return result;
            const double turn = random.between(0, 40);
            if constexpr (D == 2)
                result.rotation = turn;
            else
                result.rotation = turn * random.direction<3>();
            result.center = random.in_cube<D>(0.3 * size);
            return result;
        };
        const Vec<D> start = b.placed.position + 2.5 * size * random.direction<D>();
        const Vec<D> aim = a.placed.position - start + random.in_cube<D>(1.5 * size);
        const Sweep<D> a_sweep = sweep(a, a.placed.position, random.in_cube<D>(size)),
                       b_sweep = sweep(b, start, 2.0 * aim);
        const double tolerance = 1e-4 * size;
        const auto hit = time_of_impact<D>(a.solid, a_sweep, b.solid, b_sweep, tolerance);
        const auto gap = [&](double t) {
            return closest_points<D>(a.solid, a_sweep.at(t), b.solid, b_sweep.at(t)).distance;
        };
        hit ? ++hits : ++misses;
        const double end = hit ? hit->fraction : 1;
        constexpr int instants = 10000;
        for (int i = 0; i < instants; ++i) {
            const double t = double(i) / instants;
            if (t < end) {
                ASSERT_GT(gap(t), 0) << "at " << t << ", before " << end;
            }
        }
        if (!hit) return;
        EXPECT_LE(gap(hit->fraction), 1.001 * tolerance + 1e-15 * length(a.base));
        EXPECT_NEAR(length(hit->normal), 1, 1e-9);
    });
    EXPECT_GT(hits, 20);
    EXPECT_GT(misses, 20);
}

TYPED_TEST(CastTest, time_of_impact_of_a_spinning_rod_is_when_its_tip_arrives) {
    constexpr int D = TypeParam::value;
    // A rod of half length 1 turns by a quarter in front of a wall whose surface is √½ away.
    Vec<D> half{}, toward{};
    half.y = 1;
    toward.x = 1;
    const double radius = 1e-3;
    const Solid<D> rod{Geometry<D>(Capsule<D>{-half, half, radius})};
    const Solid<D> wall{Geometry<D>(Plane<D>{-toward, -std::sqrt(0.5) - radius})};
    Sweep<D> turn;
    const double quarter = std::acos(0.0);
    if constexpr (D == 2)
        turn.rotation = quarter;
    else
        turn.rotation = {0, 0, quarter};
    const auto hit = time_of_impact<D>(rod, turn, wall, {}, 1e-8);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->fraction, 0.5, 1e-7);
    EXPECT_NEAR(length(hit->normal + toward), 0, 1e-9);
    Sweep<D> plane_turns;
    if constexpr (D == 2)
        plane_turns.rotation = 1;
    else
        plane_turns.rotation = {1, 0, 0};
    EXPECT_THROW(time_of_impact<D>(rod, turn, wall, plane_turns), Error);
}

}  // namespace
}  // namespace carom::test
