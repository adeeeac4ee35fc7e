#include "core/hash.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace carom::detail {
namespace {

std::uint64_t hash_of(const std::vector<std::uint64_t>& words) {
    Hash hash;
    for (const std::uint64_t word : words) hash.add(word);
    return hash.value();
}

TEST(Hash, IsTheSameForTheSameWords) {
    EXPECT_EQ(hash_of({1, 2, 3}), hash_of({1, 2, 3}));
    EXPECT_EQ(Hash().value(), Hash().value());
}

TEST(Hash, TellsOrderLengthAndZeroesApart) {
    const std::set<std::uint64_t> different{
        hash_of({}),        hash_of({0}),    hash_of({0, 0}),    hash_of({1}),
        hash_of({1, 0}),    hash_of({0, 1}), hash_of({1, 2}),    hash_of({2, 1}),
        hash_of({1, 2, 0}), hash_of({1, 1}), hash_of({1, 1, 1}), hash_of({~std::uint64_t{0}})};
    EXPECT_EQ(different.size(), 12u);
}

TEST(Hash, ReadsDoublesAndFloatsByTheirBits) {
    const auto of = [](auto x) {
        Hash hash;
        hash.add(x);
        return hash.value();
    };
    EXPECT_EQ(of(1.5), of(std::bit_cast<std::uint64_t>(1.5)));
    EXPECT_NE(of(0.0), of(-0.0));
    EXPECT_NE(of(1.0), of(std::nextafter(1.0, 2.0)));
    EXPECT_NE(of(1.0f), of(std::nextafter(1.0f, 2.0f)));
    EXPECT_NE(of(0.0f), of(-0.0f));
    EXPECT_EQ(of(std::numeric_limits<double>::quiet_NaN()), of(std::numeric_limits<double>::quiet_NaN()));
}

/// One flipped bit of the input turns over half of the output bits on average, wherever it is.
TEST(Hash, SpreadsEveryBitOverAllBits) {
    std::mt19937_64 random(5);
    for (int bit = 0; bit < 64; ++bit) {
        int flipped = 0;
        constexpr int tries = 200;
        for (int i = 0; i < tries; ++i) {
            std::vector<std::uint64_t> words{random(), random(), random()};
            const std::uint64_t before = hash_of(words);
            words[static_cast<std::size_t>(i % 3)] ^= std::uint64_t{1} << bit;
            flipped += std::popcount(before ^ hash_of(words));
        }
        EXPECT_NEAR(flipped / double(tries), 32, 3) << "bit " << bit;
    }
}

TEST(Hash, DoesNotCollideOnSmallCounters) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t a = 0; a < 300; ++a) {
        for (std::uint64_t b = 0; b < 300; ++b) seen.insert(hash_of({a, b}));
    }
    EXPECT_EQ(seen.size(), 90000u);
}

/// The state hashes that are written down anywhere stay comparable as long as this holds.
TEST(Hash, StaysWhatItIs) { EXPECT_EQ(hash_of({1, 2, 3}), 0x84c90f9b9b137da4u); }

}  // namespace
}  // namespace carom::detail
