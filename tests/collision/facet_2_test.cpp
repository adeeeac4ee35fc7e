#include "collision/facet.hpp"

#include <gtest/gtest.h>

#include "brute_2.hpp"

namespace carom::test {

namespace {

using detail::Facet;

Cloud cloud_of(const Facet<2>& facet) {
    Cloud cloud({.geometry = Ball{1}}, {});
    cloud.points.assign(facet.points.begin(), facet.points.end());
    cloud.radius = 0;
    return cloud;
}

/// The least way out of an overlap across edges of the two that does not lead back.
double forward_gap(const Cloud& a, const Cloud& b, const Vec2& front) {
    double widest = -1e300;
    for (const Cloud* cloud : {&a, &b}) {
        for (const Vec2& p : cloud->points) {
            for (const Vec2& q : cloud->points) {
                const Vec2 across = normalized(Vec2{q.y - p.y, p.x - q.x});
                const Vec2 out = cloud == &a ? across : -across;
                const bool edge = cloud->highest(out) - dot(out, p) < 1e-9 * length(q - p);
                if (length_squared(across) > 0 && edge && dot(across, front) >= -1e-9)
                    widest = std::max(widest, gap_along(a, b, across));
            }
        }
    }
    return widest;
}

void expect_right(const ShapeDefinition2& definition, const Transform2& placed, const Facet<2>& facet,
                  double size) {
    const detail::Shape<2> shape = detail::make_shape(definition);
    const Cloud segment = cloud_of(facet), cloud(definition, placed);
    const double tolerance = 1e-9 * size, gap = signed_distance(segment, cloud);
    const Vec2 front = facet.normal();
    const bool behind =
        !facet.two_sided && dot(front, apply(placed, detail::middle_of(shape)) - facet.points[0]) < 0;
    const bool cores_apart = gap + cloud.radius > tolerance;
    const auto found = detail::separate_facet(shape, facet, placed);
    if (behind) {
        EXPECT_FALSE(found);
    }
    if (found) {
        EXPECT_NEAR(length(found->axis), 1, 1e-12);
        EXPECT_NEAR(gap_along(segment, cloud, found->axis), found->distance, tolerance);
    }
    if (facet.two_sided || (found && cores_apart)) {
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, gap, tolerance);
    } else if (!behind && !cores_apart && gap + cloud.radius < -tolerance) {
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, forward_gap(segment, cloud, front), tolerance);
    }

    const double reach = 0.1 * size;
    const Manifold<2> manifold = detail::collide_facet(shape, facet, placed, reach);
    if (!found || found->distance > reach) {
        EXPECT_EQ(manifold.count, 0);
    } else if (facet.two_sided || dot(found->axis, front) > 0.3) {
        EXPECT_GT(manifold.count, 0);
    }
    double least = 1e300;
    for (int k = 0; k < manifold.count; ++k) least = std::min(least, manifold.points[k].separation);
    if (manifold.count == 0) return;
    if (!facet.two_sided) {
        EXPECT_GE(dot(manifold.normal, front), -2e-6);
    }
    EXPECT_NEAR(least, found->distance, 0.03 * size);
}

TEST(Facet2, EveryKindMeetsASegmentAsBruteForceSays) {
    Random random(77);
    for (const Kind kind : round_kinds) {
        for (int n = 0; n < 4000; ++n) {
            const bool grid = n % 3 == 0;
            const double size = grid ? 1 : std::pow(10, random.between(-2, 2));
            const ShapeDefinition2 shape = grid ? grid_shape(kind, random) : random_shape(kind, random, size);
            Transform2 placed = random.placement<2>(size);
            if (grid) placed = {{0.5 * random.below(5), 0.5 * random.below(5)}, right_angle(random)};
            Facet<2> facet{{random.in_cube<2>(2 * size), random.in_cube<2>(2 * size)}, n % 4 == 3};
            if (grid) {
                facet.points = {Vec2{0.5 * random.below(4), 0.5 * random.below(4)},
                                Vec2{2.0 + 0.5 * random.below(4), 0.5 * random.below(4)}};
            }
            SCOPED_TRACE("kind " + std::to_string(int(kind)) + ", case " + std::to_string(n));
            expect_right(shape, placed, facet, size);
            if (testing::Test::HasFailure()) return;
        }
    }
}

TEST(Facet2, ABoxOnASegmentRestsOnTwoCornersAndFallsThroughFromBehind) {
    const auto box = detail::make_shape<2>({.geometry = Box2{{1, 1}}});
    const Facet<2> floor{{Vec2{-5, 0}, Vec2{5, 0}}, false};
    const Manifold<2> found = detail::collide_facet<2>(box, floor, {{0, 0.49}, {}}, 0.01);
    ASSERT_EQ(found.count, 2);
    EXPECT_EQ(found.normal, (Vec2{0, 1}));
    EXPECT_NEAR(found.points[0].separation, -0.01, 1e-12);
    EXPECT_NE(found.points[0].feature, found.points[1].feature);
    EXPECT_EQ(detail::collide_facet<2>(box, floor, {{0, -0.1}, {}}, 0.01).count, 0);
    Facet<2> both = floor;
    both.two_sided = true;
    EXPECT_EQ(detail::collide_facet<2>(box, both, {{0, -0.49}, {}}, 0.01).normal, (Vec2{0, -1}));
}

TEST(Facet2, AHullWhoseTipIsDeepGoesUp) {
    // More of it lies behind the line than in front: the short way out would lead backwards.
    const auto wedge = detail::make_shape<2>({.geometry = Hull2{{{-1, 1}, {1, 1}, {0, -2}}}});
    const Facet<2> floor{{Vec2{-5, 0}, Vec2{5, 0}}, false};
    const auto found = detail::separate_facet<2>(wedge, floor, {{0, 0.1}, {}});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, -1.9, 1e-12);
    EXPECT_EQ(found->axis, (Vec2{0, 1}));
}

TEST(Facet2, ChainsAnswerQueriesByTheirNearestSegment) {
    const Solid<2> chain{Geometry<2>{Chain{.points = {{-4, 0}, {0, 0}, {0, -3}, {4, -3}}}}};
    const Solid<2> ball{Geometry<2>{Ball{0.5}}};
    const Transform2 placed{{1e6, 1e6}, Rotation2::from_angle(1)};
    const auto at = [&](double x, double y) { return Transform2{apply(placed, {x, y}), {}}; };
    EXPECT_NEAR((separation<2>(ball, at(-2, 1), chain, placed)->distance), 0.5, 1e-8);
    EXPECT_NEAR((separation<2>(ball, at(0.3, -1), chain, placed)->distance), -0.2, 1e-8);
    EXPECT_NEAR((separation<2>(ball, at(2, 100), chain, placed)->distance), std::sqrt(1e4 + 4) - 0.5, 1e-8);
    EXPECT_TRUE((overlap<2>(chain, placed, ball, at(2, -2.6))));
    EXPECT_FALSE((overlap<2>(chain, placed, ball, at(2, -3.1)))) << "behind";
    const Solid<2> plane{Geometry<2>{Plane2{{0, 1}, 0}}};
    EXPECT_FALSE((separation<2>(plane, {}, chain, placed)));
    EXPECT_FALSE((overlap<2>(plane, {}, chain, placed)));
    EXPECT_EQ((collide<2>(chain, placed, chain, placed, 1).count), 0);
}

}  // namespace

}  // namespace carom::test
