#include "solver/blocks.hpp"

#include <gtest/gtest.h>

#include "simd/width.hpp"

namespace carom::detail {
namespace {

using Rows = ContactRows<3, float>;

Rows numbered(float start) {
    LaneStore<Rows>::Floats floats;
    for (std::size_t f = 0; f < floats.size(); ++f) floats[f] = start + static_cast<float>(f);
    return std::bit_cast<Rows>(floats);
}

TEST(LaneStore, RecordsComeBackAsTheyWereSet) {
    for (const int width : {1, 4, 8, 16}) {
        LaneStore<Rows> store;
        store.set_width(width);
        constexpr std::size_t count = 37;
        EXPECT_EQ(store.blocks_for(count), (count + width - 1) / width);
        store.resize(store.blocks_for(count));
        for (std::size_t i = 0; i < count; ++i) store.set(i, numbered(1000.0f * static_cast<float>(i)));
        const Rows model;
        for (std::size_t i = 0; i < count; ++i) {
            const Rows expected = numbered(1000.0f * static_cast<float>(i)), found = store.get(i);
            EXPECT_EQ(std::bit_cast<LaneStore<Rows>::Floats>(found),
                      std::bit_cast<LaneStore<Rows>::Floats>(expected));
            EXPECT_EQ(store.at(i, field_of(model, model.points[2].impulse)), expected.points[2].impulse);
        }
    }
}

/// The lanes of a block lie side by side, field by field, which is what the passes take for granted.
TEST(LaneStore, FieldsOfABlockAreRowsOfLanes) {
    LaneStore<Rows> store;
    store.set_width(8);
    store.resize(2);
    for (std::size_t i = 0; i < 16; ++i) store.set(i, numbered(1000.0f * static_cast<float>(i)));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(store.data()) % 64, 0u);
    for (std::size_t f = 0; f < LaneStore<Rows>::fields; ++f) {
        for (std::size_t lane = 0; lane < 8; ++lane) {
            const float second = store.data()[(LaneStore<Rows>::fields + f) * 8 + lane];
            EXPECT_EQ(second, 1000.0f * static_cast<float>(8 + lane) + static_cast<float>(f));
        }
    }
}

TEST(ContactBlocks, EachGroupStartsABlockOfItsOwn) {
    ContactBlocks<2> blocks;
    const Passes<2>& passes = passes_of_width<2>(can_run_lanes(4) ? 4 : 1);
    const auto width = static_cast<std::size_t>(passes.width);
    blocks.clear(passes);
    EXPECT_TRUE(blocks.empty());
    EXPECT_EQ(blocks.append(5), 0u);
    const std::size_t second = blocks.append(1);
    EXPECT_EQ(second % width, 0u);
    EXPECT_GE(second, 5u);
    EXPECT_EQ(blocks.places(), blocks.blocks() * width);
    for (std::size_t place = 0; place < blocks.places(); ++place) {
        EXPECT_EQ(blocks.a(place), ContactBlocks<2>::nobody);
        EXPECT_EQ(blocks.b(place), ContactBlocks<2>::nobody);
    }
    blocks.a(second) = 7;
    const BlockSpan<2> last = blocks.span(second / width, 1);
    EXPECT_EQ(last.a[0], 7u);
    using Fields = LaneStore<ContactRows<2, float>>;
    EXPECT_EQ(last.rows, blocks.rows().data() + second * Fields::fields);
    blocks.clear(passes);
    EXPECT_EQ(blocks.append(1), 0u);
    EXPECT_EQ(blocks.a(0), ContactBlocks<2>::nobody) << "nothing is left of what was there";
}

}  // namespace
}  // namespace carom::detail
