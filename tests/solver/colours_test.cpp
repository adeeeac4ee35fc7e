#include "solver/colours.hpp"

#include <gtest/gtest.h>

#include <array>

#include <set>

#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

std::vector<SlotPair> random_pairs(Random& random, int contacts, std::uint32_t slots,
                                   std::uint32_t first_movable) {
    std::vector<SlotPair> pairs;
    while (static_cast<int>(pairs.size()) < contacts) {
        const auto draw = [&] { return static_cast<std::uint32_t>(random.between(0, slots - 0.001)); };
        SlotPair p{draw(), draw()};
        p.key = pair_key(p.a, p.b);
        if (p.a != p.b && (p.a >= first_movable || p.b >= first_movable)) pairs.push_back(p);
    }
    return pairs;
}

/// Deals them all.
struct Deal {
    std::vector<int> colour;
    std::array<std::size_t, Colours::count + 1> sizes{};

    Deal(Colours& colours, const std::vector<SlotPair>& pairs, std::uint32_t first_movable) {
        for (const SlotPair& pair : pairs) {
            colour.push_back(colours.take(pair, first_movable));
            ++sizes[colour.back()];
        }
    }
};

TEST(Colours, NoTwoContactsOfAColourShareABodyThatCanBePushed) {
    Random random(1);
    for (const std::uint32_t first_movable : {1u, 5u}) {
        const std::vector<SlotPair> pairs = random_pairs(random, 2000, 300, first_movable);
        Colours colours;
        const Deal deal(colours, pairs, first_movable);
        std::set<std::pair<int, std::uint32_t>> seen;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (deal.colour[i] == Colours::overflow) continue;
            for (const std::uint32_t slot : {pairs[i].a, pairs[i].b})
                EXPECT_TRUE(slot < first_movable || seen.insert({deal.colour[i], slot}).second) << i;
        }
    }
}

TEST(Colours, ContactsWithFixedBodiesComeFirst) {
    Random random(2);
    const std::vector<SlotPair> pairs = random_pairs(random, 500, 200, 20);
    Colours colours;
    const Deal deal(colours, pairs, 20);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const bool fixed = pairs[i].a < 20 || pairs[i].b < 20;
        EXPECT_EQ(deal.colour[i] < Colours::with_fixed, fixed);
    }
}

/// A body with more contacts than there are colours, as the drum of a tumbler has.
TEST(Colours, WhatFindsNoColourOverflows) {
    std::vector<SlotPair> pairs;
    for (std::uint32_t i = 0; i < 100; ++i) pairs.push_back({1, 2 + i, pair_key(1, 2 + i)});
    Colours colours;
    const Deal deal(colours, pairs, 1);
    EXPECT_EQ(deal.sizes[Colours::overflow], 100 - static_cast<std::size_t>(Colours::between_movable));
    for (int c = Colours::with_fixed; c < Colours::count; ++c) EXPECT_EQ(deal.sizes[c], 1u);
    EXPECT_EQ(deal.colour[99], Colours::overflow);
}

/// A grid of boxes needs four colours. Greedy colouring needs at most 7 (three more neighbours at either body
/// of a contact), and the lots leave out up to three more.
TEST(Colours, FewColoursAreUsed) {
    std::vector<SlotPair> pairs;
    constexpr std::uint32_t n = 30;
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t slot = 1 + i * n + j;
            if (j > 0) pairs.push_back({slot - 1, slot, pair_key(slot - 1, slot)});
            if (i > 0) pairs.push_back({slot - n, slot, pair_key(slot - n, slot)});
        }
    }
    Colours colours;
    const Deal deal(colours, pairs, 1);
    int used = 0;
    for (int c = 0; c <= Colours::count; ++c) used += deal.sizes[c] > 0;
    EXPECT_LE(used, 10);
}

/// Contacts to the left and to the right of the boxes of a row are not solved one after the other.
TEST(Colours, ContactsThatAreCreatedAlikeAreMixed) {
    std::vector<SlotPair> pairs;
    for (std::uint32_t i = 1; i < 1000; ++i) pairs.push_back({i, i + 1, pair_key(i, i + 1)});
    Colours colours;
    const Deal deal(colours, pairs, 1);
    int rising = 0;
    for (std::size_t i = 1; i < pairs.size(); ++i) rising += deal.colour[i] > deal.colour[i - 1];
    EXPECT_NEAR(rising, 500, 150);
    int largest = 0;
    for (int c = 0; c < Colours::count; ++c) largest = std::max(largest, static_cast<int>(deal.sizes[c]));
    EXPECT_LT(largest, 500);
}

/// A colour that was given back is free again, for both bodies.
TEST(Colours, AreGivenBack) {
    Random random(4);
    const std::vector<SlotPair> pairs = random_pairs(random, 1000, 200, 3);
    Colours colours;
    const Deal first(colours, pairs, 3);
    for (std::size_t i = 0; i < pairs.size(); ++i) colours.give_back(pairs[i], first.colour[i], 3);
    const Deal second(colours, pairs, 3);
    EXPECT_EQ(second.colour, first.colour);
}

}  // namespace
}  // namespace carom::detail
