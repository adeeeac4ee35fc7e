#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "carom/scheduler.hpp"
#include "collision/random.hpp"
#include "collision/tree.hpp"

// Trees that many leaves come into at once.

namespace carom::test {
namespace {

template <int D>
std::vector<typename detail::Tree<D>::Entry> scattered(int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<typename detail::Tree<D>::Entry> entries;
    for (int i = 0; i < count; ++i) {
        const Vec<D> middle = random.in_cube<D>(50), half = random.in_cube<D>(0.5);
        Aabb<D> box{middle, middle};
        for (int k = 0; k < D; ++k) {
            box.lower[k] -= std::fabs(half[k]);
            box.upper[k] += std::fabs(half[k]);
        }
        entries.push_back({box, std::uint32_t(3 * i)});
    }
    return entries;
}

template <int D>
std::vector<std::uint32_t> found(const detail::Tree<D>& tree, const detail::OuterBox<D>& box) {
    std::vector<std::uint32_t> payloads;
    tree.query(box, [&](std::uint32_t payload) { payloads.push_back(payload); });
    return payloads;
}

template <int D>
void grow_many() {
    for (const int count : {65, 1000, 1025, 5000, 40000}) {
        const auto entries = scattered<D>(count, 81), more = scattered<D>(count, 82);
        std::vector<std::int32_t> leaves(entries.size()), others(entries.size());
        detail::Tree<D> alone, by_workers, built;
        alone.insert_all(entries, leaves);
        by_workers.insert_all(entries, others, make_thread_pool(3).get());
        built.build(entries);
        EXPECT_EQ(leaves, others);
        for (std::size_t i = 0; i < entries.size(); ++i) {
            ASSERT_EQ(alone.payload(leaves[i]), entries[i].payload);
            ASSERT_EQ(alone.box(leaves[i]), entries[i].box);
        }
        // The order of answers tells the shape of a tree.
        const auto compare = [&] {
            ASSERT_TRUE(alone.validate() && by_workers.validate() && built.validate());
            for (int i = 0; i < 50; ++i) {
                const auto& box = entries[std::size_t(i)].box;
                ASSERT_EQ(found(alone, box), found(by_workers, box));
                ASSERT_EQ(found(alone, box), found(built, box));
            }
        };
        compare();
        // And over those that there are.
        alone.insert_all(more, others);
        by_workers.insert_all(more, others, make_thread_pool(3).get());
        built.insert_all(more, others);
        ASSERT_EQ(alone.size(), 2 * count);
        ASSERT_TRUE(alone.validate() && by_workers.validate() && built.validate());
        for (const std::int32_t leaf : leaves) alone.remove(leaf);
        ASSERT_EQ(alone.size(), count);
        EXPECT_TRUE(alone.validate());
    }
}

TEST(TreeGrowth, is_the_same_in_the_plane_by_whoever_makes_it) { grow_many<2>(); }
TEST(TreeGrowth, is_the_same_in_space_by_whoever_makes_it) { grow_many<3>(); }

}  // namespace
}  // namespace carom::test
