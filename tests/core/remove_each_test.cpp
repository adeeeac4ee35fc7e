#include "core/remove_each.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace carom::detail {
namespace {

/// The order in which things are picked, and how often, does not matter.
TEST(RemoveEach, LeavesTheOthersInAnOrderOfTheirOwn) {
    std::mt19937_64 random(4);
    for (int round = 0; round < 500; ++round) {
        std::vector<int> items(random() % 12 + 1);
        std::iota(items.begin(), items.end(), 0);
        std::vector<std::uint32_t> picked;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (random() % 2) picked.push_back(static_cast<std::uint32_t>(i));
        }
        std::vector<int> expected;
        for (const int item : items) {
            if (!std::ranges::count(picked, static_cast<std::uint32_t>(item))) expected.push_back(item);
        }
        const auto left_after = [&](std::vector<std::uint32_t> order) {
            std::vector<int> left = items;
            std::vector<int> removed;
            remove_each(order, left, [&](std::uint32_t i) {
                removed.push_back(left[i]);
                left[i] = left.back();
                left.pop_back();
            });
            EXPECT_TRUE(order.empty());
            EXPECT_EQ(left.size() + removed.size(), items.size());
            return left;
        };
        const std::vector<int> once = left_after(picked);
        std::ranges::reverse(picked);
        if (!picked.empty()) picked.push_back(picked[0]);
        EXPECT_EQ(left_after(picked), once);
        std::vector<int> sorted = once;
        std::ranges::sort(sorted);
        EXPECT_EQ(sorted, expected);
    }
}

}  // namespace
}  // namespace carom::detail
