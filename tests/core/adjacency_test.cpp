#include "core/adjacency.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace carom::detail {
namespace {

std::multiset<std::uint32_t> links_of(const Adjacency& adjacency, std::uint32_t node) {
    std::multiset<std::uint32_t> found;
    adjacency.each(node, [&](std::uint32_t link, std::uint32_t) { found.insert(link); });
    return found;
}

TEST(Adjacency, AnUnknownNodeHasNoLinks) {
    Adjacency adjacency;
    EXPECT_TRUE(links_of(adjacency, 7).empty());
    adjacency.add(0, 1, 3);
    EXPECT_TRUE(links_of(adjacency, 2).empty());
    EXPECT_TRUE(links_of(adjacency, 7).empty());
    adjacency.make_room(10);
    EXPECT_TRUE(links_of(adjacency, 7).empty());
}

/// Links come, go and take other numbers; a map of lists does the same.
TEST(Adjacency, AgreesWithAMap) {
    std::mt19937_64 random(3);
    constexpr std::uint32_t nodes = 12;
    Adjacency adjacency;
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> links;
    for (int i = 0; i < 3000; ++i) {
        const auto number = static_cast<std::uint32_t>(random() % 60);
        const bool taken = links.contains(number);
        if (!taken && random() % 2) {
            const auto a = static_cast<std::uint32_t>(random() % nodes);
            const auto b = static_cast<std::uint32_t>((a + 1 + random() % (nodes - 1)) % nodes);
            adjacency.add(number, a, b);
            links[number] = {a, b};
        } else if (!taken && !links.empty()) {
            const std::uint32_t from =
                std::next(links.begin(), std::ptrdiff_t(random() % links.size()))->first;
            adjacency.renumber(from, number);
            links[number] = links[from];
            links.erase(from);
        } else if (taken) {
            adjacency.remove(number);
            links.erase(number);
        }
        for (std::uint32_t node = 0; node < nodes; ++node) {
            std::multiset<std::uint32_t> expected;
            for (const auto& [link, ends] : links) {
                if (ends.first == node || ends.second == node) expected.insert(link);
            }
            ASSERT_EQ(links_of(adjacency, node), expected) << "node " << node << ", change " << i;
            adjacency.each(node, [&](std::uint32_t link, std::uint32_t other) {
                ASSERT_EQ(links[link].first + links[link].second, node + other);
            });
        }
    }
}

}  // namespace
}  // namespace carom::detail
