#include "solver/remake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "collision/manifold.hpp"
#include "collision/random.hpp"
#include "simd/width.hpp"
#include "solver/apart_store.hpp"
#include "solver/contact_store.hpp"

// Manifolds that lanes make anew, beside those of the routines for one pair.

namespace carom::detail {
namespace {

using test::Random;

constexpr float reach = 0.02f;

/// A ball, capsule, box or hull of up to eight corners, sharp or rounded, away from its body's centre of
/// mass.
ShapeDefinition<2> random_shape(Random& random) {
    ShapeDefinition<2> definition;
    const double size = random.below(4) ? random.between(0.3, 1) : random.between(0.05, 0.2);
    const double rounding = random.below(2) ? 0 : random.between(0.05, 0.2) * size;
    switch (random.below(4)) {
        case 0:
            definition.geometry = Ball{size};
            break;
        case 1:
            definition.geometry = Capsule<2>{{-size, 0}, {size, 0.1 * size}, 0.3 * size};
            break;
        case 2:
            definition.geometry = Box<2>{{2 * size, random.between(0.5, 2) * size}, rounding};
            break;
        default: {
            Hull<2> hull;
            const int corners = 3 + random.below(6);
            for (int i = 0; i < corners; ++i) {
                const auto turn = Rotation2::from_angle(6.28 * (i + random.between(0, 0.8)) / corners);
                hull.points.push_back(size * Vec2{turn.c, turn.s});
            }
            hull.rounding = rounding;
            definition.geometry = hull;
        }
    }
    return definition;
}

/// Two bodies near each other, at a place far from the origin.
struct Pair {
    Shape<2> shape_a, shape_b;
    BodyMass<2> mass_a, mass_b;
    BodyState<2> a, b;

    explicit Pair(Random& random)
        : shape_a(make_shape(random_shape(random))), shape_b(make_shape(random_shape(random))) {
        mass_a.radius = mass_b.radius = 2;
        mass_a.center = random.in_cube<2>(0.3);
        mass_b.center = random.in_cube<2>(0.3);
        a.position = random.in_cube<2>(1e3);
        a.rotation = random.rotation<2>();
        b.rotation = random.below(3) ? random.rotation<2>() : a.rotation;
        b.position = a.position;
        // Apart along some way, then together until there is about as much of a gap as is wanted.
        const Vec2 way = random.direction<2>();
        const double wanted = random.between(-0.05, 0.03);
        double far = 4;
        for (int i = 0; i < 40; ++i) {
            b.position = a.position + far * way;
            const double gap = separate_shapes<2>(shape_a, shape_b, b_in_a())->distance;
            if (std::fabs(gap - wanted) < 1e-3) break;
            far -= 0.9 * (gap - wanted);
        }
    }
    Transform<2> b_in_a() const { return relative(frame(a, mass_a), frame(b, mass_b)); }
    double gap() const { return separate_shapes<2>(shape_a, shape_b, b_in_a())->distance; }
};

/// What becomes of a contact in lanes.
struct Remade {
    bool done = false;
    ContactRecord<2> record;
    ContactCache<2> cache;
};

/// A contact with an impulse at a feature that no pair has.
ContactRecord<2> stranger() {
    ContactRecord<2> record;
    record.count = 1;
    record.points[0].impulse = 7;
    record.points[0].feature = 0xffffff;
    return record;
}

std::vector<Remade> remake_all(const std::vector<Pair>& pairs, int width, const ContactCache<2>& cache,
                               const ContactRecord<2>& record) {
    ContactStore<2> store;
    store.set_passes(passes_of_width<2>(width));
    LaneShapes<2> shapes;
    std::vector<BodyState<2>> states;
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        const Pair& p = pairs[i];
        states.push_back(p.a);
        states.push_back(p.b);
        store.push(i, {1, 2 + i, 2 * i, 2 * i + 1}, 1);
        const Carrying<2> carrying{
            cache, {shapes.find(2 * i, p.shape_a, p.mass_a), shapes.find(2 * i + 1, p.shape_b, p.mass_b)}};
        EXPECT_TRUE(carrying.shapes);
        store.write(i, record, &carrying);
    }
    store.passes().refresh(store.span(), {reinterpret_cast<const double*>(states.data())}, shapes.data(),
                           reach);
    std::vector<Remade> all(pairs.size());
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        all[i].done = !(store.found(i / store.width()) >> i % store.width() & 1);
        all[i].record = record;
        store.read(i, all[i].cache, all[i].record);
    }
    return all;
}

std::vector<Pair> random_pairs(int count) {
    Random random(31);
    std::vector<Pair> pairs;
    for (int i = 0; i < count; ++i) pairs.emplace_back(random);
    return pairs;
}

TEST(Remake, ManifoldsInLanesAreThoseOfOnePair) {
    const std::vector<Pair> pairs = random_pairs(4000);
    const std::vector<Remade> remade = remake_all(pairs, 1, {}, stranger());
    int touching = 0, different = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair& p = pairs[i];
        const ContactRecord<2>& now = remade[i].record;
        const double gap = p.gap();
        if (std::fabs(gap - reach) > 1e-5) {
            EXPECT_EQ(remade[i].done, gap < reach) << i;
        }
        if (!remade[i].done) continue;
        ++touching;
        Manifold<2> m = collide_shapes<2>(p.shape_a, p.shape_b, p.b_in_a(), reach);
        m = moved(m, frame(p.a, p.mass_a));
        double least = 1;
        for (int k = 0; k < now.count; ++k) least = std::min<double>(least, now.points[k].separation);
        double expected = 1;
        for (int k = 0; k < m.count; ++k) expected = std::min(expected, m.points[k].separation);
        bool same = now.count == m.count && length(narrow<double>(now.normal) - m.normal) < 1e-3;
        for (int k = 0; same && k < m.count; ++k) {
            const Vec2 at = p.a.position + narrow<double>(now.points[k].arm_a);
            const auto* other =
                std::ranges::find(m.points, now.points[k].feature, &ManifoldPoint<2>::feature);
            same = other != m.points.end() && length(at - other->position) < 1e-4 &&
                   std::fabs(now.points[k].separation - other->separation) < 1e-5;
            EXPECT_LT(length(at - p.b.position - narrow<double>(now.points[k].arm_b)), 1e-6) << i;
        }
        // Of two choices that are as good up to rounding either may be taken.
        if (!same) ++different;
        if (now.count == m.count && length(narrow<double>(now.normal) - m.normal) < 1e-3) {
            EXPECT_NEAR(least, expected, 1e-5) << i;
        }
    }
    EXPECT_GT(touching, 2000);
    EXPECT_LE(different, touching / 200);
}

TEST(Remake, EveryWidthGivesTheSameBits) {
    const std::vector<Pair> pairs = random_pairs(1000);
    const std::vector<Remade> one = remake_all(pairs, 1, {}, stranger());
    for (const int width : {4, 8, 16}) {
        if (!can_run_lanes(width)) continue;
        const std::vector<Remade> many = remake_all(pairs, width, {}, stranger());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            ASSERT_EQ(many[i].done, one[i].done) << i;
            const ContactRecord<2>&x = many[i].record, &y = one[i].record;
            ASSERT_EQ(x.count, y.count) << i;
            ASSERT_EQ(std::memcmp(&x.normal, &y.normal, sizeof x.normal), 0) << i;
            for (int k = 0; k < x.count; ++k)
                ASSERT_EQ(std::memcmp(&x.points[k], &y.points[k], sizeof x.points[k]), 0) << i;
            ASSERT_EQ(many[i].cache.way, one[i].cache.way);
            ASSERT_EQ(many[i].cache.normal, one[i].cache.normal);
        }
    }
}

/// The same feature keeps its impulse, and what goes on its friction; what is nowhere near anything that was
/// starts without.
TEST(Remake, ImpulsesGoToTheSameFeatures) {
    const std::vector<Pair> pairs = random_pairs(300);
    const std::vector<Remade> first = remake_all(pairs, 1, {}, stranger());
    int looked_at = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!first[i].done) continue;
        ContactRecord<2> record = first[i].record;
        EXPECT_EQ(length(record.friction_impulse), 0);
        for (int k = 0; k < record.count; ++k) {
            EXPECT_EQ(record.points[k].impulse, 0);
            record.points[k].impulse = static_cast<float>(k + 1);
        }
        record.friction_impulse = {-3 * record.normal.y, 3 * record.normal.x};
        ContactCache<2> cache = first[i].cache;
        cache.forget();
        const ContactRecord<2> again = remake_all({pairs[i]}, 1, cache, record)[0].record;
        ASSERT_EQ(again.count, record.count);
        for (int k = 0; k < again.count; ++k) EXPECT_EQ(again.points[k].impulse, k + 1);
        EXPECT_LT(length(again.friction_impulse - record.friction_impulse), 1e-5f) << i;
        ++looked_at;
    }
    EXPECT_GT(looked_at, 150);
}

/// What is kept of a manifold made in lanes is as good as one made for the pair: carried along, it shows the
/// same gaps.
TEST(Remake, TheCacheIsThatOfTheNewManifold) {
    const std::vector<Pair> pairs = random_pairs(500);
    const std::vector<Remade> remade = remake_all(pairs, 1, {}, stranger());
    int kept = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (!remade[i].done) continue;
        const ContactCache<2>& cache = remade[i].cache;
        const RelativePose<2> pose(pairs[i].a, pairs[i].b);
        EXPECT_LT(length(cache.pose.position - pose.position), 1e-12);
        const bool is_round = pairs[i].shape_a.radius > 0 || pairs[i].shape_b.radius > 0;
        EXPECT_EQ(cache.holds(pose), !is_round) << i;
        kept += cache.holds(pose);
        EXPECT_EQ(cache.roundness_a, 0);  // as it was written
        int there = 0;
        for (const auto& p : cache.points) {
            if (p.separation > 1e29f) continue;
            EXPECT_LT(length(p.on_a - (pose.position + rotate(pose.rotation, p.on_b))), 1e-6);
            ++there;
        }
        EXPECT_GE(there, remade[i].record.count);
    }
    EXPECT_GT(kept, 20);
}

/// Pairs of which nothing is known are looked at in lanes: what is within reach is found, and what is not is
/// known to be apart from then on.
TEST(Remake, LanesFindWhatHoldsPairsApart) {
    const std::vector<Pair> pairs = random_pairs(2000);
    std::vector<std::uint32_t> expected;
    for (const int width : {1, 4, 8, 16}) {
        if (!can_run_lanes(width)) continue;
        set_lane_width(width);
        LaneShapes<2> shapes;
        ApartStore<2> store;
        std::vector<BodyState<2>> states;
        for (std::uint32_t i = 0; i < pairs.size(); ++i) {
            const Pair& p = pairs[i];
            states.insert(states.end(), {p.a, p.b});
            store.add(i, 2 * i, 2 * i + 1, {}, p.mass_a.radius, p.mass_b.radius,
                      {shapes.find(2 * i, p.shape_a, p.mass_a), shapes.find(2 * i + 1, p.shape_b, p.mass_b)});
        }
        const ApartLimits<float> limits{reach, 0.01f, 1.0f / 60, 0};
        const auto near = store.find_near(states, shapes, limits, nullptr);
        const std::vector<std::uint32_t> found(near.begin(), near.end());
        if (width == 1) {
            expected = found;
            for (std::uint32_t i = 0; i < pairs.size(); ++i) {
                const double gap = pairs[i].gap();
                if (std::fabs(gap - reach) > 1e-5) {
                    EXPECT_EQ(std::ranges::binary_search(found, i), gap < reach) << i;
                }
            }
        }
        EXPECT_EQ(found, expected) << width;
        // Hardly moved, and with a little less reach, none of those that were away is near.
        for (std::uint32_t i = 0; i < pairs.size(); ++i) states[2 * i + 1].position += 1e-7 * Vec2{1, 1};
        const auto later = store.find_near(states, shapes, {reach - 1e-5f, 0.01f, 1.0f / 60, 0}, nullptr);
        for (const std::uint32_t i : later) EXPECT_TRUE(std::ranges::binary_search(expected, i)) << i;
    }
    set_lane_width(0);
    EXPECT_GT(expected.size(), 1000u);
    EXPECT_LT(expected.size(), 1900u);
}

/// A place that was given up is used again, and a shape that was forgotten is read anew.
TEST(Remake, ShapesForLanesComeAndGo) {
    LaneShapes<2> shapes;
    BodyMass<2> mass;
    mass.radius = 1;
    const auto ball = [](double radius) { return make_shape<2>({.geometry = Ball{radius}}); };
    const std::uint32_t first = shapes.find(0, ball(0.5), mass), second = shapes.find(1, ball(0.25), mass);
    EXPECT_NE(first, LaneShapes<2>::none);
    EXPECT_NE(first, second);
    EXPECT_EQ(shapes.data()[second * LaneShapes<2>::stride + 1], 0.25f);
    shapes.forget(0);
    EXPECT_EQ(shapes.find(2, ball(0.75), mass), first);
    EXPECT_EQ(shapes.data()[first * LaneShapes<2>::stride + 1], 0.75f);
    EXPECT_NE(shapes.find(0, ball(0.5), mass), first);

    EXPECT_EQ(shapes.find(3, make_shape<2>({.geometry = Plane<2>{{0, 1}}}), mass), LaneShapes<2>::none);
    mass.radius = 1000;
    EXPECT_EQ(shapes.find(4, ball(1), mass), LaneShapes<2>::none) << "too large for floats";
    mass.radius = 1;
    Hull<2> many;
    for (int i = 0; i < 9; ++i) {
        const auto turn = Rotation2::from_angle(6.28 * i / 9);
        many.points.push_back({turn.c, turn.s});
    }
    EXPECT_EQ(shapes.find(5, make_shape<2>({.geometry = many}), mass), LaneShapes<2>::none);
}

}  // namespace
}  // namespace carom::detail
