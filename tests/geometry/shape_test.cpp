#include "geometry/shape.hpp"

#include <gtest/gtest.h>

#include "../collision/random.hpp"
#include "carom/error.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

using test::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <int D>
std::string refusal(const ShapeDefinition<D>& definition) {
    try {
        make_shape(definition);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}
std::string refusal_2(const Geometry<2>& geometry) { return refusal<2>({geometry}); }
std::string refusal_3(const Geometry<3>& geometry) { return refusal<3>({geometry}); }

TEST(Shape, RefusesBadBallsAndCapsules) {
    EXPECT_EQ(refusal_2(Ball{0.5}), "no error");
    EXPECT_EQ(refusal_2(Ball{-1}), "radius: -1 is not positive");
    EXPECT_EQ(refusal_3(Ball{0}), "radius: 0 is not positive");
    EXPECT_EQ(refusal_3(Ball{not_a_number}), "radius: nan is not finite");
    EXPECT_EQ(refusal_3(Ball{infinity}), "radius: inf is not finite");
    EXPECT_EQ(refusal_3(Ball{1e10}), "radius: 1e+10 is not between 1e-09 and 1e+09");
    EXPECT_EQ(refusal_3(Ball{1e-10}), "radius: 1e-10 is not between 1e-09 and 1e+09");
    EXPECT_EQ(refusal_2(Capsule2{{0, 0}, {0, 0}, 1}), "no error");
    EXPECT_EQ(refusal_2(Capsule2{{0, not_a_number}, {0, 0}, 1}), "from[1]: nan is not finite");
    EXPECT_EQ(refusal_3(Capsule3{{0, 0, 0}, {0, 0, infinity}, 1}), "to[2]: inf is not finite");
    EXPECT_EQ(refusal_3(Capsule3{{0, 0, 0}, {0, 0, 2e9}, 1}), "to[2]: 2e+09 is not between -1e+09 and 1e+09");
    EXPECT_EQ(refusal_2(Capsule2{{0, 0}, {1, 0}, 0}), "radius: 0 is not positive");
}

TEST(Shape, RefusesBadBoxes) {
    EXPECT_EQ(refusal_2(Box2{{1, 1}, 0.5}), "no error");
    EXPECT_EQ(refusal_2(Box2{{1, 0}}), "size[1]: 0 is not positive");
    EXPECT_EQ(refusal_3(Box3{{1, 1, -2}}), "size[2]: -2 is not positive");
    EXPECT_EQ(refusal_3(Box3{}), "size[0]: 0 is not positive");
    EXPECT_EQ(refusal_3(Box3{{1, infinity, 1}}), "size[1]: inf is not finite");
    EXPECT_EQ(refusal_3(Box3{{1, 2e9, 1}}), "size[1]: 2e+09 is not between 1e-09 and 1e+09");
    EXPECT_EQ(refusal_2(Box2{{1, 1}, -0.1}), "rounding: -0.1 is negative");
    EXPECT_EQ(refusal_2(Box2{{1, 1}, not_a_number}), "rounding: nan is not finite");
    EXPECT_EQ(refusal_3(Box3{{1, 2, 3}, 0.6}), "rounding: 0.6 is more than half of the smallest length, 1");
}

TEST(Shape, RefusesBadHulls) {
    EXPECT_EQ(refusal_2(Hull2{{{0, 0}, {1, 0}}}), "points: 2 are fewer than 3");
    EXPECT_EQ(refusal_2(Hull2{{{0, 0}, {1, 0}, {2, 0}}}), "points: 3 points span no area");
    EXPECT_EQ(refusal_2(Hull2{{{0, 0}, {1, 0}, {0, infinity}}}), "points[2][1]: inf is not finite");
    EXPECT_EQ(refusal_2(Hull2{{{0, 0}, {1, 0}, {0, 1}}, -1}), "rounding: -1 is negative");
    EXPECT_EQ(refusal_2(Hull2{{{0, 0}, {1, 0}, {0, 1}}, 2e9}), "rounding: 2e+09 is not between 0 and 1e+09");
    EXPECT_EQ(refusal_3(Hull3{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}),
              "points: 4 points span no volume");
}

TEST(Shape, RefusesBadPlanesCylindersAndCones) {
    EXPECT_EQ(refusal_2(Plane2{{0, 3}, -1}), "no error");
    EXPECT_EQ(refusal_2(Plane2{}), "normal: all components are zero");
    EXPECT_EQ(refusal_3(Plane3{{0, not_a_number, 0}}), "normal[1]: nan is not finite");
    EXPECT_EQ(refusal_3(Plane3{{0, 1, 0}, infinity}), "offset: inf is not finite");
    EXPECT_EQ(refusal_3(Cylinder{0, 1}), "radius: 0 is not positive");
    EXPECT_EQ(refusal_3(Cylinder{1, -1}), "height: -1 is not positive");
    EXPECT_EQ(refusal_3(Cone{-3, 1}), "radius: -3 is not positive");
    EXPECT_EQ(refusal_3(Cone{1, not_a_number}), "height: nan is not finite");
}

TEST(Shape, RefusesBadPlacesAndMaterials) {
    ShapeDefinition2 shape{Ball{}};
    shape.center = {0, infinity};
    EXPECT_EQ(refusal(shape), "center[1]: inf is not finite");
    shape = {Ball{}};
    shape.rotation = {1, 1};
    EXPECT_EQ(refusal(shape), "rotation: its length is 1.4142135623730951, not 1");
    ShapeDefinition3 solid{Ball{}};
    solid.rotation = {0, 0, 0, 0};
    EXPECT_EQ(refusal(solid), "rotation: its length is 0, not 1");
    const auto with = [](double Material::*field, double value) {
        ShapeDefinition3 definition{Ball{}};
        definition.material.*field = value;
        return refusal(definition);
    };
    EXPECT_EQ(with(&Material::density, 0), "no error");
    EXPECT_EQ(with(&Material::density, -1), "density: -1 is negative");
    EXPECT_EQ(with(&Material::density, infinity), "density: inf is not finite");
    EXPECT_EQ(with(&Material::friction, -0.5), "friction: -0.5 is negative");
    EXPECT_EQ(with(&Material::friction, not_a_number), "friction: nan is not finite");
    EXPECT_EQ(with(&Material::restitution, 1), "no error");
    EXPECT_EQ(with(&Material::restitution, 1.1), "restitution: 1.1 is not between 0 and 1");
    EXPECT_EQ(with(&Material::restitution, -0.1), "restitution: -0.1 is not between 0 and 1");
    EXPECT_EQ(with(&Material::rolling_resistance, -1), "rolling_resistance: -1 is negative");
}

/// One of each kind that has an inside, placed anywhere.
template <int D>
ShapeDefinition<D> random_shape(Random& random, int kind) {
    ShapeDefinition<D> shape;
    shape.center = random.in_cube<D>(2);
    shape.rotation = random.rotation<D>();
    Vec<D> size;
    for (int i = 0; i < D; ++i) size[i] = random.between(0.2, 2);
    const double radius = random.between(0.1, 1);
    Hull<D> hull;
    switch (kind) {
        case 0:
            shape.geometry = Ball{radius};
            break;
        case 1:
            shape.geometry = Capsule<D>{-size, 0.5 * size, radius};
            break;
        case 2:
            shape.geometry = Box<D>{size, random.below(2) * 0.1};
            break;
        case 3:
            for (int i = 0; i < 12; ++i) hull.points.push_back(random.in_cube<D>(1));
            hull.rounding = random.below(2) * 0.1;
            shape.geometry = hull;
            break;
        case 4:
            if constexpr (D == 3) shape.geometry = Cylinder{radius, size.x};
            break;
        default:
            if constexpr (D == 3) shape.geometry = Cone{radius, size.x};
    }
    return shape;
}

/// Points all over the surface, from the definition alone.
template <int D>
std::vector<Vec<D>> surface(Random& random, const ShapeDefinition<D>& shape) {
    std::vector<Vec<D>> points;
    const auto grown = [&](std::vector<Vec<D>> corners, double radius) {
        for (const Vec<D>& corner : corners) {
            for (int k = 0; k < 3000; ++k) points.push_back(corner + radius * random.template direction<D>());
            for (int i = 0; i < D; ++i) {
                for (const double side : {-1.0, 1.0}) {
                    // The points that bound the shape if the body is not turned.
                    Vec<D> axis{};
                    axis[i] = side;
                    points.push_back(corner + radius * unrotate(shape.rotation, axis));
                }
            }
        }
    };
    const auto& geometry = shape.geometry;
    if (const auto* ball = std::get_if<Ball>(&geometry)) grown({Vec<D>{}}, ball->radius);
    if (const auto* capsule = std::get_if<Capsule<D>>(&geometry))
        grown({capsule->from, capsule->to}, capsule->radius);
    if (const auto* hull = std::get_if<Hull<D>>(&geometry)) grown(hull->points, hull->rounding);
    if (const auto* box = std::get_if<Box<D>>(&geometry)) {
        std::vector<Vec<D>> corners;
        for (int k = 0; k < 1 << D; ++k) {
            Vec<D> corner;
            for (int i = 0; i < D; ++i)
                corner[i] = (k >> i & 1 ? 1 : -1) * (0.5 * box->size[i] - box->rounding);
            corners.push_back(corner);
        }
        grown(corners, box->rounding);
    }
    if constexpr (D == 3) {
        const auto ring = [&](double radius, double y) {
            for (int k = 0; k < 20000; ++k) {
                const auto [sine, cosine] = sin_cos(2 * pi * k / 20000);
                points.push_back({radius * cosine, y, radius * sine});
            }
        };
        if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) {
            ring(cylinder->radius, 0.5 * cylinder->height);
            ring(cylinder->radius, -0.5 * cylinder->height);
        }
        if (const auto* cone = std::get_if<Cone>(&geometry)) {
            ring(cone->radius, -0.5 * cone->height);
            ring(0, 0.5 * cone->height);
        }
    }
    for (Vec<D>& p : points) p = rotate(shape.rotation, p) + shape.center;
    return points;
}

template <int D>
void expect_tight_bounds_and_true_supports() {
    Random random(D);
    for (int k = 0; k < 120; ++k) {
        const ShapeDefinition<D> definition = random_shape<D>(random, k % (D == 2 ? 4 : 6));
        const Shape<D> shape = make_shape(definition);
        const std::vector<Vec<D>> points = surface(random, definition);
        const Transform<D> placed = random.placement<D>(5);
        // Hulls leave out less than their tolerance; sampled caps miss the highest point by a little.
        const double missed = 4e-5,
                     sampled = definition.geometry.index() == 0 || shape.radius > 0 ? 0.03 : missed;

        const Aabb<D> box = bounds(shape, placed), still = bounds(shape, Transform<D>{});
        Vec<D> lower, upper, still_lower, still_upper;
        for (int i = 0; i < D; ++i) {
            lower[i] = still_lower[i] = 1e300;
            upper[i] = still_upper[i] = -1e300;
            for (const Vec<D>& p : points) {
                const Vec<D> q = apply(placed, p);
                lower[i] = std::min(lower[i], q[i]);
                upper[i] = std::max(upper[i], q[i]);
                still_lower[i] = std::min(still_lower[i], p[i]);
                still_upper[i] = std::max(still_upper[i], p[i]);
            }
            EXPECT_LE(box.lower[i], lower[i] + missed);
            EXPECT_GE(box.upper[i], upper[i] - missed);
            EXPECT_GE(box.lower[i], lower[i] - sampled);
            EXPECT_LE(box.upper[i], upper[i] + sampled);
            EXPECT_NEAR(still.lower[i], still_lower[i], missed);
            EXPECT_NEAR(still.upper[i], still_upper[i], missed);
        }
        for (int j = 0; j < 20; ++j) {
            const Vec<D> u = random.direction<D>();
            const Vec<D> support = core_support(shape, random.between(0.01, 100) * u);
            double furthest = -1e300;
            for (const Vec<D>& p : points) furthest = std::max(furthest, dot(u, p));
            const double reach = dot(u, support) + core_radius(shape);
            EXPECT_GE(reach, furthest - missed);
            EXPECT_LE(reach, furthest + sampled);
        }
    }
}

TEST(Shape, BoundsAreTightAndSupportsAreFurthest) {
    expect_tight_bounds_and_true_supports<2>();
    expect_tight_bounds_and_true_supports<3>();
}

TEST(Shape, BoundsInClosedForm) {
    const Shape<3> cylinder = make_shape<3>({Cylinder{1, 2}});
    // Turned by 45° about z: the axis (−1, 1, 0)/√2 and the rim add up.
    const Transform3 placed{{0, 0, 0}, Rotation3::from_axis_angle({0, 0, 1}, pi / 4)};
    const Aabb<3> box = bounds(cylinder, placed);
    EXPECT_NEAR(box.upper.x, std::sqrt(2), 1e-15);
    EXPECT_NEAR(box.upper.y, std::sqrt(2), 1e-15);
    EXPECT_NEAR(box.upper.z, 1, 1e-15);
    EXPECT_NEAR(box.lower.x, -std::sqrt(2), 1e-15);
    const Aabb<3> cone = bounds(make_shape<3>({Cone{1, 2}}), placed);
    EXPECT_NEAR(cone.lower.x, -std::sqrt(0.5), 1e-15);  // the tip
    EXPECT_NEAR(cone.upper.x, std::sqrt(2), 1e-15);     // the base
    EXPECT_NEAR(cone.lower.y, -std::sqrt(2), 1e-15);
    EXPECT_NEAR(cone.upper.y, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(cone.upper.z, 1, 1e-15);
}

TEST(Shape, BoundsOfPlanes) {
    const Shape<2> ground = make_shape<2>({Plane2{{0, 2}, 3}});
    const Aabb<2> box = bounds(ground, {{5, 7}, {}});
    EXPECT_EQ(box.upper.y, 10);
    EXPECT_LE(box.lower.y, -1e299);
    EXPECT_LE(box.lower.x, -1e299);
    EXPECT_GE(box.upper.x, 1e299);
    ShapeDefinition3 wall{Plane3{{-1, 0, 0}, 2}};
    wall.center = {10, 0, 0};
    EXPECT_EQ(bounds(make_shape(wall), {{100, 0, 0}, {}}).lower.x, 108);
    const Aabb<3> slope = bounds(make_shape<3>({Plane3{{1, 1, 0}}}), {});
    EXPECT_LE(slope.lower.x, -1e299);
    EXPECT_GE(slope.upper.x, 1e299);
    EXPECT_GE(slope.upper.y, 1e299);
}

TEST(Shape, IsPlacedInTheBody) {
    ShapeDefinition2 plane{Plane2{{3, 0}, 1}};
    plane.center = {0, 5};
    plane.rotation = Rotation2::from_angle(pi / 2);
    const Shape<2> turned = make_shape(plane);
    EXPECT_NEAR(turned.a.y, 1, 1e-15);
    EXPECT_NEAR(turned.offset, 6, 1e-15);

    ShapeDefinition3 cylinder{Cylinder{1, 4}};
    cylinder.rotation = Rotation3::from_axis_angle({0, 0, 1}, -pi / 2);
    EXPECT_NEAR(make_shape(cylinder).b.x, 1, 1e-15);
    EXPECT_EQ(make_shape(cylinder).half_height, 2);

    // A rotation that is a little off is made exact.
    ShapeDefinition2 box{Box2{{2, 4}}};
    box.rotation = {1.00005, 0};
    EXPECT_EQ(make_shape(box).rotation, Rotation2{});
}

TEST(Shape, CoresOfBoxesAreTheirHulls) {
    Random random(7);
    for (int k = 0; k < 50; ++k) {
        const ShapeDefinition3 definition = random_shape<3>(random, 2);
        const Shape<3> box = make_shape(definition);
        const Polyhedron hull = convex_polyhedron(box.core->vertices);
        EXPECT_EQ(hull.normals.size(), 6u);
        EXPECT_EQ(box.core->edges.size(), 12u);
        for (std::size_t f = 0; f < 6; ++f) {
            std::size_t same = 0;
            for (std::size_t g = 0; g < 6; ++g) {
                if (dot(box.core->normals[f], hull.normals[g]) < 0.999) continue;
                ++same;
                EXPECT_NEAR(length(box.core->normals[f] - hull.normals[g]), 0, 1e-11);
                EXPECT_NEAR(box.core->offsets[f], hull.offsets[g], 1e-11);
            }
            EXPECT_EQ(same, 1u);
            for (auto i = box.core->first[f]; i < box.core->first[f + 1]; ++i) {
                EXPECT_NEAR(dot(box.core->normals[f], box.core->vertices[box.core->indices[i]]),
                            box.core->offsets[f], 1e-14);
            }
        }
        for (const auto& edge : box.core->edges) {
            const Vec3 along = box.core->vertices[edge.to] - box.core->vertices[edge.from];
            EXPECT_GT(dot(cross(box.core->normals[edge.left], box.core->normals[edge.right]), along), 0);
        }
        const Shape<2> flat = make_shape(random_shape<2>(random, 2));
        ASSERT_EQ(flat.core->vertices.size(), 4u);
        for (int i = 0; i < 4; ++i) {
            const Vec2 along = flat.core->vertices[(i + 1) % 4] - flat.core->vertices[i];
            EXPECT_NEAR(dot(flat.core->normals[i], along), 0, 1e-14);
            EXPECT_GT(cross(flat.core->normals[i], along), 0);
        }
    }
}

TEST(Shape, ARoundBoxKeepsACore) {
    const Shape<3> box = make_shape<3>({Box3{{1, 2, 3}, 0.5}});
    EXPECT_NEAR(box.radius, 0.5, 1e-3);
    EXPECT_GT(box.b.x, 0);
    EXPECT_DOUBLE_EQ(box.b.x + box.radius, 0.5);
    EXPECT_DOUBLE_EQ(box.b.z + box.radius, 1.5);
    EXPECT_EQ(core_radius(box), box.radius);
    EXPECT_EQ(core_radius(make_shape<3>({Cone{}})), 0);
}

}  // namespace
}  // namespace carom::detail
