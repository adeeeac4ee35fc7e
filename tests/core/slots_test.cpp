#include "core/slots.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "carom/ids.hpp"

namespace carom::detail {
namespace {

using TestId = BodyId<2>;

TEST(Slots, CountUpwardsFromZero) {
    Slots slots;
    for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(slots.acquire(), i);
    EXPECT_EQ(slots.size(), 5u);
    EXPECT_EQ(slots.count(), 5u);
}

TEST(Slots, GiveTheLastReleasedPlaceFirst) {
    Slots slots;
    for (int i = 0; i < 4; ++i) slots.acquire();
    slots.release(1);
    slots.release(3);
    EXPECT_EQ(slots.count(), 2u);
    EXPECT_EQ(slots.acquire(), 3u);
    EXPECT_EQ(slots.acquire(), 1u);
    EXPECT_EQ(slots.acquire(), 4u);
}

TEST(Slots, TheDefaultHandleNamesNothing) {
    Slots slots;
    EXPECT_FALSE(slots.contains(TestId{}));
    slots.acquire();
    EXPECT_FALSE(slots.contains(TestId{}));
    EXPECT_FALSE(slots.contains(TestId{0, 0}));
    EXPECT_FALSE(slots.contains(TestId{5, 1}));
}

TEST(Slots, AHandleIsStaleOnceItsPlaceIsReleased) {
    Slots slots;
    const TestId first = slots.id<TestId>(slots.acquire());
    EXPECT_TRUE(slots.contains(first));
    EXPECT_TRUE(slots.in_use(first.index));
    slots.release(first.index);
    EXPECT_FALSE(slots.contains(first));
    EXPECT_FALSE(slots.in_use(first.index));
    // The handle that a released place would have had is not valid either.
    EXPECT_FALSE(slots.contains(TestId{first.index, first.generation + 1}));
    const TestId second = slots.id<TestId>(slots.acquire());
    EXPECT_EQ(second.index, first.index);
    EXPECT_NE(second, first);
    EXPECT_TRUE(slots.contains(second));
    EXPECT_FALSE(slots.contains(first));
}

TEST(Slots, DoAsAMapOfHandles) {
    std::mt19937_64 random(11);
    Slots slots;
    std::map<std::uint32_t, TestId> live;
    std::vector<TestId> dead;
    for (int i = 0; i < 20000; ++i) {
        if (random() % 5 < 3 || live.empty()) {
            const std::uint32_t index = slots.acquire();
            ASSERT_FALSE(live.contains(index)) << "a place in use was given out";
            live[index] = slots.id<TestId>(index);
        } else {
            auto it = live.lower_bound(static_cast<std::uint32_t>(random() % slots.size()));
            if (it == live.end()) it = live.begin();
            slots.release(it->first);
            dead.push_back(it->second);
            live.erase(it);
        }
        ASSERT_EQ(slots.count(), live.size());
    }
    for (const auto& [index, id] : live) {
        ASSERT_TRUE(slots.contains(id));
        ASSERT_TRUE(slots.in_use(index));
    }
    for (const TestId& id : dead) ASSERT_FALSE(slots.contains(id));
}

}  // namespace
}  // namespace carom::detail
