#include <gtest/gtest.h>

#include <algorithm>

#include "../collision/random.hpp"
#include "carom/error.hpp"
#include "geometry/hull.hpp"
#include "math/trig.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// What a convex polygon around the points must be, found without the way that it was made.
void expect_hull(const std::vector<Vec2>& points, const Polygon& hull) {
    const double extent = extent_of<2>(points), tolerance = hull_tolerance * extent;
    const std::size_t count = hull.vertices.size();
    ASSERT_GE(count, 3u);
    ASSERT_EQ(hull.normals.size(), count);
    double turns = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 &a = hull.vertices[i], &b = hull.vertices[(i + 1) % count],
                   &c = hull.vertices[(i + 2) % count];
        EXPECT_NE(std::find(points.begin(), points.end(), a), points.end());
        EXPECT_NEAR(length(hull.normals[i]), 1, 1e-15);
        EXPECT_NEAR(dot(hull.normals[i], b - a), 0, 1e-15 * extent);
        EXPECT_GT(cross(b - a, c - b), 0);
        turns += std::atan2(cross(b - a, c - b), dot(b - a, c - b));
        for (const Vec2& p : points) EXPECT_LE(dot(hull.normals[i], p - a), 1.01 * tolerance);
    }
    EXPECT_NEAR(turns, 2 * pi, 1e-12);  // once around
}

double area(const Polygon& hull) {
    double twice = 0;
    for (std::size_t i = 2; i < hull.vertices.size(); ++i) {
        twice += cross(hull.vertices[i - 1] - hull.vertices[0], hull.vertices[i] - hull.vertices[0]);
    }
    return twice / 2;
}

TEST(Polygon, OfASquare) {
    // Corners, middles of sides, inner points and some of these twice, in any order.
    const Polygon hull =
        convex_polygon({{0.5, 0}, {1, 1}, {0, 0}, {0.25, 0.5}, {1, 0}, {0, 0.5}, {1, 1}, {0.5, 1}, {0, 1}});
    EXPECT_EQ(hull.vertices.size(), 4u);
    expect_hull({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, hull);
    EXPECT_EQ(area(hull), 1);
}

TEST(Polygon, OfATriangleEitherWayAround) {
    for (const auto& points : {std::vector<Vec2>{{0, 0}, {2, 0}, {0, 1}}, {{0, 0}, {0, 1}, {2, 0}}}) {
        const Polygon hull = convex_polygon(points);
        expect_hull(points, hull);
        EXPECT_EQ(area(hull), 1);
    }
}

TEST(Polygon, OfRandomPoints) {
    Random random(1);
    for (int k = 0; k < 2000; ++k) {
        std::vector<Vec2> points;
        const double size = std::pow(10, random.between(-3, 3));
        const Vec2 offset = random.in_cube<2>(k % 3 == 0 ? 100 * size : 0);
        const int count = 3 + random.below(30);
        for (int i = 0; i < count; ++i) points.push_back(offset + random.in_cube<2>(size));
        try {
            expect_hull(points, convex_polygon(points));
        } catch (const Error& error) {
            EXPECT_LT(count, 5) << error.what();  // three may lie on a line
        }
    }
}

TEST(Polygon, OfPointsOnALattice) {
    Random random(2);
    int flat = 0;
    for (int k = 0; k < 2000; ++k) {
        std::vector<Vec2> points;
        const Rotation2 q = k % 2 == 0 ? Rotation2{} : random.rotation<2>();
        const int count = 3 + random.below(20);
        for (int i = 0; i < count; ++i) {
            const double x = random.below(4);
            points.push_back(rotate(q, Vec2{x, static_cast<double>(random.below(4))}));
        }
        // The brute way: any three that are not on a line.
        bool spans = false;
        for (const Vec2& p : points) {
            for (const Vec2& r : points)
                spans = spans || std::fabs(cross(p - points[0], r - points[0])) > 0.5;
        }
        if (!spans) {
            EXPECT_THROW(convex_polygon(points), Error);
            ++flat;
        } else {
            expect_hull(points, convex_polygon(points));
        }
    }
    EXPECT_GT(flat, 10);
}

TEST(Polygon, OfNoisySides) {
    Random random(3);
    for (const double noise : {0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-6}) {
        for (int k = 0; k < 50; ++k) {
            std::vector<Vec2> points;
            const Rotation2 q = random.rotation<2>();
            for (int i = 0; i <= 10; ++i) {
                for (const Vec2& p :
                     {Vec2{i / 10., 0}, Vec2{i / 10., 1}, Vec2{0, i / 10.}, Vec2{1, i / 10.}}) {
                    points.push_back(rotate(q, p + random.in_cube<2>(noise)));
                }
            }
            const Polygon hull = convex_polygon(points);
            expect_hull(points, hull);
            EXPECT_EQ(hull.vertices.size(), 4u) << noise;
        }
    }
}

TEST(Polygon, OfACircleInFineSteps) {
    for (const int count : {32, 256, 1000, 4096}) {
        std::vector<Vec2> points;
        for (int i = 0; i < count; ++i) {
            const auto [sine, cosine] = sin_cos(2 * pi * i / count);
            points.push_back({cosine, sine});
        }
        const Polygon hull = convex_polygon(points);
        expect_hull(points, hull);
        EXPECT_NEAR(area(hull), pi, 30.0 / (count * count) + 1e-4);
        if (count <= 256) {
            EXPECT_EQ(hull.vertices.size(), static_cast<std::size_t>(count));
        }
    }
}

TEST(Polygon, DoesNotDependOnTheOrderOfThePoints) {
    Random random(4);
    std::vector<Vec2> points;
    for (int i = 0; i < 50; ++i) points.push_back(random.in_cube<2>(1));
    const Polygon hull = convex_polygon(points);
    for (int k = 0; k < 20; ++k) {
        std::swap(points[random.below(50)], points[random.below(50)]);
        EXPECT_EQ(convex_polygon(points).vertices, hull.vertices);
    }
}

std::string refusal(const std::vector<Vec2>& points) {
    try {
        convex_polygon(points);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Polygon, RefusesInWords) {
    EXPECT_EQ(refusal({}), "points: 0 are fewer than 3");
    EXPECT_EQ(refusal({{0, 0}, {1, 0}}), "points: 2 are fewer than 3");
    EXPECT_EQ(refusal({{0, 0}, {1, 1}, {2, 2}}), "points: 3 points span no area");
    EXPECT_EQ(refusal({{1, 1}, {1, 1}, {1, 1}}), "points: 3 points span no area");
    EXPECT_EQ(refusal({{0, 0}, {1, 0}, {0, 1}, {0.5, 2e9}}),
              "points[3][1]: 2e+09 is not between -1e+09 and 1e+09");
    EXPECT_EQ(refusal({{0, 0}, {1, std::nan("")}, {0, 1}}), "points[1][1]: nan is not finite");
    EXPECT_EQ(refusal(std::vector<Vec2>(5000)), "points: 5000 are more than 4096");
    // As thin as the limit: a share of 1e-4 of the length.
    EXPECT_EQ(refusal({{0, 0}, {1, 0}, {1, 1.01e-4}, {0, 1.01e-4}}), "no error");
    EXPECT_EQ(refusal({{0, 0}, {1, 0}, {1, 0.99e-4}, {0, 0.99e-4}}), "points: 4 points span no area");
}

}  // namespace
}  // namespace carom::detail
