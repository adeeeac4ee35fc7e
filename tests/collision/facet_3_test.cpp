#include "collision/facet.hpp"

#include <gtest/gtest.h>

#include "scene_3.hpp"

namespace carom::test::space {

namespace {

using detail::Facet;

constexpr Kind convex_kinds[] = {Kind::ball, Kind::box,      Kind::capsule,
                                 Kind::hull, Kind::cylinder, Kind::cone};

/// A triangle and a convex shape near it: turned freely or along the axes, now and then with a tremble; the
/// triangle is of any form, slivers included, and large or small against the shape.
struct Case {
    Case(Kind kind, int n, Random& random) {
        const Scene scene(kind, kind, n % 3 == 0, random);
        geometry = scene.a;
        shape = detail::make_shape<3>({.geometry = geometry});
        placed = scene.a_placed;
        const double size = oracle().size() * std::pow(10, random.between(-1, 1));
        do {
            for (Vec3& p : facet.points) {
                p = placed.position + random.in_cube<3>(size);
                if (n % 3 == 0) p = placed.position + snapped(p - placed.position, 0.5 * size);
            }
        } while (length(cross(facet.points[1] - facet.points[0], facet.points[2] - facet.points[0])) <
                 1e-4 * size * size);
        facet.two_sided = n % 4 == 3;
        bring_near(random);
    }

    static Vec3 snapped(const Vec3& p, double grid) {
        return {grid * std::floor(p.x / grid), grid * std::floor(p.y / grid), grid * std::floor(p.z / grid)};
    }
    Body3 oracle() const { return {geometry, placed}; }
    double size() const { return std::min(oracle().size(), Body3(facet.points).size()); }

    void bring_near(Random& random) {
        Facet<3> both = facet;
        both.two_sided = true;
        const double gaps[] = {0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2, 0.1};
        const auto found = detail::separate_facet(shape, both, placed);
        const int choice = random.below(18);
        if (choice < 14) {
            const double gap = (choice < 7 ? 1 : -1) * size() * gaps[choice % 7];
            placed.position += (gap - found->distance) * found->axis;
        }
        if (!facet.two_sided && random.below(8) > 0 && height_of_middle() < 0)
            std::swap(facet.points[1], facet.points[2]);
    }
    double height_of_middle() const {
        return dot(facet.normal(), apply(placed, detail::middle_of(shape)) - facet.points[0]);
    }

    Geometry<3> geometry;
    detail::Shape<3> shape;
    Transform3 placed;
    Facet<3> facet;
};

/// Gap along the normal of the facet, those of the shape's faces and, of directions that do not lead back, no
/// others: a bound for the shortest way out.
double simple_gap(const Case& c) {
    const Body3 triangle(c.facet.points), body = c.oracle();
    double widest = gap_along(triangle, body, c.facet.normal());
    for (const Vec3& n : body.normals())
        if (dot(-n, c.facet.normal()) >= 0) widest = std::max(widest, gap_along(triangle, body, -n));
    return widest;
}

void expect_right(const Case& c) {
    const Body3 triangle(c.facet.points), body = c.oracle();
    const double tolerance = 2e-6 * c.size() + body.vagueness() + 1e-9 * body.size();
    Facet<3> both = c.facet;
    both.two_sided = true;
    // For a body of revolution the oracle may miss the widest gap.
    const double widest =
        std::max(widest_gap(triangle, body),
                 body.corners().empty() ? detail::separate_facet(c.shape, both, c.placed)->distance : -1e300);
    const auto found = detail::separate_facet(c.shape, c.facet, c.placed);
    const double looks = found ? dot(found->axis, c.facet.normal()) : 0;
    if (found) {
        EXPECT_NEAR(length(found->axis), 1, 1e-12);
        EXPECT_NEAR(gap_along(triangle, body, found->axis), found->distance, tolerance) << "the axis";
        if (!c.facet.two_sided) {
            EXPECT_GE(looks, -2e-6);
        }
    }
    if (c.facet.two_sided) {
        ASSERT_TRUE(found);
        EXPECT_GE(found->distance, widest - tolerance) << "no axis has a wider gap";
    } else if (c.height_of_middle() < -tolerance) {
        EXPECT_FALSE(found);
    } else if (c.height_of_middle() > tolerance && widest < -tolerance && detail::core_radius(c.shape) == 0) {
        ASSERT_TRUE(found) << "a shape in front that overlaps it meets it";
        EXPECT_LE(found->distance, widest + tolerance) << "no way out is shorter than the shortest";
        EXPECT_GE(found->distance, simple_gap(c) - tolerance) << "nor longer than the simple ones";
    } else if (found && found->distance > 0) {
        EXPECT_GE(found->distance, widest - tolerance);
    }

    const double reach = 0.05 * c.size();
    const Manifold<3> manifold = detail::collide_facet(c.shape, c.facet, c.placed, reach);
    if (!found || found->distance > reach + tolerance) {
        // A manifold's direction may be a little worse than the best one, and lead on the other side of the
        // border between forwards and backwards.
        if (looks > 1e-3 || c.height_of_middle() < -tolerance || !body.corners().empty()) {
            EXPECT_EQ(manifold.count, 0);
        }
        return;
    }
    // Where it is a hair's breadth whether the direction leads back, either answer will do.
    if (c.facet.two_sided || looks > 0.01) {
        EXPECT_GT(manifold.count, 0);
    }
    if (manifold.count == 0) return;
    EXPECT_NEAR(length(manifold.normal), 1, 1e-9);
    if (!c.facet.two_sided) {
        EXPECT_GE(dot(manifold.normal, c.facet.normal()), -2e-6);
    }
    double least = 1e300;
    for (int k = 0; k < manifold.count; ++k) {
        const auto& point = manifold.points[std::size_t(k)];
        EXPECT_LE(point.separation, reach + 1e-12);
        least = std::min(least, point.separation);
        for (int j = 0; j < k; ++j) EXPECT_NE(point.feature, manifold.points[std::size_t(j)].feature);
        // Each point lies within the reach of the shape and of the triangle.
        const double near = std::fabs(point.separation) + 5e-2 * c.size() + body.vagueness();
        EXPECT_LE(body.height(point.position), near);
    }
    const double slack = 0.06 * std::fabs(found->distance) + 2e-3 * c.size() + body.vagueness();
    EXPECT_NEAR(least, found->distance, slack) << "the deepest point";
}

class EveryKind : public testing::TestWithParam<int> {};

TEST_P(EveryKind, MeetsATriangleAsTheOracleSays) {
    const Kind kind = convex_kinds[GetParam()];
    Random random(std::uint64_t(700 + GetParam()));
    const int cases = kind == Kind::cylinder || kind == Kind::cone ? 300 : 1500;
    for (int n = 0; n < cases; ++n) {
        const Case c(kind, n, random);
        SCOPED_TRACE(name_of(kind) + ", case " + std::to_string(n));
        expect_right(c);
        if (testing::Test::HasFailure()) break;
    }
}

INSTANTIATE_TEST_SUITE_P(Space, EveryKind, testing::Range(0, 6),
                         [](const auto& kind) { return name_of(convex_kinds[kind.param]); });

const Facet<3> ground{{Vec3{-5, 0, -5}, Vec3{0, 0, 5}, Vec3{5, 0, -5}}, false};

detail::Shape<3> shape_of(const Geometry<3>& geometry) {
    return detail::make_shape<3>({.geometry = geometry});
}

TEST(Facet3, ABoxOnATriangleRestsOnItsFourCorners) {
    const auto box = shape_of(Box3{{1, 1, 1}});
    const Manifold<3> found = detail::collide_facet<3>(box, ground, {{0, 0.499, 0}, {}}, 0.01);
    ASSERT_EQ(found.count, 4);
    EXPECT_EQ(found.normal, (Vec3{0, 1, 0}));
    for (const auto& point : found.points) EXPECT_NEAR(point.separation, -0.001, 1e-12);
}

TEST(Facet3, ABoxDeepInATriangleStillGoesUpNotAside) {
    const auto box = shape_of(Box3{{1, 1, 1}});
    const Manifold<3> found = detail::collide_facet<3>(box, ground, {{0, 0.01, 0}, {}}, 0.01);
    ASSERT_GT(found.count, 0);
    EXPECT_EQ(found.normal, (Vec3{0, 1, 0}));
    EXPECT_NEAR(found.points[0].separation, -0.49, 1e-12);
    EXPECT_EQ(detail::collide_facet<3>(box, ground, {{0, -0.01, 0}, {}}, 0.01).count, 0) << "from behind";
}

TEST(Facet3, ABoxOverTheEdgeOfATriangleLeavesByTheShorterWay) {
    // The triangle ends a little inside the box: the way out is sideways, not the whole depth upwards.
    const auto box = shape_of(Box3{{1, 1, 1}});
    const auto found = detail::separate_facet<3>(box, ground, {{0, 0.1, -5.45}, {}});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, -0.05, 1e-9);
    EXPECT_NEAR(found->axis.z, -1, 1e-9);
}

TEST(Facet3, TwoSidedTrianglesMeetShapesFromBelow) {
    Facet<3> both = ground;
    both.two_sided = true;
    const auto ball = shape_of(Ball{0.5});
    const Manifold<3> found = detail::collide_facet<3>(ball, both, {{0, -0.4, 0}, {}}, 0);
    ASSERT_EQ(found.count, 1);
    EXPECT_EQ(found.normal, (Vec3{0, -1, 0}));
    EXPECT_NEAR(found.points[0].separation, -0.1, 1e-12);
    EXPECT_NEAR(found.points[0].position.y, 0.05, 1e-12);
}

TEST(Facet3, MeshesAnswerQueriesByTheirNearestTriangle) {
    // A unit cube of triangles, and a ball that approaches one of its faces, far from the origin.
    Mesh cube;
    for (int i = 0; i < 8; ++i) cube.vertices.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
    cube.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    const Transform3 placed{{1e6, 0, 0}, Rotation3::from_axis_angle({0, 0, 1}, 0.5)};
    const Solid<3> mesh{Geometry<3>{cube}}, ball{Geometry<3>{Ball{0.25}}};
    for (const double gap : {-0.2, -0.01, 0.01, 3.0, 1000.0}) {
        const Transform3 at{apply(placed, {0.3, 0.6, 1.25 + gap}), {}};
        const auto found = separation<3>(mesh, placed, ball, at);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, gap, 1e-8);
        EXPECT_NEAR(found->axis.z, 1, 1e-8);
        EXPECT_EQ(overlap<3>(ball, at, mesh, placed), gap <= 0);
        const Manifold<3> manifold = collide<3>(ball, at, mesh, placed, 0.1);
        EXPECT_EQ(manifold.count, gap < 0.1 ? 1 : 0);
        if (manifold.count > 0) {
            EXPECT_NEAR(manifold.normal.z, -1, 1e-8);
        }
    }
    EXPECT_FALSE((separation<3>(mesh, placed, ball, {apply(placed, {0.5, 0.5, 0.5}), {}})))
        << "inside there is no front";
}

}  // namespace

}  // namespace carom::test::space
