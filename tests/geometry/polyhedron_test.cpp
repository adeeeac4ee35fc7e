#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "../collision/random.hpp"
#include "carom/error.hpp"
#include "geometry/hull.hpp"
#include "math/trig.hpp"

namespace carom::detail {
namespace {

using test::Random;
using Points = std::vector<Vec3>;

/// What a convex polyhedron around the points must be, found without the way that it was made.
void expect_hull(const Points& points, const Polyhedron& hull) {
    const double extent = extent_of<3>(points), tolerance = 5 * hull_tolerance * extent;
    const std::size_t corners = hull.vertices.size(), faces = hull.normals.size();
    ASSERT_EQ(hull.offsets.size(), faces);
    ASSERT_EQ(hull.first.size(), faces + 1);
    ASSERT_EQ(hull.first.front(), 0u);
    ASSERT_EQ(hull.first.back(), hull.indices.size());
    EXPECT_EQ(corners + faces, hull.edges.size() + 2);  // Euler

    for (const Vec3& v : hull.vertices) EXPECT_NE(std::find(points.begin(), points.end(), v), points.end());

    std::set<std::array<std::uint32_t, 3>> sides;  // from, to, face
    std::vector<int> faces_at(corners, 0);
    for (std::uint32_t f = 0; f < faces; ++f) {
        const Vec3& normal = hull.normals[f];
        const std::uint32_t begin = hull.first[f], count = hull.first[f + 1] - begin;
        ASSERT_GE(count, 3u);
        EXPECT_NEAR(length(normal), 1, 1e-14);
        for (const Vec3& p : points) EXPECT_LE(dot(normal, p) - hull.offsets[f], tolerance);
        const auto index = [&](std::uint32_t i) { return hull.indices[begin + i % count]; };
        for (std::uint32_t i = 0; i < count; ++i) {
            ASSERT_LT(index(i), corners);
            ++faces_at[index(i)];
            EXPECT_TRUE(sides.insert({index(i), index(i + 1), f}).second);
            const Vec3 &a = hull.vertices[index(i)], &b = hull.vertices[index(i + 1)],
                       &c = hull.vertices[index(i + 2)];
            EXPECT_NEAR(dot(normal, a), hull.offsets[f], tolerance);
            EXPECT_GE(dot(cross(b - a, c - b), normal), -tolerance * length(c - a));
        }
    }
    for (const int count : faces_at) EXPECT_GE(count, 3);
    ASSERT_EQ(sides.size(), 2 * hull.edges.size());
    for (const auto& edge : hull.edges) {
        EXPECT_EQ(sides.count({edge.from, edge.to, edge.left}), 1u);
        EXPECT_EQ(sides.count({edge.to, edge.from, edge.right}), 1u);
    }
}

void expect_counts(const Polyhedron& hull, std::size_t vertices, std::size_t faces) {
    EXPECT_EQ(hull.vertices.size(), vertices);
    EXPECT_EQ(hull.normals.size(), faces);
}

/// How far some point sticks out of the hull's corners, along random directions, as a share of the extent.
double sticks_out(Random& random, const Points& points, const Polyhedron& hull) {
    double worst = 0;
    for (int k = 0; k < 50; ++k) {
        const Vec3 u = random.direction<3>();
        const auto reach = [&u](const Points& set) {
            double furthest = -1e300;
            for (const Vec3& p : set) furthest = std::max(furthest, dot(u, p));
            return furthest;
        };
        worst = std::max(worst, reach(points) - reach(hull.vertices));
    }
    return worst / extent_of<3>(points);
}

Points cube() {
    Points corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back({i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5});
    return corners;
}

Points transformed(const Points& points, const std::function<Vec3(const Vec3&)>& map) {
    Points result;
    for (const Vec3& p : points) result.push_back(map(p));
    return result;
}

TEST(Polyhedron, OfACube) {
    const Polyhedron hull = convex_polyhedron(cube());
    expect_hull(cube(), hull);
    expect_counts(hull, 8, 6);
    for (std::size_t f = 0; f < 6; ++f) {
        EXPECT_EQ(hull.first[f + 1] - hull.first[f], 4u);
        EXPECT_EQ(hull.offsets[f], 0.5);
        EXPECT_EQ(std::fabs(hull.normals[f].x) + std::fabs(hull.normals[f].y) + std::fabs(hull.normals[f].z),
                  1);
    }
    for (const auto& edge : hull.edges) EXPECT_EQ(dot(hull.normals[edge.left], hull.normals[edge.right]), 0);
}

TEST(Polyhedron, OfTurnedCubesOfAllSizes) {
    Random random(1);
    for (int k = 0; k < 500; ++k) {
        const Rotation3 q = random.rotation<3>();
        const double size = std::pow(10, random.between(-3, 3));
        const Vec3 place = random.in_cube<3>(10 * size);
        const Points points = transformed(cube(), [&](const Vec3& p) { return place + size * rotate(q, p); });
        const Polyhedron hull = convex_polyhedron(points);
        expect_hull(points, hull);
        expect_counts(hull, 8, 6);
    }
}

TEST(Polyhedron, OfBoxesFullOfPoints) {
    Random random(2);
    for (const double noise : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6}) {
        for (int k = 0; k < 10; ++k) {
            const Rotation3 q = random.rotation<3>();
            Points points;
            for (int i = 0; i < 125; ++i) {
                const Vec3 p{i % 5 / 4.0, i / 5 % 5 / 4.0, i / 25 / 4.0};
                points.push_back(rotate(q, p) + random.in_cube<3>(noise));
            }
            const Polyhedron hull = convex_polyhedron(points);
            expect_hull(points, hull);
            expect_counts(hull, 8, 6);
        }
    }
}

TEST(Polyhedron, OfPrisms) {
    Random random(3);
    for (const int sides : {3, 5, 8, 24, 64}) {
        for (int k = 0; k < 20; ++k) {
            const Rotation3 q = random.rotation<3>();
            Points points;
            for (int i = 0; i < sides; ++i) {
                const auto [sine, cosine] = sin_cos(2 * pi * i / sides);
                for (const double y : {0.0, 1.0}) points.push_back(rotate(q, Vec3{cosine, y, sine}));
            }
            const Polyhedron hull = convex_polyhedron(points);
            expect_hull(points, hull);
            expect_counts(hull, 2 * sides, sides + 2);
        }
    }
}

TEST(Polyhedron, OfPointsOnASphere) {
    Random random(4);
    for (int k = 0; k < 50; ++k) {
        Points points;
        for (int i = 0; i < (k == 0 ? 2000 : 32); ++i) points.push_back(random.direction<3>());
        const Polyhedron hull = convex_polyhedron(points);
        expect_hull(points, hull);
        EXPECT_LE(sticks_out(random, points, hull), 2 * hull_tolerance);
        EXPECT_GE(hull.vertices.size(), points.size() * 99 / 100);
    }
}

TEST(Polyhedron, OfRandomPoints) {
    Random random(5);
    int refused = 0;
    for (int k = 0; k < 3000; ++k) {
        const double size = std::pow(10, random.between(-3, 3));
        const int count = 4 + random.below(40);
        Points points;
        for (int i = 0; i < count; ++i) points.push_back(random.in_cube<3>(size));
        try {
            const Polyhedron hull = convex_polyhedron(points);
            expect_hull(points, hull);
            EXPECT_LE(sticks_out(random, points, hull), 2 * hull_tolerance);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_LE(refused, 3);  // four points now and then are nearly flat
}

/// Six times the volume of the hull, by brute force: all triangles with all points on one side, of which in
/// each plane only those are counted that fan out from its first point around its outline. Whole numbers:
/// exact.
long volume_by_brute_force(const Points& points) {
    // The sum over the planes of distance times area, where the area of a plane's outline is that of a 2D
    // hull.
    std::set<std::array<long, 4>> planes;
    double sum = 0;
    const std::size_t count = points.size();
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
            for (std::size_t k = 0; k < count; ++k) {
                const Vec3 n = cross(points[j] - points[i], points[k] - points[i]);
                if (length_squared(n) == 0) continue;
                bool outer = true;
                Points in_plane;
                for (const Vec3& p : points) {
                    const double height = dot(n, p - points[i]);
                    outer = outer && height <= 0;
                    if (height == 0) in_plane.push_back(p);
                }
                if (!outer) continue;
                const long x = std::lround(n.x), y = std::lround(n.y), z = std::lround(n.z);
                const long divisor = std::gcd(std::gcd(std::labs(x), std::labs(y)), std::labs(z));
                const Vec3 primitive{double(x / divisor), double(y / divisor), double(z / divisor)};
                if (!planes
                         .insert(
                             {x / divisor, y / divisor, z / divisor, std::lround(dot(primitive, points[i]))})
                         .second)
                    continue;
                // Seen along the largest component of the normal.
                int axis = 0;
                for (int a = 1; a < 3; ++a)
                    axis = std::fabs(primitive[a]) > std::fabs(primitive[axis]) ? a : axis;
                std::vector<Vec2> flat;
                for (const Vec3& p : in_plane) flat.push_back({p[(axis + 1) % 3], p[(axis + 2) % 3]});
                const Polygon outline = convex_polygon(flat);
                double twice_area = 0;
                for (std::size_t v = 2; v < outline.vertices.size(); ++v) {
                    twice_area += cross(outline.vertices[v - 1] - outline.vertices[0],
                                        outline.vertices[v] - outline.vertices[0]);
                }
                sum += dot(primitive, points[i]) / std::fabs(primitive[axis]) * twice_area;
            }
        }
    }
    return std::lround(sum);
}

double volume(const Polyhedron& hull) {
    double sixfold = 0;
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
        const auto corner = [&](std::uint32_t i) { return hull.vertices[hull.indices[hull.first[f] + i]]; };
        for (std::uint32_t i = 2; i < hull.first[f + 1] - hull.first[f]; ++i) {
            sixfold += dot(corner(0), cross(corner(i - 1), corner(i)));
        }
    }
    return sixfold / 6;
}

TEST(Polyhedron, OfPointsOnALattice) {
    Random random(6);
    int flat = 0;
    for (int k = 0; k < 400; ++k) {
        Points points;
        const int count = 4 + random.below(14), side = 2 + random.below(3);
        for (int i = 0; i < count; ++i) {
            const double x = random.below(side), y = random.below(side);
            points.push_back({x, y, static_cast<double>(random.below(side))});
        }
        bool spans = false;
        for (const Vec3& a : points) {
            for (const Vec3& b : points) {
                for (const Vec3& c : points) {
                    spans = spans || dot(a - points[0], cross(b - points[0], c - points[0])) != 0;
                }
            }
        }
        if (!spans) {
            EXPECT_THROW(convex_polyhedron(points), Error);
            ++flat;
            continue;
        }
        const long sixfold = volume_by_brute_force(points);
        const Polyhedron exact = convex_polyhedron(points);
        expect_hull(points, exact);
        EXPECT_NEAR(6 * volume(exact), static_cast<double>(sixfold), 1e-9);
        const Rotation3 q = random.rotation<3>();
        const Points turned = transformed(points, [&](const Vec3& p) { return rotate(q, p); });
        const Polyhedron hull = convex_polyhedron(turned);
        expect_hull(turned, hull);
        EXPECT_NEAR(6 * volume(hull), static_cast<double>(sixfold), 1e-9);
        expect_counts(hull, exact.vertices.size(), exact.normals.size());
    }
    EXPECT_GT(flat, 10);
}

TEST(Polyhedron, OfPointsAskewByAboutTheTolerance) {
    Random random(7);
    for (const double noise : {3e-6, 1e-5, 3e-5, 1e-4, 1e-3}) {
        for (int k = 0; k < 60; ++k) {
            const Rotation3 q = random.rotation<3>();
            Points points;
            for (int i = 0; i < 125; ++i) {
                const Vec3 p{i % 5 / 4.0, i / 5 % 5 / 4.0, i / 25 / 4.0};
                points.push_back(rotate(q, p) + random.in_cube<3>(noise));
            }
            const Polyhedron hull = convex_polyhedron(points);
            expect_hull(points, hull);
            EXPECT_LE(sticks_out(random, points, hull), 4 * hull_tolerance);
        }
    }
}

TEST(Polyhedron, OfClustersNeedlesAndPlates) {
    Random random(8);
    for (int k = 0; k < 500; ++k) {
        Points clusters, needle, plate;
        const Rotation3 q = random.rotation<3>();
        for (int i = 0; i < 8; ++i) {
            const Vec3 center = random.in_cube<3>(1);
            for (int j = 0; j < 5; ++j) {
                const double spread = std::pow(10, random.between(-9, -2));
                clusters.push_back(center + random.in_cube<3>(spread));
            }
            for (int j = 0; j < 3; ++j) {
                const Vec3 p = random.in_cube<3>(0.5);
                needle.push_back(rotate(q, Vec3{0.002 * p.x, p.y, 0.002 * p.z}));
                plate.push_back(rotate(q, Vec3{p.x, 0.002 * p.y, p.z}));
            }
        }
        for (const Points& points : {clusters, needle, plate}) {
            const Polyhedron hull = convex_polyhedron(points);
            expect_hull(points, hull);
            EXPECT_LE(sticks_out(random, points, hull), 4 * hull_tolerance);
        }
    }
}

TEST(Polyhedron, IsTheSameEveryTime) {
    Random random(9);
    Points points;
    for (int i = 0; i < 100; ++i) points.push_back(random.in_cube<3>(1));
    const Polyhedron one = convex_polyhedron(points), other = convex_polyhedron(points);
    EXPECT_EQ(one.vertices, other.vertices);
    EXPECT_EQ(one.indices, other.indices);
    EXPECT_EQ(one.normals, other.normals);
}

std::string refusal(const Points& points) {
    try {
        convex_polyhedron(points);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Polyhedron, RefusesInWords) {
    EXPECT_EQ(refusal({}), "points: 0 are fewer than 4");
    EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), "points: 4 points span no volume");
    EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), "points: 4 points span no volume");
    EXPECT_EQ(refusal(Points(4, Vec3{1, 2, 3})), "points: 4 points span no volume");
    EXPECT_EQ(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -3e9}}),
              "points[3][2]: -3e+09 is not between -1e+09 and 1e+09");
    EXPECT_EQ(refusal({{0, 0, std::nan("")}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}),
              "points[0][2]: nan is not finite");
    EXPECT_EQ(refusal(Points(4097)), "points: 4097 are more than 4096");
    Points thin = transformed(cube(), [](const Vec3& p) { return Vec3{p.x, 1.01e-4 * p.y, p.z}; });
    EXPECT_EQ(refusal(thin), "no error");
    thin = transformed(cube(), [](const Vec3& p) { return Vec3{p.x, 0.98e-4 * p.y, p.z}; });
    EXPECT_EQ(refusal(thin), "points: 8 points span no volume");
}

}  // namespace
}  // namespace carom::detail
