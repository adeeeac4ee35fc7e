#include "geometry/terrain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "../collision/random.hpp"
#include "carom/error.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

namespace {

using test::Random;

constexpr double hole = std::numeric_limits<double>::quiet_NaN();

Terrain<2> random_ground(Random& random, const Transform2& placed, int kind, int size) {
    if (kind == 0) {
        Chain chain;
        chain.loop = random.below(2) == 0;
        for (int i = 0; i < size; ++i) chain.points.push_back(random.in_cube<2>(5) + Vec2{0.1 * i, 0});
        return {chain, placed};
    }
    HeightField2 field;
    field.spacing = {0.3};
    for (int i = 0; i < size; ++i)
        field.heights.push_back(random.below(9) == 0 ? hole : random.between(0, 2));
    field.heights[0] = field.heights[1] = 1;
    return {field, placed};
}

Terrain<3> random_ground(Random& random, const Transform3& placed, int kind, int size) {
    if (kind == 0) {
        Mesh mesh;
        for (int i = 0; i < size; ++i) {
            // Small ones anywhere, now and then a sliver across all, and many at one place.
            const Vec3 middle = random.below(10) == 0 ? Vec3{1, 1, 1} : random.in_cube<3>(10);
            const double half = random.below(20) == 0 ? 10 : 0.5;
            const auto first = std::uint32_t(mesh.vertices.size());
            for (int k = 0; k < 3; ++k) mesh.vertices.push_back(middle + random.in_cube<3>(half));
            if (random.below(20) == 0) mesh.vertices.back() = mesh.vertices[first];  // no area
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
        return {mesh, placed};
    }
    HeightField3 field;
    field.spacing = {0.5, 0.25};
    field.heights.resize(std::size_t(3 + size / 20));
    for (auto& row : field.heights)
        for (int i = 0; i < 23; ++i) row.push_back(random.below(12) == 0 ? hole : random.between(0, 2));
    field.heights[0][0] = field.heights[1][0] = field.heights[1][1] = 1;
    return {field, placed};
}

template <int D>
bool is_there(const Facet<D>& facet) {
    for (const Vec<D>& p : facet.points)
        if (!(length(p) < 1e300)) return false;
    if constexpr (D == 3)
        return length(cross(facet.points[1] - facet.points[0], facet.points[2] - facet.points[0])) > 0;
    return true;
}

template <int D>
bool overlap(const Aabb<D>& a, const Aabb<D>& b) {
    for (int i = 0; i < D; ++i)
        if (!(a.lower[i] <= b.upper[i] && b.lower[i] <= a.upper[i])) return false;
    return true;
}

template <int D>
void expect_queries_like_brute_force() {
    Random random(D);
    for (int n = 0; n < 60; ++n) {
        const Transform<D> placed = n % 4 < 2 ? Transform<D>{} : random.placement<D>(n % 7 == 0 ? 1e6 : 3);
        const Terrain<D> ground = random_ground(random, placed, n % 2, 3 + n * n / 4);
        SCOPED_TRACE(n);
        for (int q = 0; q < 40; ++q) {
            const Vec<D> middle = apply(placed, random.in_cube<D>(11));
            Vec<D> half;
            for (int i = 0; i < D; ++i) half[i] = random.between(0, random.below(3) == 0 ? 12 : 1);
            if (q == 0) half = {};
            const Aabb<D> box{middle - half, middle + half};
            std::vector<std::uint32_t> found, expected;
            ground.query(box, [&](std::uint32_t i) { found.push_back(i); });
            for (std::uint32_t i = 0; i < ground.size(); ++i) {
                const Facet<D> facet = ground.facet(i);
                if (is_there(facet) && overlap(facet.bounds(), box)) expected.push_back(i);
            }
            std::vector<std::uint32_t> again;
            ground.query(box, [&](std::uint32_t i) { again.push_back(i); });
            EXPECT_EQ(found, again);
            std::sort(found.begin(), found.end());
            // Facets that do not touch the box themselves may be left out.
            EXPECT_TRUE(std::includes(expected.begin(), expected.end(), found.begin(), found.end()));
            for (const std::uint32_t i : expected) {
                const Facet<D> facet = ground.facet(i);
                Vec<D> sum{};
                for (const Vec<D>& p : facet.points) sum += p;
                for (const Vec<D>& p : {facet.points[0], facet.points[D - 1], sum / D}) {
                    if (overlap<D>({p, p}, box)) {
                        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), i));
                    }
                }
            }
        }
    }
}

TEST(Terrain, QueriesFindWhatBruteForceFinds) {
    expect_queries_like_brute_force<2>();
    expect_queries_like_brute_force<3>();
}

/// Fraction at which a ray meets a facet, or more than 1.
double hit(const Facet<2>& facet, const Vec2& origin, const Vec2& way) {
    const Vec2 along = facet.points[1] - facet.points[0];
    const double determinant = cross(way, along);
    if (determinant == 0) return 2;
    const double t = cross(facet.points[0] - origin, along) / determinant;
    const double s = cross(facet.points[0] - origin, way) / determinant;
    return t >= 0 && s >= 0 && s <= 1 ? t : 2;
}

double hit(const Facet<3>& facet, const Vec3& origin, const Vec3& way) {
    const Vec3 u = facet.points[1] - facet.points[0], v = facet.points[2] - facet.points[0];
    const Vec3 normal = cross(u, v);
    const double t = dot(normal, facet.points[0] - origin) / dot(normal, way);
    if (!(t >= 0 && t <= 1)) return 2;
    const Vec3 p = origin + t * way;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& from = facet.points[i];
        if (dot(cross(facet.points[(i + 1) % 3] - from, p - from), normal) < 0) return 2;
    }
    return t;
}

template <int D>
void expect_casts_like_brute_force() {
    Random random(10 + D);
    int hits = 0;
    for (int n = 0; n < 60; ++n) {
        const Transform<D> placed = n % 4 == 0 ? Transform<D>{} : random.placement<D>(3);
        const Terrain<D> ground = random_ground(random, placed, n % 2, 3 + n * n / 4);
        SCOPED_TRACE(n);
        for (int q = 0; q < 40; ++q) {
            const Vec<D> origin = apply(placed, random.in_cube<D>(11));
            Vec<D> way = apply(placed, random.in_cube<D>(11)) - origin;
            if (q % 4 == 0) {
                way = {};
                way[q / 4 % D] = q % 8 == 0 ? 15 : -15;
            }
            double expected = 1, found = 1;
            for (std::uint32_t i = 0; i < ground.size(); ++i) {
                const Facet<D> facet = ground.facet(i);
                if (is_there(facet)) expected = std::min(expected, hit(facet, origin, way));
            }
            std::uint32_t visits = 0;
            ground.cast(origin, way, 1.0, [&](std::uint32_t i, double max) {
                ++visits;
                found = std::min(max, hit(ground.facet(i), origin, way));
                return found;
            });
            EXPECT_EQ(found, expected);
            EXPECT_LE(visits, ground.size());
            hits += expected < 1;
        }
    }
    EXPECT_GT(hits, 400);
}

TEST(Terrain, CastsFindTheFirstFacetThatBruteForceFinds) {
    expect_casts_like_brute_force<2>();
    expect_casts_like_brute_force<3>();
}

TEST(Terrain, CastsOfABoxVisitAllThatItMeets) {
    Random random(20);
    for (int n = 0; n < 40; ++n) {
        const Transform3 placed = random.placement<3>(3);
        const Terrain<3> ground = random_ground(random, placed, n % 2, 300);
        const Vec3 origin = apply(placed, random.in_cube<3>(11)), half{0.5, 0.2, 0.3};
        const Vec3 way = random.in_cube<3>(8);
        std::vector<std::uint32_t> visited;
        ground.cast(
            origin, way, 1,
            [&](std::uint32_t i, double max) {
                visited.push_back(i);
                return max;
            },
            half);
        std::sort(visited.begin(), visited.end());
        for (int step = 0; step <= 50; ++step) {
            const Vec3 at = origin + step / 50.0 * way;
            ground.query({at - half, at + half}, [&](std::uint32_t i) {
                EXPECT_TRUE(std::binary_search(visited.begin(), visited.end(), i));
            });
        }
    }
}

TEST(Terrain, ARayThatIsBlockedDoesNotVisitWhatIsFarBehind) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const double x = i;
        mesh.vertices.insert(mesh.vertices.end(), {{x, -1, -1}, {x, 1, -1}, {x, 0, 1}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Terrain<3> ground(mesh, {});
    int visits = 0;
    double first = 1;
    ground.cast({-1, 0, 0}, {6000, 0, 0}, 1, [&](std::uint32_t i, double max) {
        ++visits;
        return first = std::min(max, hit(ground.facet(i), {-1, 0, 0}, {6000, 0, 0}));
    });
    EXPECT_NEAR(first, 1 / 6000.0, 1e-12);
    EXPECT_LE(visits, 8);
}

TEST(Terrain, FacetsLookOutOfTheSolid) {
    // Travel along +x: the solid is below.
    const Terrain<2> chain(Chain{.points = {{0, 0}, {1, 0}}}, {});
    EXPECT_EQ(chain.facet(0).normal(), (Vec2{0, 1}));
    HeightField2 hills;
    hills.heights = {1, 1, 2};
    hills.spacing = {2};
    const Terrain<2> field(hills, {});
    EXPECT_EQ(field.facet(0).normal(), (Vec2{0, 1}));
    EXPECT_EQ(field.facet(1).points[1], (Vec2{4, 2}));
    EXPECT_GT(field.facet(1).normal().y, 0);

    HeightField3 land;
    land.heights = {{0, 1, 2}, {3, 4, 5}};
    land.spacing = {2, 3};
    const Terrain<3> ground(land, {});
    ASSERT_EQ(ground.size(), 4u);
    EXPECT_EQ(ground.facet(2).points, (std::array<Vec3, 3>{{{2, 1, 0}, {2, 4, 3}, {4, 5, 3}}}));
    EXPECT_EQ(ground.facet(3).points, (std::array<Vec3, 3>{{{2, 1, 0}, {4, 5, 3}, {4, 2, 0}}}));
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_GT(ground.facet(i).normal().y, 0);
    EXPECT_EQ(ground.bounds().lower, (Vec3{0, 0, 0}));
    EXPECT_EQ(ground.bounds().upper, (Vec3{4, 5, 3}));
}

TEST(Terrain, MaterialsBelongToSegmentsTrianglesAndCells) {
    const std::vector<Material> materials{{.friction = 0.1}, {.friction = 0.2}};
    Chain chain{.points = {{0, 0}, {1, 0}, {2, 0}}, .materials = materials, .material_of = {1, 0}};
    const Terrain<2> line(chain, {});
    EXPECT_EQ(line.material(0)->friction, 0.2);
    EXPECT_EQ(line.material(1)->friction, 0.1);
    HeightField3 land;
    land.heights = {{0, 0, 0}, {0, 0, 0}};
    land.spacing = {1, 1};
    EXPECT_EQ(Terrain<3>(land, {}).material(0), nullptr);
    land.materials = materials;
    land.material_of = {0, 1};
    const Terrain<3> ground(land, {});
    EXPECT_EQ(ground.material(1)->friction, 0.1);
    EXPECT_EQ(ground.material(2)->friction, 0.2);
    EXPECT_EQ(ground.material(3)->friction, 0.2);
}

TEST(Terrain, ItsShapeHasTheBoundsOfItsPlaceAndNoMass) {
    ShapeDefinition2 shape;
    shape.geometry = Chain{.points = {{0, 0}, {1, 0}, {1, 2}}};
    shape.center = {10, 0};
    const Aabb<2> box =
        bounds(make_shape(shape), Transform2{{0, 5}, Rotation2::from_angle(std::numbers::pi / 2)});
    EXPECT_NEAR(box.lower.x, -2, 1e-12);
    EXPECT_NEAR(box.lower.y, 15, 1e-12);
    EXPECT_NEAR(box.upper.x, 0, 1e-12);
    EXPECT_NEAR(box.upper.y, 16, 1e-12);
    EXPECT_EQ(measure<2>(shape.geometry), 0);
}

template <int D>
std::string refusal(const Geometry<D>& geometry) {
    try {
        make_shape(ShapeDefinition<D>{.geometry = geometry});
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Terrain, RefusesWhatCannotBeInWords) {
    EXPECT_EQ(refusal<2>(Chain{}), "points: 0 are fewer than 2");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {1, 0}}, .loop = true}), "points: 2 are fewer than 3");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {1, 0}, {1, 0}}}),
              "points[2]: lies at the same place as points[1]");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {1, 0}, {0, 0}}, .loop = true}),
              "points[0]: lies at the same place as points[2]");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {hole, 0}}}), "points[1][0]: nan is not finite");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {1, 0}}, .materials = {{}}, .material_of = {0, 0}}),
              "material_of: has 2 entries for 1 segments");
    EXPECT_EQ(refusal<2>(Chain{.points = {{0, 0}, {1, 0}}, .materials = {{}}, .material_of = {1}}),
              "material_of[0]: 1 is not the index of one of the 1 materials");
    EXPECT_EQ(
        refusal<2>(Chain{.points = {{0, 0}, {1, 0}}, .materials = {{.friction = -1}}, .material_of = {0}}),
        "materials[0].friction: -1 is negative");

    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    EXPECT_EQ(refusal<3>(Mesh{}), "vertices: 0 are fewer than 3");
    EXPECT_EQ(refusal<3>(Mesh{.vertices = corners}), "triangles: 0 are fewer than 1");
    EXPECT_EQ(refusal<3>(Mesh{.vertices = corners, .triangles = {{0, 1, 2}, {0, 1, 4}}}),
              "triangles[1]: 4 is not the index of one of the 4 vertices");
    EXPECT_EQ(refusal<3>(Mesh{.vertices = corners, .triangles = {{0, 1, 0}}}),
              "triangles[0]: names vertex 0 twice");
    EXPECT_EQ(refusal<3>(Mesh{.vertices = corners, .triangles = {{0, 1, 3}}}), "triangles: none has an area");
    EXPECT_EQ(refusal<3>(Mesh{.vertices = corners, .triangles = {{0, 1, 3}, {0, 1, 2}}}), "accepted");

    HeightField3 land;
    EXPECT_EQ(refusal<3>(land), "heights: 0 are fewer than 2");
    land.heights = {{0, 0}, {0, 0, 0}};
    EXPECT_EQ(refusal<3>(land), "spacing[0]: 0 is not positive");
    land.spacing = {1, 1};
    EXPECT_EQ(refusal<3>(land), "heights[1]: has 3 heights, the first row has 2");
    land.heights = {{0, hole}, {0, std::numeric_limits<double>::infinity()}};
    EXPECT_EQ(refusal<3>(land), "heights[1][1]: inf is not finite");
    land.heights = {{hole, 0}, {0, hole}};
    EXPECT_EQ(refusal<3>(land), "heights: all cells are holes");
    EXPECT_EQ(refusal<2>(HeightField2{.heights = {0, 0}, .spacing = {-1}}), "spacing: -1 is not positive");
}

}  // namespace

}  // namespace carom::detail
