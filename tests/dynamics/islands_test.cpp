#include "dynamics/islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace carom::detail {
namespace {

using Link = std::pair<std::uint32_t, std::uint32_t>;

/// Smallest member of each one's group, by spreading it along the links until nothing changes.
std::vector<std::uint32_t> smallest_members(std::uint32_t count, const std::vector<Link>& links) {
    std::vector<std::uint32_t> smallest(count);
    for (std::uint32_t i = 0; i < count; ++i) smallest[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [a, b] : links) {
            const std::uint32_t s = std::min(smallest[a], smallest[b]);
            changed |= smallest[a] != s || smallest[b] != s;
            smallest[a] = smallest[b] = s;
        }
    }
    return smallest;
}

TEST(Islands, TheRootIsTheSmallestMemberWhateverTheOrder) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 50; ++round) {
        const auto count = static_cast<std::uint32_t>(1 + random() % 80);
        std::vector<Link> links;
        for (std::uint64_t i = random() % (count + 20); i > 0; --i) {
            links.push_back(
                {static_cast<std::uint32_t>(random() % count), static_cast<std::uint32_t>(random() % count)});
        }
        const std::vector<std::uint32_t> expected = smallest_members(count, links);
        for (int order = 0; order < 3; ++order) {
            Islands islands;
            islands.reset(count);
            for (const auto& [a, b] : links) islands.join(a, b);
            for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(islands.root(i), expected[i]);
            for (std::size_t i = links.size(); i > 1; --i) std::swap(links[i - 1], links[random() % i]);
        }
    }
}

TEST(Islands, ResetForgetsEverything) {
    Islands islands;
    islands.reset(3);
    islands.join(0, 2);
    islands.reset(4);
    for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(islands.root(i), i);
}

}  // namespace
}  // namespace carom::detail
