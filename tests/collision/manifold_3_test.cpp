#include <gtest/gtest.h>

#include <algorithm>

#include "oracle_3.hpp"
#include "scene_3.hpp"

namespace carom::test::space {

namespace {

/// Is the direction one of least depth, or close to it? Where faces are nearly parallel theirs is taken, and
/// where the shapes barely meet several are as good.
bool is_good_normal(const Body3& a, const Body3& b, const Vec3& normal, const Separation<3>& truth,
                    double tolerance) {
    const double cosine = std::fabs(truth.distance) < 0.02 * smaller_size(a, b) ? 0.97 : 0.9975;
    return gap_along(a, b, normal) >= truth.distance - tolerance || dot(normal, truth.axis) > cosine;
}

/// What every manifold must be, whatever the shapes: `reach` is the gap up to which points were asked for.
void expect_sound(const Scene& scene, const Manifold<3>& found, double reach) {
    const auto truth = *separation<3>(scene.a, scene.a_placed, scene.b, scene.b_placed);
    const Body3 a = scene.oracle_a(), b = scene.oracle_b();
    const double size = smaller_size(a, b);
    const double tolerance = 0.11 * std::fabs(truth.distance) + 1e-4 * size;
    ASSERT_LE(found.count, 4);
    if (found.count == 0) {
        EXPECT_GT(truth.distance, reach - 1e-9 * size);
        return;
    }
    EXPECT_LE(truth.distance, reach + 2e-5 * size);
    EXPECT_NEAR(length(found.normal), 1, 1e-9);
    EXPECT_TRUE(is_good_normal(a, b, found.normal, truth, tolerance))
        << gap_along(a, b, found.normal) << " for " << truth.distance;

    double least = 1e300;
    for (int i = 0; i < found.count; ++i)
        least = std::min(least, found.points[static_cast<std::size_t>(i)].separation);
    EXPECT_NEAR(least, truth.distance, tolerance) << "the deepest point is among them";
    for (int i = 0; i < found.count; ++i) {
        const ManifoldPoint<3>& point = found.points[static_cast<std::size_t>(i)];
        EXPECT_LE(point.separation, reach);
        // Only the deepest point is on both surfaces; above the others rounded shapes curve away.
        const double slack = 0.02 * size + (point.separation > least ? 1 : 0.05) * (a.radius() + b.radius());
        const Vec3 half = 0.5 * point.separation * found.normal;
        EXPECT_LE(std::fabs(a.height(point.position - half)), slack) << "on the surface of a";
        EXPECT_LE(std::fabs(b.height(point.position + half)), slack) << "on the surface of b";
        for (int j = 0; j < i; ++j)
            EXPECT_NE(point.feature, found.points[static_cast<std::size_t>(j)].feature) << "features differ";
    }
}

/// Area of the patch: half the cross product of its diagonals, whichever of the pairs of points they are.
double area_of(const Manifold<3>& manifold) {
    const auto at = [&](int i) { return manifold.points[static_cast<std::size_t>(i)].position; };
    if (manifold.count == 3) return 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
    if (manifold.count < 4) return 0;
    return 0.5 *
           std::max({length(cross(at(2) - at(0), at(3) - at(1))), length(cross(at(1) - at(0), at(3) - at(2))),
                     length(cross(at(3) - at(0), at(2) - at(1)))});
}

/// Are the two the same but for rounding, feature by feature? Where features coincide, rounding may choose
/// another of their names, for the points of one such place: two at the most. And where of more than four
/// points one is as good as another, it may choose that, but the area stays about what it was.
void expect_same(const Manifold<3>& expected, const Manifold<3>& found, double tolerance) {
    ASSERT_EQ(found.count, expected.count);
    EXPECT_GT(dot(found.normal, expected.normal), 1 - 1e-5);
    int renamed = 0, replaced = 0;
    for (int i = 0; i < found.count; ++i) {
        const ManifoldPoint<3>& point = found.points[static_cast<std::size_t>(i)];
        const auto end = expected.points.begin() + expected.count;
        const auto there = [&](const ManifoldPoint<3>& other) {
            return length(other.position - point.position) <= tolerance;
        };
        const auto same = std::find_if(expected.points.begin(), end, there);
        if (same == end) {
            ++replaced;
            continue;
        }
        EXPECT_NEAR(same->separation, point.separation, tolerance);
        renamed += std::none_of(expected.points.begin(), end, [&](const ManifoldPoint<3>& other) {
            return there(other) && other.feature == point.feature;
        });
    }
    EXPECT_LE(renamed, found.count > 2 ? 2 : 1);
    EXPECT_LE(replaced, found.count == 4 ? 1 : 0);
    const double share = replaced > 0 ? 0.2 : 0.01;
    EXPECT_NEAR(area_of(found), area_of(expected), share * area_of(expected) + tolerance * tolerance);
}

/// Does the answer hang on a hair: is the gap, or that of a point, the reach; or is the direction open,
/// because corners of the cores meet, or because one shape sticks deep in the other?
bool is_delicate(const Scene& scene, const Manifold<3>& found, double reach, double tolerance) {
    const auto truth = *separation<3>(scene.a, scene.a_placed, scene.b, scene.b_placed);
    const double between_cores = truth.distance + scene.oracle_a().radius() + scene.oracle_b().radius();
    if (found.count == 0 ||
        -truth.distance > 0.05 * std::min(scene.oracle_a().thickness(), scene.oracle_b().thickness()))
        return true;
    bool delicate =
        std::fabs(truth.distance - reach) < tolerance || std::fabs(between_cores) < 10 * tolerance;
    for (int i = 0; i < found.count; ++i)
        delicate =
            delicate || std::fabs(found.points[static_cast<std::size_t>(i)].separation - reach) < tolerance;
    return delicate;
}

/// A contact must not depend on the order of the shapes or on where the world is.
void expect_invariant(const Scene& scene, const Manifold<3>& found, double reach, Random& random) {
    const double size = smaller_size(scene.oracle_a(), scene.oracle_b());
    if (is_delicate(scene, found, reach, 1e-4 * size)) return;
    const double far = random.below(2) ? 0 : 1e6 * size, tolerance = 1e-3 * size;
    const Transform3 motion{random.in_cube<3>(size + far), random.rotation<3>()};
    Manifold<3> expected = found;
    expected.normal = rotate(motion.rotation, found.normal);
    for (ManifoldPoint<3>& point : expected.points) point.position = apply(motion, point.position);
    const Transform3 a = motion * scene.a_placed, b = motion * scene.b_placed;
    {
        SCOPED_TRACE("moved");
        expect_same(expected, collide<3>(scene.a, a, scene.b, b, reach), tolerance);
    }
    if (scene.a.index() == scene.b.index())
        return;  // of two faces that are as good, the first shape's is taken
    SCOPED_TRACE("exchanged");
    expected.normal = -expected.normal;
    expect_same(expected, collide<3>(scene.b, b, scene.a, a, reach), tolerance);
}

class EveryManifold : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(EveryManifold, IsSound) {
    const auto [i, j] = GetParam();
    const auto kind_a = static_cast<Kind>(i), kind_b = static_cast<Kind>(j);
    if (kind_a == Kind::plane && kind_b == Kind::plane) return;
    Random random(static_cast<std::uint64_t>(1000 + 100 * i + j));
    for (int n = 0; n < 150; ++n) {
        const bool aligned = n % 3 == 0;
        Scene scene(kind_a, kind_b, aligned, random);
        scene.bring_to(random);
        SCOPED_TRACE(name_of(kind_a) + " on " + name_of(kind_b) + ", case " + std::to_string(n));
        const Body3 a = scene.oracle_a(), b = scene.oracle_b();
        const double reach = n % 2 ? 0 : 0.05 * smaller_size(a, b);
        const Manifold<3> found = collide<3>(scene.a, scene.a_placed, scene.b, scene.b_placed, reach);
        expect_sound(scene, found, reach);
        if (!aligned) expect_invariant(scene, found, reach, random);
    }
}

INSTANTIATE_TEST_SUITE_P(Space, EveryManifold,
                         testing::Combine(testing::Range(0, kinds), testing::Range(0, kinds)),
                         [](const auto& pair) { return name_of_pair(pair.param); });

}  // namespace

}  // namespace carom::test::space
