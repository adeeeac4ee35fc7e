#include "core/pair_set.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>

namespace carom::detail {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

Pair sorted(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

TEST(PairSet, StartsEmpty) {
    PairSet set;
    EXPECT_FALSE(set.contains(PairKey::of(0, 0)));
    EXPECT_FALSE(set.contains(PairKey::of(1, 2)));
}

TEST(PairSet, IsBlindToTheOrderOfAPair) {
    PairSet set;
    EXPECT_TRUE(set.insert(PairKey::of(7, 3)));
    EXPECT_FALSE(set.insert(PairKey::of(3, 7)));
    EXPECT_TRUE(set.contains(PairKey::of(3, 7)));
    EXPECT_TRUE(set.contains(PairKey::of(7, 3)));
    set.erase(PairKey::of(3, 7));
    EXPECT_FALSE(set.contains(PairKey::of(7, 3)));
    EXPECT_TRUE(set.insert(PairKey::of(3, 7)));
}

TEST(PairSet, TakesTheSmallestAndTheLargestNumbers) {
    PairSet set;
    const std::uint32_t most = 0xfffffffeu;
    EXPECT_TRUE(set.insert(PairKey::of(0, 1)));
    EXPECT_TRUE(set.insert(PairKey::of(0, most)));
    EXPECT_TRUE(set.insert(PairKey::of(most, most - 1)));
    EXPECT_TRUE(set.contains(PairKey::of(most, 0)));
    EXPECT_TRUE(set.contains(PairKey::of(1, 0)));
    EXPECT_FALSE(set.contains(PairKey::of(1, most)));
}

TEST(PairSet, TellsThePartsOfAPairApart) {
    PairSet set;
    EXPECT_TRUE(set.insert(PairKey::of(2, 1, 5)));
    EXPECT_FALSE(set.contains(PairKey::of(1, 2)));
    EXPECT_TRUE(set.insert(PairKey::of(1, 2)));
    set.erase(PairKey::of(1, 2));
    EXPECT_TRUE(set.contains(PairKey::of(1, 2, 5)));
}

TEST(PairSet, ErasingWhatIsNotThereChangesNothing) {
    PairSet set;
    set.insert(PairKey::of(1, 2));
    set.erase(PairKey::of(1, 3));
    EXPECT_TRUE(set.contains(PairKey::of(1, 2)));
    set.erase(PairKey::of(1, 2));
    set.erase(PairKey::of(1, 2));
    EXPECT_FALSE(set.contains(PairKey::of(1, 2)));
}

/// Random insertions and removals, with numbers from a range: a small one makes long runs of probes and many
/// removals in the middle of them, a large one makes the table grow.
void compare_with_std_set(std::uint32_t range, int operations, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PairSet set;
    std::set<Pair> model;
    for (int i = 0; i < operations; ++i) {
        const auto a = static_cast<std::uint32_t>(random() % range);
        const auto b = static_cast<std::uint32_t>(random() % range);
        switch (random() % 3) {
            case 0:
            case 1:
                ASSERT_EQ(set.insert(PairKey::of(a, b)), model.insert(sorted(a, b)).second)
                    << "operation " << i;
                break;
            default:
                if (!model.empty()) {
                    set.erase(PairKey::of(b, a));
                    model.erase(sorted(a, b));
                }
        }
        ASSERT_EQ(set.contains(PairKey::of(b, a)), model.contains(sorted(a, b))) << "operation " << i;
        if (i % 997 != 0) continue;
        for (std::uint32_t k = 0; k < 1000; ++k) {
            const auto x = static_cast<std::uint32_t>(random() % range);
            const auto y = static_cast<std::uint32_t>(random() % range);
            ASSERT_EQ(set.contains(PairKey::of(x, y)), model.contains(sorted(x, y))) << "operation " << i;
        }
    }
    for (const auto& [a, b] : model) ASSERT_TRUE(set.contains(PairKey::of(a, b)));
}

TEST(PairSet, DoesAsAStdSetWithFewNumbers) { compare_with_std_set(12, 20000, 1); }
TEST(PairSet, DoesAsAStdSetWithSomeNumbers) { compare_with_std_set(60, 40000, 2); }
TEST(PairSet, DoesAsAStdSetWithManyNumbers) { compare_with_std_set(100000, 40000, 3); }

TEST(PairSet, CanBeEmptiedAndFilledAgain) {
    PairSet set;
    for (int round = 0; round < 3; ++round) {
        for (std::uint32_t i = 0; i < 500; ++i) ASSERT_TRUE(set.insert(PairKey::of(i, i + 1)));
        for (std::uint32_t i = 0; i < 500; ++i) set.erase(PairKey::of(i + 1, i));
        for (std::uint32_t i = 0; i < 500; ++i) ASSERT_FALSE(set.contains(PairKey::of(i, i + 1)));
    }
}

}  // namespace
}  // namespace carom::detail
