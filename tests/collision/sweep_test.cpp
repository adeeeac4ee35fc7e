#include "collision/sweep.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "random.hpp"
#include "simd/width.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <class T>
class SweepTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SweepTest, Dimensions);

using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

/// A crowd in which every fifth box is not listed and the sizes differ; some lie on one another. Half of them
/// were somewhere else before, or nowhere.
template <int D>
struct Crowd {
    std::vector<OuterBox<D>> boxes, before;
    std::vector<std::uint32_t> listed;

    Crowd(Random& random, std::uint32_t count, double stretch, double largest) {
        for (std::uint32_t i = 0; i < count; ++i) {
            Vec<D> center = random.in_cube<D>(10), half;
            center.y *= stretch;
            for (int k = 0; k < D; ++k) half[k] = random.between(0, i % 50 == 7 ? 10 * largest : largest);
            const bool again = i > 0 && i % 40 == 1;
            boxes.push_back(again ? boxes[i - 1] : OuterBox<D>(Aabb<D>{center - half, center + half}));
            const Vec<D> way = random.in_cube<D>(2 * largest);
            before.push_back(random.below(2) == 0 ? boxes[i]
                             : i % 30 == 3        ? no_box<D>()
                                           : OuterBox<D>(Aabb<D>{center - half + way, center + half + way}));
            if (i % 5 != 4) listed.push_back(i);
        }
    }

    Pairs expected() const {
        Pairs pairs;
        for (const std::uint32_t a : listed) {
            for (const std::uint32_t b : listed) {
                const bool begins = overlaps(boxes[a], boxes[b]) && !overlaps(before[a], before[b]);
                if (a < b && begins) pairs.emplace(a, b);
            }
        }
        return pairs;
    }
    Pairs found(Sweep<D>& sweep, Scheduler* scheduler = nullptr) const {
        Pairs pairs;
        sweep.find(listed, boxes, before, scheduler,
                   [&](std::uint32_t a, std::uint32_t b) { pairs.emplace(std::min(a, b), std::max(a, b)); });
        return pairs;
    }
};

TYPED_TEST(SweepTest, finds_every_pair_once_with_any_lane_width) {
    constexpr int D = TypeParam::value;
    for (const int width : {1, 4, 8, 16}) {
        if (!can_run_lanes(width)) continue;
        set_lane_width(width);
        Sweep<D> sweep;
        Random random(17);
        for (const std::uint32_t count : {0u, 1u, 2u, 3u, 17u, 100u, 600u}) {
            for (const double stretch : {1e-3, 1.0, 50.0}) {
                for (const double largest : {0.0, 0.3, 3.0}) {
                    const Crowd<D> crowd(random, count, stretch, largest);
                    ASSERT_EQ(crowd.found(sweep), crowd.expected())
                        << count << ' ' << stretch << ' ' << largest;
                }
            }
        }
    }
    set_lane_width(0);
}

TYPED_TEST(SweepTest, knows_infinite_boxes_and_those_in_one_place) {
    constexpr int D = TypeParam::value;
    Random random(18);
    Crowd<D> crowd(random, 60, 1, 0.5);
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (const std::uint32_t i : {3u, 20u, 31u}) {
        crowd.boxes[i].lower.x = -infinite;
        if (i != 20) crowd.boxes[i].upper.y = infinite;
    }
    Sweep<D> sweep;
    EXPECT_EQ(crowd.found(sweep), crowd.expected());
    for (OuterBox<D>& box : crowd.boxes) box = crowd.boxes[0];
    EXPECT_EQ(crowd.found(sweep), crowd.expected());
    for (OuterBox<D>& box : crowd.before) box = no_box<D>();
    EXPECT_EQ(crowd.found(sweep), crowd.expected());
    EXPECT_GT(crowd.expected().size(), 1000u);
}

TYPED_TEST(SweepTest, finds_them_in_the_same_order_with_any_number_of_threads) {
    constexpr int D = TypeParam::value;
    Random random(19);
    const Crowd<D> crowd(random, 3000, 1, 0.4);
    using List = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
    const auto list = [&](Scheduler* scheduler) {
        Sweep<D> sweep;
        List pairs;
        sweep.find(crowd.listed, crowd.boxes, crowd.before, scheduler,
                   [&](std::uint32_t a, std::uint32_t b) { pairs.emplace_back(a, b); });
        return pairs;
    };
    const List alone = list(nullptr);
    EXPECT_GT(alone.size(), 300u);
    for (const int threads : {2, 3, 8}) EXPECT_EQ(list(make_thread_pool(threads).get()), alone) << threads;
}

}  // namespace
}  // namespace carom::detail
