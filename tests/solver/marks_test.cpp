#include "solver/marks.hpp"

#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "simd/width.hpp"
#include "solver/contact_store.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <class T>
class MarksIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(MarksIn, Dimensions);

/// Two bodies far from the origin with a contact, and how they moved since their shapes were collided.
template <int D>
struct Case {
    BodyState<D> a{}, b{};
    ContactCache<D> cache;
    ContactRecord<D> record;
    BodyState<D> a_now{}, b_now{};

    Case(Random& random, double far, double way, double turned) {
        a.position = random.in_cube<D>(far);
        a.rotation = random.rotation<D>();
        b.position = a.position + random.in_cube<D>(1);
        b.rotation = random.rotation<D>();
        cache.pose = RelativePose<D>(a, b);
        cache.normal = narrow<float>(normalized(random.in_cube<D>(1)));
        cache.normal_of = random.below(2) ? NormalOf::second : NormalOf::first;
        cache.way = static_cast<float>(2 * way);
        cache.turn = 5e-3f;
        cache.count = max_points<D>;
        for (int k = 0; k < cache.count; ++k) {
            auto& p = cache.points[k];
            p.on_a = random.in_cube<D>(0.7);
            p.on_b = unrotate(cache.pose.rotation, p.on_a - cache.pose.position);
            p.separation = static_cast<float>(random.between(-0.01, 0.01));
            p.feature = static_cast<std::uint32_t>(k);
            record.points[k].feature = p.feature;
            record.points[k].impulse = 1;
        }
        record.count = cache.count;
        // Both are carried anywhere, and b a little against a.
        const Transform<D> carried{random.in_cube<D>(far), random.rotation<D>()};
        const auto carry = [&](const BodyState<D>& s) {
            BodyState<D> now;
            now.position = carried.position + rotate(carried.rotation, s.position - a.position);
            now.rotation = carried.rotation * s.rotation;
            return now;
        };
        a_now = carry(a);
        b_now = carry(b);
        b_now.position += way * normalized(random.in_cube<D>(1));
        if constexpr (D == 2) {
            turn<D>(b_now, turned);
        } else {
            turn<D>(b_now, turned * normalized(random.in_cube<3>(1)));
        }
    }
};

/// Points are where their two marks lie midway between, and gaps grow by what these part along the normal.
TYPED_TEST(MarksIn, PointsAreCarriedAlongWithTheBodies) {
    constexpr int D = TypeParam::value;
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Case<D> c(random, i % 2 ? 1e4 : 1, 1e-3, 1e-3);
        ContactStore<D> store;
        store.set_passes(passes_of_width<D>(1));
        store.push(0, {1, 2, 0, 1}, 1);
        const Carrying<D> carrying{c.cache, {}};
        store.write(0, c.record, &carrying);
        const std::array<BodyState<D>, 2> states{c.a_now, c.b_now};
        store.passes().refresh(store.span(), {reinterpret_cast<const double*>(states.data())}, nullptr, 1);
        EXPECT_EQ(store.found(0), 0u);
        ContactRecord<D> now = c.record;
        ContactCache<D> cache = c.cache;
        store.read(0, cache, now);
        ASSERT_EQ(now.count, c.cache.count);
        const Vec<D> found = narrow<double>(c.cache.normal);
        const Vec<D> normal = c.cache.normal_of == NormalOf::second
                                  ? rotate(c.b_now.rotation, unrotate(c.cache.pose.rotation, found))
                                  : rotate(c.a_now.rotation, found);
        EXPECT_LT(length(narrow<double>(now.normal) - normal), 1e-6);
        for (int k = 0; k < now.count; ++k) {
            const auto& mark = c.cache.points[k];
            const Vec<D> on_a = rotate(c.a_now.rotation, mark.on_a);
            const Vec<D> between = c.b_now.position - c.a_now.position;
            const Vec<D> on_b = between + rotate(c.b_now.rotation, mark.on_b);
            // The coordinates far away are good to 2e-12 m; a turn of 1e-3 to third order is off by 2e-10.
            EXPECT_NEAR(now.points[k].separation, mark.separation + dot(normal, on_b - on_a), 3e-9);
            EXPECT_LT(length(narrow<double>(now.points[k].arm_a) - 0.5 * (on_a + on_b)), 1e-6);
            EXPECT_LT(length(narrow<double>(now.points[k].arm_b) - (0.5 * (on_a + on_b) - between)), 1e-6);
            EXPECT_EQ(now.points[k].impulse, 1);
        }
    }
}

TYPED_TEST(MarksIn, WhatMovedTooFarIsFound) {
    constexpr int D = TypeParam::value;
    Random random(6);
    for (int i = 0; i < 100; ++i) {
        const double way = i % 3 == 0 ? 1e-3 : 0, turned = i % 3 == 1 ? 1e-2 : 0;
        const bool out_of_reach = i % 3 == 2;
        Case<D> c(random, 10, way, turned);
        c.cache.way = 5e-4f;
        ContactStore<D> store;
        store.set_passes(passes_of_width<D>(1));
        store.push(0, {1, 2, 0, 1}, 1);
        const Carrying<D> carrying{c.cache, {}};
        store.write(0, c.record, &carrying);
        const std::array<BodyState<D>, 2> states{c.a_now, c.b_now};
        store.passes().refresh(store.span(), {reinterpret_cast<const double*>(states.data())}, nullptr,
                               out_of_reach ? -1.0f : 1.0f);
        EXPECT_EQ(store.found(0), 1u) << i;
        ContactRecord<D> now = c.record;
        ContactCache<D> cache = c.cache;
        store.read(0, cache, now);
        ASSERT_EQ(now.count, out_of_reach ? 0 : c.record.count) << "impulses are not lost";
        for (int k = 0; k < now.count; ++k) EXPECT_EQ(now.points[k].impulse, 1);
    }
}

/// Contacts keep what they hold while others come and go around them.
TYPED_TEST(MarksIn, AStoreHasNoGaps) {
    constexpr int D = TypeParam::value;
    for (const int width : {1, 4, 8, 16}) {
        if (!can_run_lanes(width)) continue;
        Random random(7);
        ContactStore<D> store;
        store.set_passes(passes_of_width<D>(width));
        std::vector<std::uint32_t> model;  // contact by index
        for (std::uint32_t i = 0; i < 500; ++i) {
            if (model.empty() || random.between(0, 1) < 0.6) {
                ContactRecord<D> record;
                record.count = 1;
                record.points[0].impulse = static_cast<float>(i);
                EXPECT_EQ(store.push(i, {1, 2 + i, 0, 1}, 2), model.size());
                store.write(static_cast<std::uint32_t>(model.size()), record, nullptr);
                model.push_back(i);
            } else {
                const auto index =
                    static_cast<std::uint32_t>(random.between(0, static_cast<double>(model.size()) - 0.01));
                const std::uint32_t moved = store.remove(index, 2);
                EXPECT_EQ(moved, index + 1 == model.size() ? ContactStore<D>::none : model.back());
                model[index] = model.back();
                model.pop_back();
            }
            ASSERT_EQ(store.size(), model.size());
            ASSERT_EQ(store.blocks(), (model.size() + store.width() - 1) / store.width());
        }
        for (std::uint32_t k = 0; k < model.size(); ++k) {
            ContactRecord<D> record;
            record.count = 1;
            ContactCache<D> none;
            store.read(k, none, record);
            EXPECT_EQ(store.contact(k), model[k]);
            EXPECT_EQ(store.b(k), 2 + model[k]);
            EXPECT_EQ(record.points[0].impulse, static_cast<float>(model[k]));
        }
    }
}

}  // namespace
}  // namespace carom::detail
