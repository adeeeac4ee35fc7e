#include <gtest/gtest.h>

#include <tuple>

#include "brute_2.hpp"
#include "carom/collide.hpp"

namespace carom {
namespace {

using namespace test;

struct Case {
    ShapeDefinition2 a, b;
    Transform2 a_placed, b_placed;

    Manifold<2> collide(double reach) const { return carom::collide<2>(a, a_placed, b, b_placed, reach); }
    Separation<2> separation() const { return *carom::separation<2>(a, a_placed, b, b_placed); }
    bool overlap() const { return carom::overlap<2>(a, a_placed, b, b_placed); }
    Case exchanged() const { return {b, a, b_placed, a_placed}; }
    Case moved(const Transform2& t) const { return {a, b, t * a_placed, t * b_placed}; }
};

/// Calls `check(case, size)` for every pair of kinds, at sizes from millimetres to hundreds of metres.
template <class Check>
void for_random_cases(std::uint64_t seed, int per_pair, Check&& check) {
    Random random(seed);
    for (const Kind a : round_kinds) {
        for (const Kind b : round_kinds) {
            for (int i = 0; i < per_pair; ++i) {
                const double scale = i % 4 ? 1 : std::pow(10.0, random.between(-2, 2));
                const double ratio = i % 3 ? 1 : random.between(1, 20);
                const Case c{random_shape(a, random, scale), random_shape(b, random, scale * ratio),
                             random.placement<2>(1.5 * scale), random.placement<2>(1.5 * scale * ratio)};
                SCOPED_TRACE(testing::Message() << "kinds " << int(a) << ", " << int(b) << ", case " << i);
                check(c, scale * ratio);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

/// What a manifold must be, wherever the shapes are.
void expect_sound(const Case& c, double reach, double size) {
    const Cloud a(c.a, c.a_placed), b(c.b, c.b_placed);
    const double distance = signed_distance(a, b), exact = 1e-11 * size;
    const Manifold<2> m = c.collide(reach);
    if (distance > reach + exact) {
        ASSERT_EQ(m.count, 0);
        return;
    }
    if (distance > reach - exact && m.count == 0) return;
    ASSERT_GE(m.count, 1);
    ASSERT_LE(m.count, 2);
    ASSERT_NEAR(length(m.normal), 1, 1e-12);
    for (int i = 0; i < m.count; ++i) {
        const auto& point = m.points[i];
        ASSERT_LE(point.separation, reach + exact);
        ASSERT_TRUE(std::isfinite(point.position.x) && std::isfinite(point.position.y));
        // The two surfaces are half the separation away to both sides. An edge that is inclined to the normal
        // and rounded is there a little further out.
        const double at_a = signed_distance(a, point.position - 0.5 * point.separation * m.normal);
        const double at_b = signed_distance(b, point.position + 0.5 * point.separation * m.normal);
        ASSERT_NEAR(std::max(at_a, at_b), 0, exact);
        ASSERT_LE(std::min(at_a, at_b), exact);
        ASSERT_GE(std::min(at_a, at_b), -std::max(a.radius, b.radius) - exact);
        if (a.radius + b.radius == 0) {
            ASSERT_NEAR(std::min(at_a, at_b), 0, exact);
        }
    }
    const double cores = distance + a.radius + b.radius;
    if (m.count == 1) {
        ASSERT_NEAR(m.points[0].separation, distance, exact);
        ASSERT_NEAR(gap_along(a, b, m.normal), distance, exact);
    } else {
        ASSERT_NE(m.points[0].feature, m.points[1].feature);
        // No direction is better by more than what keeps the choice of edge steady, and the directions of
        // parallel edges differ by 11° at most.
        const double lowest = std::min(m.points[0].separation, m.points[1].separation);
        ASSERT_GE(gap_along(a, b, m.normal), distance - std::max(0.0, 0.02 * cores) - 4e-4 * size);
        ASSERT_NEAR(lowest, distance, std::max(0.0, 0.05 * cores) + 4e-4 * size);
    }
}

TEST(Pairs2, distance_and_axis_agree_with_brute_force) {
    int apart = 0, together = 0;
    for_random_cases(1, 500, [&](const Case& c, double size) {
        const Cloud a(c.a, c.a_placed), b(c.b, c.b_placed);
        const double expected = signed_distance(a, b);
        const Separation<2> found = c.separation();
        ASSERT_NEAR(found.distance, expected, 1e-12 * size);
        ASSERT_NEAR(length(found.axis), 1, 1e-12);
        ASSERT_NEAR(gap_along(a, b, found.axis), expected, 1e-11 * size);
        ASSERT_EQ(c.overlap(), found.distance <= 0);
        ++(expected > 0 ? apart : together);
    });
    EXPECT_GT(apart, 1000);
    EXPECT_GT(together, 1000);
}

TEST(Pairs2, manifolds_lie_midway_between_the_surfaces) {
    int doubles = 0, singles = 0;
    for_random_cases(2, 400, [&](const Case& c, double size) {
        for (const double reach : {0.0, 0.02 * size, 2 * size}) {
            expect_sound(c, reach, size);
            const int count = c.collide(reach).count;
            doubles += count == 2;
            singles += count == 1;
        }
    });
    EXPECT_GT(doubles, 1000);
    EXPECT_GT(singles, 1000);
}

TEST(Pairs2, exact_coincidences_are_sound) {
    Random random(3);
    for (const Kind kind_a : round_kinds) {
        for (const Kind kind_b : round_kinds) {
            for (int i = 0; i < 1500; ++i) {
                const Vec2 shift{0.5 * (random.below(9) - 4), 0.5 * (random.below(9) - 4)};
                const Case c{grid_shape(kind_a, random),
                             grid_shape(kind_b, random),
                             {{}, right_angle(random)},
                             {shift, right_angle(random)}};
                SCOPED_TRACE(testing::Message()
                             << "kinds " << int(kind_a) << ", " << int(kind_b) << ", case " << i);
                const Cloud a(c.a, c.a_placed), b(c.b, c.b_placed);
                const double expected = signed_distance(a, b);
                const Separation<2> found = c.separation();
                ASSERT_NEAR(found.distance, expected, 1e-14);
                ASSERT_NEAR(gap_along(a, b, found.axis), expected, 1e-14);
                if (std::fabs(expected) > 1e-14) {
                    ASSERT_EQ(c.overlap(), expected < 0);
                }
                for (const double reach : {0.0, 0.3}) {
                    expect_sound(c, reach, 1);
                    if (HasFatalFailure()) return;
                }
            }
        }
    }
}

TEST(Pairs2, exchanging_the_shapes_turns_the_normal_round) {
    for_random_cases(4, 200, [](const Case& c, double size) {
        const Separation<2> there = c.separation(), back = c.exchanged().separation();
        ASSERT_NEAR(there.distance, back.distance, 1e-12 * size);
        ASSERT_NEAR(length(there.axis + back.axis), 0, 1e-9);

        const Manifold<2> m = c.collide(0.1 * size), w = c.exchanged().collide(0.1 * size);
        const bool same_kind = c.a.geometry.index() == c.b.geometry.index();
        ASSERT_EQ(m.count, w.count);
        if (m.count) {
            ASSERT_NEAR(length(m.normal + w.normal), 0, 1e-9);
        }
        for (int i = 0; i < m.count; ++i) {
            const std::uint32_t f = m.points[i].feature;
            const std::uint32_t other_name = same_kind ? f << 16 | f >> 16 : f;
            const auto& point = w.points[w.points[0].feature == other_name ? 0 : 1];
            ASSERT_EQ(point.feature, other_name);
            ASSERT_NEAR(point.separation, m.points[i].separation, 1e-11 * size);
            ASSERT_NEAR(length(point.position - m.points[i].position), 0, 1e-9 * size);
        }
    });
}

TEST(Pairs2, moving_both_moves_the_manifold) {
    Random random(5);
    for_random_cases(6, 200, [&](const Case& c, double size) {
        const Transform2 t = random.placement<2>(10 * size);
        const Manifold<2> m = c.collide(0.1 * size), w = c.moved(t).collide(0.1 * size);
        ASSERT_EQ(m.count, w.count);
        if (m.count) {
            ASSERT_NEAR(length(rotate(t.rotation, m.normal) - w.normal), 0, 1e-9);
        }
        for (int i = 0; i < m.count; ++i) {
            ASSERT_EQ(w.points[i].feature, m.points[i].feature);
            ASSERT_NEAR(w.points[i].separation, m.points[i].separation, 1e-11 * size);
            ASSERT_NEAR(length(w.points[i].position - apply(t, m.points[i].position)), 0, 1e-9 * size);
        }
    });
}

TEST(Pairs2, far_away_is_bit_by_bit_as_at_the_origin) {
    for_random_cases(7, 100, [](const Case& random_case, double) {
        Case c = random_case;
        // Multiples of 2⁻²⁰ keep their bits at 1e7.
        for (Transform2* placed : {&c.a_placed, &c.b_placed})
            for (int i = 0; i < 2; ++i)
                placed->position[i] = std::round(placed->position[i] * 0x1p20) * 0x1p-20;
        const Vec2 far{1e7, -1e7};
        const Case there{c.a,
                         c.b,
                         {c.a_placed.position + far, c.a_placed.rotation},
                         {c.b_placed.position + far, c.b_placed.rotation}};
        const Separation<2> s = c.separation(), t = there.separation();
        ASSERT_EQ(s.distance, t.distance);
        ASSERT_EQ(s.axis, t.axis);
        const Manifold<2> m = c.collide(0.1), w = there.collide(0.1);
        ASSERT_EQ(m.count, w.count);
        ASSERT_EQ(m.normal, w.normal);
        for (int i = 0; i < m.count; ++i) {
            ASSERT_EQ(m.points[i].separation, w.points[i].separation);
            ASSERT_NEAR(length(m.points[i].position + far - w.points[i].position), 0, 1e-8);
        }
    });
}

Transform2 mirrored(const Transform2& t) {
    return {{-t.position.x, t.position.y}, {t.rotation.c, -t.rotation.s}};
}

ShapeDefinition2 mirrored(ShapeDefinition2 shape) {
    if (auto* capsule = std::get_if<Capsule2>(&shape.geometry)) {
        capsule->from.x *= -1;
        capsule->to.x *= -1;
    } else if (auto* hull = std::get_if<Hull2>(&shape.geometry)) {
        for (Vec2& point : hull->points) point.x *= -1;
    }
    const Transform2 local = mirrored(Transform2{shape.center, shape.rotation});
    shape.center = local.position;
    shape.rotation = local.rotation;
    return shape;
}

TEST(Pairs2, mirror_images_have_mirror_images_of_manifolds) {
    for_random_cases(8, 200, [](const Case& c, double size) {
        const Case image{mirrored(c.a), mirrored(c.b), mirrored(c.a_placed), mirrored(c.b_placed)};
        const Manifold<2> m = c.collide(0.1 * size), w = image.collide(0.1 * size);
        ASSERT_EQ(m.count, w.count);
        if (m.count) {
            ASSERT_NEAR(length(Vec2{-m.normal.x, m.normal.y} - w.normal), 0, 1e-9);
        }
        for (int i = 0; i < m.count; ++i) {
            const Vec2 expected{-m.points[i].position.x, m.points[i].position.y};
            double nearest = size;
            for (int k = 0; k < w.count; ++k)
                nearest = std::min(nearest, length(w.points[k].position - expected) +
                                                std::fabs(w.points[k].separation - m.points[i].separation));
            ASSERT_NEAR(nearest, 0, 1e-9 * size);
        }
    });
}

TEST(Pairs2, planes_meet_all_kinds) {
    Random random(9);
    for (const Kind kind : round_kinds) {
        for (int i = 0; i < 500; ++i) {
            ShapeDefinition2 plane;
            const Vec2 normal = random.direction<2>();
            plane.geometry = Plane2{3 * normal, random.between(-1, 1)};
            plane.center = random.in_cube<2>(1);
            plane.rotation = random.rotation<2>();
            const Case c{random_shape(kind, random, 1), plane, random.placement<2>(2),
                         random.placement<2>(2)};
            const Cloud a(c.a, c.a_placed);
            const Transform2 whole = c.b_placed * Transform2{plane.center, plane.rotation};
            const Vec2 out = rotate(whole.rotation, normal);
            const double offset = std::get<Plane2>(plane.geometry).offset + dot(out, whole.position);
            const double expected = -a.highest(-out) - offset - a.radius;

            const Separation<2> found = c.separation(), back = c.exchanged().separation();
            ASSERT_NEAR(found.distance, expected, 1e-12);
            ASSERT_NEAR(length(found.axis + out), 0, 1e-12);
            ASSERT_NEAR(back.distance, expected, 1e-12);
            ASSERT_NEAR(length(back.axis - out), 0, 1e-12);
            ASSERT_EQ(c.overlap(), found.distance <= 0);

            const double reach = 0.3;
            const Manifold<2> m = c.collide(reach), w = c.exchanged().collide(reach);
            ASSERT_EQ(m.count == 0, expected > reach);
            ASSERT_EQ(w.count, m.count);
            double lowest = reach;
            for (int k = 0; k < m.count; ++k) {
                const auto& point = m.points[k];
                lowest = std::min(lowest, point.separation);
                ASSERT_NEAR(length(m.normal + out), 0, 1e-12);
                ASSERT_NEAR(dot(out, point.position) - offset, 0.5 * point.separation, 1e-12);
                ASSERT_NEAR(signed_distance(a, point.position + 0.5 * point.separation * out), 0,
                            kind == Kind::ball ? 1e-12 : a.radius + 1e-12);
                ASSERT_EQ(w.points[k].feature, point.feature);
                ASSERT_NEAR(length(w.points[k].position - point.position), 0, 1e-12);
            }
            if (m.count) {
                ASSERT_NEAR(lowest, expected, 1e-12);
            }
        }
    }
}

// Configurations in which a stack must not lose a point or its normal.

ShapeDefinition2 box(double width, double height, double rounding = 0) {
    return {.geometry = Box2{{width, height}, rounding}};
}

/// Two points at the ends of what the faces have in common.
void expect_face_contact(const Case& c, double reach, double left, double right) {
    const Manifold<2> m = c.collide(reach);
    ASSERT_EQ(m.count, 2);
    EXPECT_NEAR(m.normal.x, 0, 2e-3);
    EXPECT_NEAR(m.normal.y, 1, 2e-3);
    EXPECT_NEAR(std::min(m.points[0].position.x, m.points[1].position.x), left, 2e-3);
    EXPECT_NEAR(std::max(m.points[0].position.x, m.points[1].position.x), right, 2e-3);
}

TEST(Pairs2, resting_boxes_have_two_points) {
    for (const double rounding : {0.0, 0.1}) {
        for (const double gap : {-0.01, -1e-6, 0.0, 1e-6, 0.01}) {
            for (const double tilt : {0.0, 1e-12, -1e-12, 1e-7, -1e-7, 1e-4, -1e-4, 1e-3, -1e-3}) {
                SCOPED_TRACE(testing::Message()
                             << "rounding " << rounding << ", gap " << gap << ", tilt " << tilt);
                const Rotation2 turn = normalized(Rotation2{1, tilt});
                const double end = 0.5 - rounding;
                // The same size, exactly above each other or a little aside; a smaller and a larger one on
                // top.
                for (const double aside : {0.0, 1e-9, 1e-4, -1e-4})
                    expect_face_contact(
                        {box(1, 1, rounding), box(1, 1, rounding), {}, {{aside, 1 + gap}, turn}}, 0.02, -end,
                        end);
                expect_face_contact(
                    {box(1, 1, rounding), box(0.5, 0.5, rounding), {}, {{0.3, 0.75 + gap}, turn}}, 0.02,
                    0.05 + rounding, end);
                expect_face_contact({box(1, 1, rounding), box(8, 0.5, rounding), {}, {{0, 0.75 + gap}, turn}},
                                    0.02, -end, end);
            }
        }
    }
}

TEST(Pairs2, what_is_symmetric_stays_so_to_the_last_bit) {
    const ShapeDefinition2 floor{.geometry = Plane2{{0, 1}, 0.37}};
    const ShapeDefinition2 roof{.geometry = Hull2{{{-0.7, -0.3}, {0.7, -0.3}, {0, 1.1}}, 0.1}};
    const ShapeDefinition2 bar{.geometry = Capsule2{{-0.61, 0}, {0.61, 0}, 0.3}};
    for (const auto& [lower, upper, height] :
         {std::tuple(box(1.3, 0.7), box(0.9, 0.3), 0.49), std::tuple(box(0.9, 0.7, 0.1), box(1.3, 0.3), 0.51),
          std::tuple(floor, box(0.9, 0.3), 0.51), std::tuple(floor, bar, 0.66),
          std::tuple(box(3, 0.7), roof, 0.74), std::tuple(bar, bar, 0.6),
          std::tuple(box(1, 0.7), bar, 0.64)}) {
        const Manifold<2> m = Case{lower, upper, {}, {{0, height}, {}}}.collide(0.02);
        ASSERT_EQ(m.count, 2);
        EXPECT_EQ(m.normal, (Vec2{0, 1}));
        EXPECT_EQ(m.points[0].position.x, -m.points[1].position.x);
        EXPECT_EQ(m.points[0].position.y, m.points[1].position.y);
        EXPECT_EQ(m.points[0].separation, m.points[1].separation);
    }
}

TEST(Pairs2, capsules_at_rest_have_two_points) {
    const ShapeDefinition2 lying{.geometry = Capsule2{{-0.5, 0}, {0.5, 0}, 0.25}};
    const ShapeDefinition2 reversed{.geometry = Capsule2{{0.5, 0}, {-0.5, 0}, 0.25}};
    for (const ShapeDefinition2& upper : {lying, reversed}) {
        expect_face_contact({lying, upper, {}, {{0, 0.5}, {}}}, 0.01, -0.5, 0.5);
        expect_face_contact({lying, upper, {}, {{0.2, 0.499}, {}}}, 0.01, -0.3, 0.5);
        expect_face_contact({box(3, 1), upper, {}, {{0, 0.75}, {}}}, 0.01, -0.5, 0.5);
        // End to end: one point between the two ends.
        const Manifold<2> m = Case{lying, upper, {}, {{1.51, 0}, {}}}.collide(0.1);
        ASSERT_EQ(m.count, 1);
        EXPECT_NEAR(m.normal.x, 1, 1e-12);
        EXPECT_NEAR(m.points[0].separation, 0.01, 1e-12);
        EXPECT_NEAR(m.points[0].position.x, 0.755, 1e-12);
    }
}

TEST(Pairs2, features_outlive_small_motions) {
    // Tilting to and fro changes whose edge is in front, but not the names of the corners nor their order.
    for (const auto& [lower, upper] :
         {std::pair(box(1, 1), box(1, 1)), std::pair(box(1, 1), box(0.5, 1)), std::pair(box(1, 1), box(2, 1)),
          std::pair(box(1, 1, 0.1), box(1, 1, 0.2))}) {
        const auto at = [&](double tilt) {
            return Case{lower, upper, {}, {{0.01, 0.999}, normalized(Rotation2{1, tilt})}}.collide(0.02);
        };
        const Manifold<2> level = at(0);
        ASSERT_EQ(level.count, 2);
        for (const double tilt : {1e-9, -1e-9, 1e-5, -1e-5, 3e-4, -3e-4, 1e-3, -1e-3, 1e-2, -1e-2}) {
            const Manifold<2> m = at(tilt);
            ASSERT_EQ(m.count, 2) << tilt;
            for (int i = 0; i < 2; ++i) {
                EXPECT_EQ(m.points[i].feature, level.points[i].feature) << tilt;
                EXPECT_NEAR(length(m.points[i].position - level.points[i].position), 0,
                            2 * std::fabs(tilt) + 1e-12);
            }
        }
        // Tilted more, one corner is left, with the name that it had.
        for (const double tilt : {0.1, -0.1}) {
            const Manifold<2> m = at(tilt);
            ASSERT_EQ(m.count, 1) << tilt;
            EXPECT_TRUE(m.points[0].feature == level.points[0].feature ||
                        m.points[0].feature == level.points[1].feature);
        }
    }
}

TEST(Pairs2, rounded_corners_meet_along_the_line_between_them) {
    for (const double angle : {0.2, 0.5, 0.8, 1.2}) {
        const Vec2 direction{std::sin(angle), std::cos(angle)};
        const Case c{box(1, 1, 0.1), box(1, 1, 0.1), {}, {Vec2{0.8, 0.8} + 0.19 * direction, {}}};
        const Manifold<2> m = c.collide(0);
        ASSERT_EQ(m.count, 1);
        EXPECT_NEAR(length(m.normal - direction), 0, 1e-12);
        EXPECT_NEAR(m.points[0].separation, -0.01, 1e-12);
        EXPECT_NEAR(length(m.points[0].position - Vec2{0.4, 0.4} - 0.095 * direction), 0, 1e-12);
    }
}

TEST(Pairs2, a_corner_that_just_touches_a_slope_takes_the_slope_s_normal) {
    // The cores meet in one point, so that rounding alone decides whether they are apart.
    const ShapeDefinition2 slope{.geometry = Hull2{{{-1, -0.5}, {0.5, 1.5}, {-1, 1.5}}, 0.25}};
    ShapeDefinition2 block = box(1.5, 2);
    block.center = {0.5, -0.5};
    const Separation<2> found = Case{block, slope, {}, {}}.separation();
    EXPECT_NEAR(found.distance, -0.25, 1e-15);
    EXPECT_NEAR(length(found.axis - Vec2{-0.8, 0.6}), 0, 1e-15);
}

TEST(Pairs2, concentric_balls_part_somewhere) {
    const ShapeDefinition2 ball{.geometry = Ball{0.5}};
    const Manifold<2> m = Case{ball, ball, {}, {}}.collide(0);
    ASSERT_EQ(m.count, 1);
    EXPECT_EQ(length(m.normal), 1);
    EXPECT_EQ(m.points[0].separation, -1);
    const ShapeDefinition2 point{.geometry = Capsule2{{1, 1}, {1, 1}, 0.5}};  // as long as wide
    EXPECT_NEAR((Case{ball, point, {}, {{2, 2}, {}}}.separation().distance), std::sqrt(18.0) - 1, 1e-15);
    EXPECT_NEAR((Case{point, point, {}, {{0, 2}, {}}}.separation().distance), 1, 1e-15);
    EXPECT_EQ((Case{point, point, {}, {{0, 0.9}, {}}}.collide(0).count), 1);
}

}  // namespace
}  // namespace carom
