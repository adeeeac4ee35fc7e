#include "solver/bounce.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// The same flight by many small exact pieces of ballistic motion: whenever the gap closes within a piece the
/// impact is found by bisection.
struct Reference {
    double gap, speed;
    int bounces = 0;

    Reference(double e, double gap_at_start, double speed_at_start, double a, double step)
        : gap(gap_at_start), speed(speed_at_start) {
        constexpr int pieces = 2000;
        for (int i = 0; i < pieces; ++i) {
            double left = step / pieces;
            for (int k = 0; k < 4 && left > 0; ++k) {
                const auto after = [&](double t) { return gap + t * (speed + 0.5 * a * t); };
                if (after(left) >= 0) {
                    gap = after(left);
                    speed += a * left;
                    break;
                }
                double low = 0, high = left;
                for (int b = 0; b < 60; ++b)
                    (after(0.5 * (low + high)) >= 0 ? low : high) = 0.5 * (low + high);
                speed = -e * (speed + a * low);
                gap = 0;
                left -= low;
                ++bounces;
            }
        }
    }
};

TEST(Rebound, IsTheFlightWithItsImpacts) {
    Random random(1);
    int bounced = 0;
    for (int i = 0; i < 300; ++i) {
        const double e = random.between(0.3, 1), gap = random.between(0, 0.2);
        const double speed = random.between(-15, 3), a = random.between(-30, 30), step = 1.0 / 60;
        const Reference expected(e, gap, speed, a, step);
        if (expected.bounces > 3) continue;  // the reference may lose some of a rapid sequence
        const Rebound r = rebound(e, gap, speed, a, step, 0);
        ASSERT_EQ(r.bounces, expected.bounces > 0) << "case " << i;
        if (!r.bounces) continue;
        ++bounced;
        ASSERT_NEAR(r.speed, expected.speed, 1e-9) << "case " << i;
        ASSERT_NEAR(r.gap, expected.gap, 1e-9) << "case " << i;
    }
    EXPECT_GT(bounced, 80);
}

TEST(Rebound, KeepsTheEnergyWhenElastic) {
    Random random(2);
    for (int i = 0; i < 300; ++i) {
        const double gap = random.between(0, 0.1), speed = random.between(-10, 1), a = random.between(-20, 0);
        const Rebound r = rebound(1, gap, speed, a, 1.0 / 60, 0);
        if (!r.bounces) continue;
        const double before = 0.5 * speed * speed - a * gap, after = 0.5 * r.speed * r.speed - a * r.gap;
        ASSERT_NEAR(after, before, 1e-12 * (1 + before));
    }
}

TEST(Rebound, StartsAtOnceWhereTheShapesTouch) {
    for (const double gap : {0.0, -0.01}) {
        const Rebound r = rebound(0.5, gap, -4, 0, 0.1, 1);
        EXPECT_TRUE(r.bounces);
        EXPECT_DOUBLE_EQ(r.speed, 2);
        EXPECT_DOUBLE_EQ(r.gap, 0.2);
    }
}

TEST(Rebound, NeedsAnImpactWithinTheStep) {
    EXPECT_FALSE(rebound(1, 1, -1, 0, 0.5, 0).bounces) << "it arrives later";
    EXPECT_FALSE(rebound(1, 1, 1, 0, 0.5, 0).bounces) << "it goes away";
    EXPECT_FALSE(rebound(1, 1, -1, 10, 0.5, 0).bounces) << "it turns back";
    EXPECT_FALSE(rebound(1, -0.1, 1, 0, 0.5, 0).bounces) << "it overlaps but goes away";
    EXPECT_TRUE(rebound(1, 1, 1, -20, 0.5, 0).bounces) << "it comes back";
}

TEST(Rebound, NeedsTheThreshold) {
    EXPECT_FALSE(rebound(1, 0, -1, 0, 0.1, 1).bounces);
    EXPECT_TRUE(rebound(1, 0, -1.001, 0, 0.1, 1).bounces);
    // The speed at the impact counts, not the one at the start.
    EXPECT_TRUE(rebound(1, 0.05, -0.9, -10, 0.1, 1).bounces);
}

TEST(Rebound, ComesToRestAfterManyBounces) {
    const Rebound r = rebound(0.1, 0, -2, -100, 0.5, 0.01);
    EXPECT_TRUE(r.bounces);
    EXPECT_EQ(r.speed, 0);
    EXPECT_EQ(r.gap, 0);
}

}  // namespace
}  // namespace carom::detail
