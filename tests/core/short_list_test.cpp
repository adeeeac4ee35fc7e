#include "core/short_list.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "core/column.hpp"

namespace carom::detail {
namespace {

using List = ShortList<int>;

std::vector<int> all(const List& list) { return {list.begin(), list.end()}; }

TEST(ShortList, KeepsWhatItIsGivenInOrder) {
    for (int count = 0; count < 10; ++count) {
        List list;
        std::vector<int> expected;
        for (int i = 0; i < count; ++i) {
            list.push_back(7 * i);
            expected.push_back(7 * i);
        }
        EXPECT_EQ(all(list), expected);
        EXPECT_EQ(list.size(), expected.size());
        EXPECT_EQ(list.empty(), expected.empty());
        const List copy = list;
        EXPECT_EQ(all(copy), expected);
        List moved = std::move(list);
        EXPECT_EQ(all(moved), expected);
        moved.erase(7);
        std::erase(expected, 7);
        EXPECT_EQ(all(moved), expected);
        EXPECT_EQ(all(copy).size(), static_cast<std::size_t>(count));
        moved = List();
        EXPECT_TRUE(moved.empty());
    }
}

TEST(Column, BeginsWithZerosHoweverItGrows) {
    Column<double> column;
    for (std::size_t size = 1; size < 3000; size += 1 + size / 3) {
        column.resize(size);
        EXPECT_EQ(column.back(), 0);
        column.back() = 1;
    }
    std::size_t ones = 0;
    for (const double x : column) ones += x == 1;
    std::size_t expected = 0;
    for (std::size_t size = 1; size < 3000; size += 1 + size / 3) ++expected;
    EXPECT_EQ(ones, expected);
}

}  // namespace
}  // namespace carom::detail
