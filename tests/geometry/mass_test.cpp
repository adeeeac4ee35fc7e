#include "carom/mass.hpp"

#include <gtest/gtest.h>

#include "../collision/random.hpp"
#include "carom/error.hpp"
#include "rays.hpp"

namespace carom {
namespace {

using test::Random;

/// A shape with what the quadrature needs: the distance to its surface in its own frame from a point inside.
template <int D>
struct Sample {
    Geometry<D> geometry;
    Vec<D> inside;
    test::Exit<D> exit;
};

template <int D>
Sample<D> random_ball(Random& random) {
    const double radius = random.between(0.1, 2);
    const Vec<D> o = 0.5 * radius * random.direction<D>();
    return {Ball{radius}, o, [=](const Vec<D>& u) { return test::leaves_ball(o, u, Vec<D>{}, radius); }};
}

template <int D>
Sample<D> random_capsule(Random& random) {
    Capsule<D> capsule;
    capsule.from = random.in_cube<D>(1);
    capsule.to = random.in_cube<D>(1);
    capsule.radius = random.between(0.2, 1);
    const Vec<D> o = 0.3 * capsule.from + 0.7 * capsule.to;
    return {capsule, o, [=](const Vec<D>& u) {
                return test::leaves_capsule(o, u, capsule.from, capsule.to, capsule.radius);
            }};
}

/// Corners, edges and faces of a box, each found from its own definition.
test::Rounded<2> box_parts(const Vec2& h) {
    test::Rounded<2> parts;
    const Vec2 corners[] = {{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}};
    const Vec2 normals[] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    for (int i = 0; i < 4; ++i) {
        parts.edges.push_back({corners[i], corners[(i + 1) % 4]});
        parts.faces.push_back({normals[i], {corners[i], corners[(i + 1) % 4]}});
    }
    return parts;
}

test::Rounded<3> box_parts(const Vec3& h) {
    test::Rounded<3> parts;
    for (int axis = 0; axis < 3; ++axis) {
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        const auto at = [&](double i_side, double j_side, double k_side) {
            Vec3 p;
            p[axis] = i_side * h[axis];
            p[j] = j_side * h[j];
            p[k] = k_side * h[k];
            return p;
        };
        for (const double side : {-1.0, 1.0}) {
            for (const double other : {-1.0, 1.0})
                parts.edges.push_back({at(-1, side, other), at(1, side, other)});
            Vec3 normal{};
            normal[axis] = side;
            std::vector<Vec3> loop{at(side, -1, -1), at(side, 1, -1), at(side, 1, 1), at(side, -1, 1)};
            if (side < 0) std::ranges::reverse(loop);
            parts.faces.push_back({normal, loop});
        }
    }
    return parts;
}

template <int D>
Sample<D> random_box(Random& random, bool is_rounded) {
    Box<D> box;
    double smallest = 10;
    for (int i = 0; i < D; ++i) {
        box.size[i] = random.between(0.5, 2);
        smallest = std::min(smallest, box.size[i]);
    }
    if (is_rounded) box.rounding = random.between(0.1, 0.4) * smallest;
    Vec<D> half = 0.5 * box.size;
    for (int i = 0; i < D; ++i) half[i] -= box.rounding;
    test::Rounded<D> parts = box_parts(half);
    parts.radius = box.rounding;
    const Vec<D> o = 0.2 * half;
    return {box, o, [=](const Vec<D>& u) { return parts.leaves(o, u); }};
}

template <int D>
Sample<D> random_hull(Random& random, bool is_rounded) {
    Hull<D> hull;
    const int count = 6 + random.below(10);
    for (int i = 0; i < count; ++i) hull.points.push_back(random.in_cube<D>(1) + Vec<D>{0.5, 2});
    if (is_rounded) hull.rounding = random.between(0.05, 2);
    detail::Polytope<D> core;
    if constexpr (D == 2) {
        core = detail::convex_polygon(hull.points);
    } else {
        core = detail::convex_polyhedron(hull.points);
    }
    const test::Rounded<D> parts = test::rounded(core, hull.rounding);
    Vec<D> o{};
    for (const Vec<D>& vertex : core.vertices) o += vertex / static_cast<double>(core.vertices.size());
    return {hull, o, [=](const Vec<D>& u) { return parts.leaves(o, u); }};
}

Sample<3> random_cylinder(Random& random) {
    const Cylinder cylinder{random.between(0.3, 1), random.between(0.5, 2)};
    const Vec3 o = 0.2 * random.in_cube<3>(cylinder.radius);
    return {cylinder, o, [=](const Vec3& u) {
                const double side = test::leaves_ball<2>({o.x, o.z}, {u.x, u.z}, {}, cylinder.radius);
                const double cap = (std::copysign(0.5 * cylinder.height, u.y) - o.y) / u.y;
                return side > 0 ? std::min(side, cap) : cap;
            }};
}

Sample<3> random_cone(Random& random) {
    const Cone cone{random.between(0.3, 1), random.between(0.5, 2)};
    const Vec3 o{0.1 * cone.radius, -0.2 * cone.height, -0.1 * cone.radius};
    return {cone, o, [=](const Vec3& u) {
                // By bisection of what is inside: below the side and above the base.
                const auto inside = [&](double t) {
                    const Vec3 p = o + t * u;
                    return p.y >= -0.5 * cone.height &&
                           std::sqrt(p.x * p.x + p.z * p.z) <= cone.radius * (0.5 - p.y / cone.height);
                };
                double low = 0, high = 4;
                while (high - low > 1e-9) (inside(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
                return low;
            }};
}

template <int D>
void expect_close(const MassProperties<D>& result, const MassProperties<D>& expected, double size,
                  double tolerance) {
    EXPECT_NEAR(result.mass / expected.mass, 1, tolerance);
    EXPECT_LE(length(result.center - expected.center), tolerance * size);
    const double scale = expected.mass * size * size;
    if constexpr (D == 2) {
        EXPECT_NEAR(result.inertia / scale, expected.inertia / scale, tolerance);
    } else {
        const auto error = result.inertia - expected.inertia;
        for (const double entry : {error.xx, error.yy, error.zz, error.xy, error.xz, error.yz}) {
            EXPECT_NEAR(entry / scale, 0, tolerance);
        }
    }
}

template <int D>
MassProperties<D> quadrature(const ShapeDefinition<D>& shape, const Sample<D>& sample, double& size) {
    const Vec<D> inside = rotate(shape.rotation, sample.inside) + shape.center;
    size = 0;
    MassProperties<D> result = test::by_rays(
        inside,
        [&](const Vec<D>& u) {
            const double r = sample.exit(unrotate(shape.rotation, u));
            size = std::max(size, r);
            return r;
        },
        40000);
    result.mass *= shape.material.density;
    result.inertia = result.inertia * shape.material.density;
    return result;
}

/// What the quadrature is off by, at most: more where sharp edges cross the rays.
template <int D>
constexpr double quadrature_error = D == 2 ? 1e-7 : 2e-4;
template <int D>
constexpr double smooth_error = D == 2 ? 1e-8 : 5e-6;

template <int D>
ShapeDefinition<D> placed(Random& random, const Geometry<D>& geometry) {
    ShapeDefinition<D> shape;
    shape.geometry = geometry;
    shape.center = random.in_cube<D>(3);
    shape.rotation = random.rotation<D>();
    shape.material.density = random.between(1, 3000);
    return shape;
}

template <int D, class Make>
void expect_as_by_rays(Make make, double error = quadrature_error<D>) {
    Random random(D);
    for (int k = 0; k < 8; ++k) {
        const Sample<D> sample = make(random);
        const ShapeDefinition<D> shape = placed<D>(random, sample.geometry);
        double size;
        const MassProperties<D> expected = quadrature(shape, sample, size);
        expect_close(mass_properties(shape), expected, size, error);
        EXPECT_NEAR(measure<D>(sample.geometry) * shape.material.density / expected.mass, 1, error);
    }
}

TEST(Mass, Ball) {
    expect_as_by_rays<2>([](Random& random) { return random_ball<2>(random); }, smooth_error<2>);
    expect_as_by_rays<3>([](Random& random) { return random_ball<3>(random); }, smooth_error<3>);
}
TEST(Mass, Box) {
    expect_as_by_rays<2>([](Random& random) { return random_box<2>(random, false); });
    expect_as_by_rays<3>([](Random& random) { return random_box<3>(random, false); });
}
TEST(Mass, RoundedBox) {
    expect_as_by_rays<2>([](Random& random) { return random_box<2>(random, true); }, smooth_error<2>);
    expect_as_by_rays<3>([](Random& random) { return random_box<3>(random, true); }, smooth_error<3>);
}
TEST(Mass, Capsule) {
    expect_as_by_rays<2>([](Random& random) { return random_capsule<2>(random); }, smooth_error<2>);
    expect_as_by_rays<3>([](Random& random) { return random_capsule<3>(random); }, smooth_error<3>);
}
TEST(Mass, Hull) {
    expect_as_by_rays<2>([](Random& random) { return random_hull<2>(random, false); });
    expect_as_by_rays<3>([](Random& random) { return random_hull<3>(random, false); });
}
TEST(Mass, RoundedHull) {
    expect_as_by_rays<2>([](Random& random) { return random_hull<2>(random, true); }, smooth_error<2>);
    expect_as_by_rays<3>([](Random& random) { return random_hull<3>(random, true); }, smooth_error<3>);
}
TEST(Mass, Cylinder) { expect_as_by_rays<3>(random_cylinder); }
TEST(Mass, Cone) { expect_as_by_rays<3>(random_cone); }

/// Disjoint parts on one body: the sums over all of space, by quadrature, about the origin.
template <int D>
void expect_compound() {
    Random random(10 + D);
    for (int k = 0; k < 5; ++k) {
        std::vector<MassProperties<D>> parts, expected;
        double size;
        for (const Vec<D> offset : {Vec<D>{-4, 1}, Vec<D>{5, 2}, Vec<D>{1, -6}}) {
            const Sample<D> sample = k % 2 == 0 ? random_hull<D>(random, true) : random_capsule<D>(random);
            ShapeDefinition<D> shape = placed<D>(random, sample.geometry);
            shape.center = offset;
            parts.push_back(mass_properties(shape));
            expected.push_back(quadrature(shape, sample, size));
        }
        MassProperties<D> sum;
        Vec<D> moment{};
        for (const auto& part : expected) {
            sum.mass += part.mass;
            moment += part.mass * part.center;
        }
        sum.center = moment / sum.mass;
        for (const auto& part : expected) {
            const Vec<D> d = part.center - sum.center;
            sum.inertia = sum.inertia + part.inertia;
            if constexpr (D == 2) {
                sum.inertia += part.mass * (d.x * d.x + d.y * d.y);
            } else {
                const Vec3 s{d.x * d.x, d.y * d.y, d.z * d.z};
                sum.inertia = sum.inertia + Symmetric3<double>{s.y + s.z,  s.z + s.x,  s.x + s.y,
                                                               -d.x * d.y, -d.x * d.z, -d.y * d.z} *
                                                part.mass;
            }
        }
        expect_close(combine<D>(parts), sum, 8, quadrature_error<D>);
    }
}

TEST(Mass, Compound) {
    expect_compound<2>();
    expect_compound<3>();
}

TEST(Mass, ABoxInPiecesIsTheBox) {
    // Exact, so that it would show the least error in the parallel-axis theorem.
    Random random(20);
    for (int k = 0; k < 20; ++k) {
        ShapeDefinition3 whole;
        whole.geometry = Box3{{2, 1, 3}};
        whole.rotation = random.rotation<3>();
        whole.center = random.in_cube<3>(5);
        std::vector<MassProperties3> parts;
        const double cut = random.between(-0.9, 0.9);
        for (const auto& [low, high] : {std::pair(-1.0, cut), std::pair(cut, 1.0)}) {
            ShapeDefinition3 part = whole;
            part.geometry = Box3{{high - low, 1, 3}};
            part.center = whole.center + rotate(whole.rotation, Vec3{0.5 * (low + high), 0, 0});
            parts.push_back(mass_properties(part));
        }
        expect_close(combine<3>(parts), mass_properties(whole), 1, 1e-13);
    }
}

template <int D>
MassProperties<D> of(const Geometry<D>& geometry) {
    ShapeDefinition<D> shape;
    shape.geometry = geometry;
    shape.material.density = 1;
    return mass_properties(shape);
}

constexpr double pi = std::numbers::pi;

TEST(Mass, ValuesFromBooks2) {
    EXPECT_DOUBLE_EQ(of<2>(Ball{2}).mass, 4 * pi);
    EXPECT_DOUBLE_EQ(of<2>(Ball{2}).inertia, 4 * pi * 4 / 2);
    EXPECT_EQ(of<2>(Box2{{1, 1}}).mass, 1);
    EXPECT_DOUBLE_EQ(of<2>(Box2{{2, 3}}).inertia, 6 * (4 + 9) / 12.0);
    // An equilateral triangle of side s: m s²/12.
    const auto triangle = of<2>(Hull2{{{0, 0}, {2, 0}, {1, std::sqrt(3)}}});
    EXPECT_DOUBLE_EQ(triangle.mass, std::sqrt(3));
    EXPECT_NEAR(triangle.inertia, std::sqrt(3) * 4 / 12, 1e-15);
    EXPECT_NEAR(triangle.center.y, 1 / std::sqrt(3), 1e-15);
    EXPECT_DOUBLE_EQ(of<2>(Capsule2{{-1, 0}, {1, 0}, 0.5}).mass, 2 + pi / 4);
}

TEST(Mass, ValuesFromBooks3) {
    EXPECT_DOUBLE_EQ(of<3>(Ball{2}).mass, 32 * pi / 3);
    EXPECT_DOUBLE_EQ(of<3>(Ball{2}).inertia.yy, 32 * pi / 3 * 4 * 2 / 5);
    EXPECT_EQ(of<3>(Box3{{1, 1, 1}}).mass, 1);
    EXPECT_DOUBLE_EQ(of<3>(Box3{{1, 2, 3}}).inertia.xx, 6 * (4 + 9) / 12.0);
    EXPECT_DOUBLE_EQ(of<3>(Box3{{1, 2, 3}}).inertia.zz, 6 * (4 + 1) / 12.0);
    EXPECT_EQ(of<3>(Box3{{1, 2, 3}}).inertia.xy, 0);
    const auto cylinder = of<3>(Cylinder{2, 3});
    EXPECT_DOUBLE_EQ(cylinder.mass, 12 * pi);
    EXPECT_DOUBLE_EQ(cylinder.inertia.yy, 12 * pi * 4 / 2);
    EXPECT_DOUBLE_EQ(cylinder.inertia.xx, 12 * pi * (3 * 4 + 9) / 12);
    const auto cone = of<3>(Cone{2, 4});
    EXPECT_DOUBLE_EQ(cone.mass, 16 * pi / 3);
    EXPECT_DOUBLE_EQ(cone.center.y, -1);
    EXPECT_DOUBLE_EQ(cone.inertia.yy, 16 * pi / 3 * 4 * 3 / 10);
    EXPECT_DOUBLE_EQ(cone.inertia.zz, 16 * pi / 3 * (3 * 4 / 20.0 + 3 * 16 / 80.0));
    // The tetrahedron of the axes: its products of inertia are not zero.
    const auto corner = of<3>(Hull3{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    EXPECT_DOUBLE_EQ(corner.mass, 1 / 6.0);
    EXPECT_DOUBLE_EQ(corner.center.x, 0.25);
    EXPECT_DOUBLE_EQ(corner.inertia.xx, 2 * (1 / 60.0 - 1 / 96.0));
    EXPECT_DOUBLE_EQ(corner.inertia.xy, -(1 / 120.0 - 1 / 96.0));
    // Steiner's formula for the volume of a rounded cube: V + r A + π r² (sum of edges)/4 + 4/3 π r³.
    const Hull3 cube{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
                     0.5};
    EXPECT_NEAR(measure<3>(cube), 1 + 0.5 * 6 + pi * 0.25 * 3 + 4 * pi / 3 * 0.125, 2e-14);
}

/// The general formula for rounded polytopes, and that for boxes, capsules and balls.
template <int D>
void expect_that_rounded_boxes_agree() {
    Random random(30 + D);
    for (int k = 0; k < 50; ++k) {
        Vec<D> half;
        for (int i = 0; i < D; ++i) half[i] = random.between(0.1, 2);
        const double rounding = random.between(0, 1);
        Hull<D> hull;
        hull.rounding = rounding;
        for (int corner = 0; corner < 1 << D; ++corner) {
            Vec<D> p = half;
            for (int i = 0; i < D; ++i) p[i] *= corner >> i & 1 ? 1 : -1;
            hull.points.push_back(p);
        }
        Box<D> box{2 * half, rounding};
        for (int i = 0; i < D; ++i) box.size[i] += 2 * rounding;
        ShapeDefinition<D> shape = placed<D>(random, hull);
        const auto by_hull = mass_properties(shape);
        shape.geometry = box;
        expect_close(by_hull, mass_properties(shape), 1, 2e-13);
    }
}

TEST(Mass, RoundedBoxIsTheRoundedHullOfItsCorners) {
    expect_that_rounded_boxes_agree<2>();
    expect_that_rounded_boxes_agree<3>();
}

template <int D>
void expect_that_a_round_box_is_a_capsule() {
    Random random(40 + D);
    Box<D> box{{3, 1}, 0.5};
    Capsule<D> capsule{{-1, 0}, {1, 0}, 0.5};
    if constexpr (D == 3) box.size.z = 1;
    ShapeDefinition<D> shape = placed<D>(random, box);
    const auto by_box = mass_properties(shape);
    shape.geometry = capsule;
    expect_close(by_box, mass_properties(shape), 1, 1e-13);
    capsule.to = capsule.from;
    expect_close(
        of<D>(capsule),
        [&] {
            auto ball = of<D>(Ball{0.5});
            ball.center = capsule.from;
            return ball;
        }(),
        1, 1e-15);
}

TEST(Mass, ARoundBoxIsACapsuleAndAShortCapsuleABall) {
    expect_that_a_round_box_is_a_capsule<2>();
    expect_that_a_round_box_is_a_capsule<3>();
}

TEST(Mass, FarFromTheOriginNothingIsLost) {
    Random random(50);
    for (int k = 0; k < 10; ++k) {
        const auto sample = random_hull<3>(random, true);
        ShapeDefinition3 shape;
        shape.geometry = sample.geometry;
        const auto here = mass_properties(shape);
        shape.center = {1e6, -1e6, 1e6};
        const auto there = mass_properties(shape);
        expect_close(there, {here.mass, here.center + shape.center, here.inertia}, 1, 1e-8);
    }
}

TEST(Mass, OfPlanesAndOfNothing) {
    EXPECT_EQ(of<2>(Plane2{{0, 1}}).mass, 0);
    EXPECT_EQ(of<3>(Plane3{{0, 1, 0}}).inertia, Symmetric3<double>{});
    EXPECT_EQ(measure<3>(Plane3{{0, 1, 0}, 5}), 0);
    EXPECT_EQ(combine<2>({}).mass, 0);
    const MassProperties3 weightless[2] = {};
    EXPECT_EQ(combine<3>(weightless).center, Vec3{});
    ShapeDefinition2 shape;
    shape.geometry = Ball{1};
    shape.center = {3, 4};
    shape.material.density = 0;
    EXPECT_EQ(mass_properties(shape).mass, 0);
    EXPECT_EQ(mass_properties(shape).center, (Vec2{3, 4}));
    EXPECT_EQ(mass_properties(shape).inertia, 0);
}

TEST(Mass, RefusesWhatCannotExist) {
    EXPECT_THROW(measure<2>(Ball{-1}), Error);
    EXPECT_THROW(measure<3>(Hull3{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}), Error);
    const MassProperties2 negative[] = {{-1, {}, 1}};
    EXPECT_THROW(combine<2>(negative), Error);
    const MassProperties2 endless[] = {{1, {}, std::numeric_limits<double>::infinity()}};
    EXPECT_THROW(combine<2>(endless), Error);
}

}  // namespace
}  // namespace carom
