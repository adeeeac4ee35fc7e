#include "collision/gjk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "random.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// A shape of any kind but a plane, `size` large and up to `flatness` times thinner, anywhere on its body.
template <int D>
Shape<D> random_shape(Random& random, double size, double flatness) {
    ShapeDefinition<D> shape;
    const auto extent = [&] { return size * std::pow(flatness, -random.unit()); };
    switch (random.below(D == 2 ? 4 : 6)) {
        case 0:
            shape.geometry = Ball{extent()};
            break;
        case 1:
            shape.geometry = Capsule<D>{random.in_cube<D>(size), random.in_cube<D>(size), extent()};
            break;
        case 2: {
            Box<D> box;
            for (int i = 0; i < D; ++i) box.size[i] = extent();
            shape.geometry = box;
            break;
        }
        case 3: {
            Hull<D> hull;
            const int count = D + 2 + random.below(20);
            Vec<D> scale;
            for (int i = 0; i < D; ++i)
                scale[i] = std::max(extent(), 0.01 * size);  // flatter ones are refused
            for (int i = 0; i < count; ++i) {
                hull.points.push_back(random.in_cube<D>(1));
                for (int k = 0; k < D; ++k) hull.points.back()[k] *= scale[k];
            }
            shape.geometry = hull;
            break;
        }
        default:
            if constexpr (D == 3) {
                if (random.below(2))
                    shape.geometry = Cylinder{extent(), extent()};
                else
                    shape.geometry = Cone{extent(), extent()};
            }
    }
    shape.center = random.in_cube<D>(size);
    shape.rotation = random.rotation<D>();
    return make_shape(shape);
}

/// Nothing of the core lies beyond the point along any direction.
template <int D>
void expect_inside(const Shape<D>& shape, const Transform<D>& placed, const Vec<D>& point, double tolerance,
                   Random& random) {
    const Vec<D> local = apply_inverse(placed, point);
    for (int i = 0; i < 20; ++i) {
        const Vec<D> u = random.direction<D>();
        ASSERT_LE(dot(u, local), dot(u, core_support(shape, u)) + tolerance);
    }
}

/// Holds the result against what proves it: points of both cores that are no further apart, and a direction
/// along which the cores are no closer; or a simplex of points of the difference around the origin.
template <int D>
void expect_proven(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, double size,
                   Random& random) {
    const CoreDistance<D> found = core_distance(a, b, b_in_a);
    // Polytopes are solved in finitely many steps; for round shapes the search ends in ever smaller ones.
    const bool round = a.kind >= ShapeKind::cylinder || b.kind >= ShapeKind::cylinder;
    const double exact = (round ? 1e-10 : 1e-13) * size;
    ASSERT_GE(found.count, 1);
    ASSERT_LE(found.count, D + 1);
    expect_inside(a, {}, found.on_a, exact, random);
    expect_inside(b, b_in_a, found.on_b, exact, random);
    if (found.overlap) {
        ASSERT_EQ(found.distance, 0);
        ASSERT_NEAR(length(found.on_b - found.on_a), 0, exact);
        for (int i = 0; i < 50; ++i) {
            const Vec<D> u = random.direction<D>();
            ASSERT_GE(dot(u, difference_support(a, b, b_in_a, u).difference), -exact);
        }
    } else {
        ASSERT_NEAR(length(found.axis), 1, 1e-14);
        ASSERT_NEAR(length(found.on_b - found.on_a - found.distance * found.axis), 0, exact);
        const double gap = -dot(found.axis, difference_support(a, b, b_in_a, found.axis).difference);
        ASSERT_NEAR(gap, found.distance, exact);
    }
}

template <class T>
class GjkTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(GjkTest, Dimensions);

TYPED_TEST(GjkTest, proves_its_answers) {
    constexpr int D = TypeParam::value;
    Random random(1);
    int overlaps = 0;
    for (int i = 0; i < 15000; ++i) {
        const double size = i % 2 ? 1 : std::pow(10, random.between(-4, 3));
        const double ratio = i % 3 ? 1 : random.between(1, 1000);
        const double flatness = i % 5 ? 3 : 1e4;
        const Shape<D> a = random_shape<D>(random, size, flatness),
                       b = random_shape<D>(random, size * ratio, flatness);
        const Transform<D> b_in_a = random.placement<D>(size * (i % 2 ? 1 : ratio));
        SCOPED_TRACE(testing::Message() << "case " << i << ", kinds " << int(a.kind) << ", " << int(b.kind));
        expect_proven(a, b, b_in_a, size * ratio, random);
        overlaps += core_distance(a, b, b_in_a).overlap;
        if (this->HasFatalFailure()) return;
    }
    EXPECT_GT(overlaps, 700);
}

TYPED_TEST(GjkTest, touching_and_nearly_touching) {
    constexpr int D = TypeParam::value;
    Random random(2);
    for (int i = 0; i < 5000; ++i) {
        const Shape<D> a = random_shape<D>(random, 1, 10), b = random_shape<D>(random, 1, 10);
        Transform<D> b_in_a = random.placement<D>(1);
        const Vec<D> u = random.direction<D>();
        // Moved along u until the furthest points along it meet but for `gap`.
        const double gap = (random.below(3) - 1) * std::pow(10, random.between(-14, -3));
        b_in_a.position += (dot(u, difference_support(a, b, b_in_a, u).difference) + gap) * u;
        SCOPED_TRACE(testing::Message() << "case " << i << ", kinds " << int(a.kind) << ", " << int(b.kind));
        expect_proven(a, b, b_in_a, 1, random);
        const CoreDistance<D> found = core_distance(a, b, b_in_a);
        if (gap > 1e-12) {
            ASSERT_GE(found.distance, 0.9 * gap);
        }
        if (this->HasFatalFailure()) return;
    }
}

TYPED_TEST(GjkTest, parallel_faces_at_every_gap) {
    constexpr int D = TypeParam::value;
    Box<D> unit;
    for (int i = 0; i < D; ++i) unit.size[i] = 1;
    const Shape<D> box = make_shape<D>({.geometry = unit});
    for (const double gap : {1.0, 1e-3, 1e-6, 1e-9, 1e-11}) {
        for (const double aside : {0.0, 0.3, 1e-7, -0.99, -1.0}) {
            for (int axis = 0; axis < D; ++axis) {
                Transform<D> placed;
                placed.position[axis] = 1 + gap;
                placed.position[(axis + 1) % D] = aside;
                const CoreDistance<D> found = core_distance(box, box, placed);
                EXPECT_FALSE(found.overlap);
                EXPECT_NEAR(found.distance, gap, 1e-15);
                EXPECT_NEAR(found.axis[axis], 1, 1e-9);
                placed.position[axis] = 1 - gap;
                if (std::fabs(aside) < 1) {
                    EXPECT_TRUE(core_distance(box, box, placed).overlap);
                }
            }
        }
    }
    EXPECT_TRUE(core_distance(box, box, Transform<D>{}).overlap);
}

TEST(Gjk, known_distances) {
    const auto cylinder = make_shape<3>({.geometry = Cylinder{0.5, 2}});
    const auto cone = make_shape<3>({.geometry = Cone{0.5, 2}});
    const auto ball = make_shape<3>({.geometry = Ball{7}});  // its core is a point
    const auto distance = [](const Shape<3>& a, const Shape<3>& b, const Vec3& at) {
        return core_distance(a, b, {at, {}}).distance;
    };
    EXPECT_NEAR(distance(cylinder, ball, {3, 0.7, 4}), 4.5, 1e-12);
    EXPECT_NEAR(distance(cylinder, ball, {0.3, 2, 0}), 1, 1e-12);
    EXPECT_NEAR(distance(cylinder, ball, {3.5, 5, 0}), 5, 1e-12);
    EXPECT_NEAR(distance(cylinder, cylinder, {0, 2.5, 0}), 0.5, 1e-12);
    EXPECT_NEAR(distance(cylinder, cylinder, {3, 1, 4}), 4, 1e-12);
    EXPECT_NEAR(distance(cone, ball, {0, 3, 0}), 2, 1e-12);
    EXPECT_NEAR(distance(cone, cone, {1, 0, 0}), 0, 1e-12);
    // The flank of the cone: x / 0.5 + (y + 1) / 2 = 1, z = 0.
    EXPECT_NEAR(distance(cone, ball, {2, 0.2, 0}), (2 / 0.5 + 1.2 / 2 - 1) / std::sqrt(4 + 0.25), 1e-12);
}

}  // namespace
}  // namespace carom::detail
