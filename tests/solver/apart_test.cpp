#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "collision/manifold.hpp"
#include "collision/random.hpp"
#include "simd/width.hpp"
#include "solver/apart_store.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <class T>
class Apart : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Apart, Dimensions);

template <int D>
Shape<D> random_box(Random& random, double& radius) {
    Vec<D> size;
    for (int i = 0; i < D; ++i) size[i] = random.between(0.2, 1.5);
    radius = 0.5 * length(size);
    ShapeDefinition<D> definition;
    definition.geometry = Box<D>{size};
    return make_shape<D>(definition);
}

constexpr double reach = 0.02, dt = 1.0 / 60;

/// Pairs of boxes that a gap holds apart, in a store, and how they have moved since.
template <int D>
struct Pairs {
    std::vector<Shape<D>> shapes;
    std::vector<double> radii;
    std::vector<BodyState<D>> states;
    std::vector<ContactCache<D>> caches;

    Pairs(Random& random, int count, double far, double way, double speed) {
        while (static_cast<int>(caches.size()) < count) add(random, far);
        for (BodyState<D>& s : states) {
            s.position += random.in_cube<D>(way);
            if constexpr (D == 2)
                turn<D>(s, random.between(-way, way));
            else
                turn<D>(s, random.in_cube<D>(way));
            s.velocity = random.in_cube<D>(speed);
        }
    }

    void add(Random& random, double far) {
        double radius_a = 0, radius_b = 0;
        const Shape<D> a = random_box<D>(random, radius_a), b = random_box<D>(random, radius_b);
        BodyState<D> at, bt;
        at.position = random.in_cube<D>(far);
        at.rotation = random.rotation<D>();
        bt.position = at.position + random.in_cube<D>(1.5);
        bt.rotation = random.rotation<D>();
        ContactCache<D> cache;
        cache.pose = RelativePose<D>(at, bt);
        const auto gap = separate_shapes<D>(a, b, {cache.pose.position, cache.pose.rotation});
        if (!gap || gap->distance < reach || gap->distance > 0.2) return;
        cache.normal = narrow<float>(gap->axis);
        cache.gap = static_cast<float>(gap->distance);
        cache.way = 0;
        shapes.insert(shapes.end(), {a, b});
        radii.insert(radii.end(), {radius_a, radius_b});
        states.insert(states.end(), {at, bt});
        caches.push_back(cache);
    }

    ApartStore<D> stored() const {
        ApartStore<D> store;
        for (std::uint32_t i = 0; i < caches.size(); ++i)
            store.add(i, 2 * i, 2 * i + 1, caches[i], radii[2 * i], radii[2 * i + 1], {});
        return store;
    }
    double gap_now(std::size_t i) const {
        const RelativePose<D> pose(states[2 * i], states[2 * i + 1]);
        return separate_shapes<D>(shapes[2 * i], shapes[2 * i + 1], {pose.position, pose.rotation})->distance;
    }
    /// Of the two bodies after the step, if nothing stops them.
    double gap_then(std::size_t i) const {
        Pairs later = *this;
        for (const std::size_t k : {2 * i, 2 * i + 1}) later.states[k].position += dt * states[k].velocity;
        return later.gap_now(i);
    }
};

std::vector<std::uint32_t> list(std::span<const std::uint32_t> found) { return {found.begin(), found.end()}; }

TYPED_TEST(Apart, WhatMayTouchIsFound) {
    constexpr int D = TypeParam::value;
    Random random(31);
    const ApartLimits<float> limits{static_cast<float>(reach), 0.01f, static_cast<float>(dt), 0};
    int near = 0, spared = 0;
    for (const double speed : {0.0, 0.3, 20.0}) {
        for (const double way : {0.001, 0.03, 0.2}) {
            const Pairs<D> pairs(random, 100, 1e4, way, speed);
            ApartStore<D> store = pairs.stored();
            const auto found = list(store.find_near(pairs.states, {}, limits, nullptr));
            ASSERT_TRUE(std::ranges::is_sorted(found));
            for (std::uint32_t i = 0; i < 100; ++i) {
                const bool is_found = std::ranges::binary_search(found, i);
                const double gap = pairs.gap_now(i), then = speed > 1 ? pairs.gap_then(i) : gap;
                const bool touches = std::min(gap, then) < reach - 1e-6;
                ASSERT_TRUE(is_found || !touches) << i << ": " << gap << ", then " << then;
                near += touches;
                spared += !is_found;
            }
        }
    }
    EXPECT_GT(near, 50);
    EXPECT_GT(spared, 300);
}

TYPED_TEST(Apart, TheSameAreFoundInLanesOfAnyWidth) {
    constexpr int D = TypeParam::value;
    Random random(32);
    const Pairs<D> pairs(random, 53, 100, 0.05, 2);
    const ApartLimits<float> limits{static_cast<float>(reach), 0.01f, static_cast<float>(dt), 0.003f};
    std::vector<std::uint32_t> expected;
    for (const int width : {1, 4, 8, 16}) {
        if (!can_run_lanes(width)) continue;
        set_lane_width(width);
        ApartStore<D> store = pairs.stored();
        const auto found = list(store.find_near(pairs.states, {}, limits, nullptr));
        if (width == 1) expected = found;
        EXPECT_EQ(found, expected) << width;
    }
    set_lane_width(0);
    EXPECT_FALSE(expected.empty());
}

/// What is removed is forgotten, and the others keep their numbers, in any order of coming and going.
TYPED_TEST(Apart, ComeAndGo) {
    constexpr int D = TypeParam::value;
    Random random(33);
    const Pairs<D> pairs(random, 40, 10, 0, 0);
    // So far out that each is near.
    const ApartLimits<float> all{1e6f, 0.01f, static_cast<float>(dt), 0};
    ApartStore<D> store;
    std::vector<std::uint32_t> index(40, ApartStore<D>::none), present;
    for (int round = 0; round < 2000; ++round) {
        const auto i = static_cast<std::uint32_t>(random.below(40));
        if (index[i] == ApartStore<D>::none) {
            index[i] = store.add(i, 2 * i, 2 * i + 1, pairs.caches[i], 1, 1, {});
        } else {
            const std::uint32_t moved = store.remove(index[i]);
            if (moved != ApartStore<D>::none) index[moved] = index[i];
            index[i] = ApartStore<D>::none;
        }
        present.clear();
        for (std::uint32_t k = 0; k < 40; ++k) {
            if (index[k] == ApartStore<D>::none) continue;
            present.push_back(k);
            ASSERT_EQ(store.contact(index[k]), k);
            ASSERT_EQ(store.body_b(index[k]), 2 * k + 1);
        }
        auto found = list(store.find_near(pairs.states, {}, all, nullptr));
        std::ranges::sort(found);
        ASSERT_EQ(found, present);
    }
}

}  // namespace
}  // namespace carom::detail
