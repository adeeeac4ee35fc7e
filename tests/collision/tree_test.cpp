#include "collision/tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "random.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <int D>
Aabb<D> random_box(Random& random, double world, double largest) {
    const Vec<D> center = random.in_cube<D>(world);
    Vec<D> half;
    for (int i = 0; i < D; ++i) half[i] = random.between(0, largest);
    return {center - half, center + half};
}

template <int D>
using Boxes = std::map<std::uint32_t, OuterBox<D>>;  // by payload

template <int D>
void expect_same_answers(const Tree<D>& tree, const Boxes<D>& boxes, Random& random) {
    ASSERT_TRUE(tree.validate());
    ASSERT_EQ(tree.size(), std::int32_t(boxes.size()));
    for (int k = 0; k < 10; ++k) {
        const OuterBox<D> window = random_box<D>(random, 10, 4);
        std::multiset<std::uint32_t> expected, found;
        for (const auto& [payload, box] : boxes)
            if (overlaps(box, window)) expected.insert(payload);
        tree.query(window, [&](std::uint32_t payload) { found.insert(payload); });
        ASSERT_EQ(found, expected);
    }
}

TEST(OuterBox, holds_the_box_and_is_hardly_larger) {
    Random random(21);
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 10000; ++i) {
        const double x = random.between(-1, 1) * std::pow(10.0, random.between(-60, 60));
        const float below = rounded_down(x), above = rounded_up(x);
        ASSERT_LE(below, x);
        ASSERT_GE(above, x);
        ASSERT_GE(std::nextafter(below, infinite), above);
    }
    for (const double x : {0.0, 1.0, -2.5, 1e30f * 1.0}) {
        EXPECT_EQ(rounded_down(x), x);
        EXPECT_EQ(rounded_up(x), x);
    }
    EXPECT_EQ(rounded_up(1e300), infinite);
    EXPECT_EQ(rounded_down(-1e300), -infinite);
    EXPECT_EQ(rounded_down(1e300), std::numeric_limits<float>::max());
    EXPECT_EQ(rounded_up(1e-300), std::numeric_limits<float>::denorm_min());
}

template <class T>
class TreeTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(TreeTest, Dimensions);

TYPED_TEST(TreeTest, answers_like_brute_force_through_random_changes) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        Tree<D> tree;
        Boxes<D> boxes;
        std::map<std::uint32_t, std::int32_t> leaves;
        std::uint32_t next = 0xfffffff0u;  // payloads use all 32 bits
        for (int step = 0; step < 600; ++step) {
            const int choice = random.below(step < 300 ? 10 : 20);
            if (boxes.empty() || choice < 6) {
                const OuterBox<D> box = random_box<D>(random, 10, 1);
                leaves[next] = tree.insert(box, next);
                boxes[next++] = box;
            } else {
                auto it = std::next(boxes.begin(), random.below(int(boxes.size())));
                const std::int32_t leaf = leaves[it->first];
                if (choice < 9) {
                    const double stride = choice == 8 ? 10 : 0.1;
                    const Vec<D> shift = random.in_cube<D>(stride);
                    const Aabb<D> box = widened(it->second);
                    it->second = Aabb<D>{box.lower + shift, box.upper + shift};
                    tree.move(leaf, it->second);
                    ASSERT_EQ(tree.box(leaf), it->second);
                    ASSERT_EQ(tree.payload(leaf), it->first);
                } else {
                    tree.remove(leaf);
                    leaves.erase(it->first);
                    boxes.erase(it);
                }
            }
            if (step % 200 == 199) tree.rebuild();
            if (step % 20 == 0 || step % 200 == 199) expect_same_answers(tree, boxes, random);
        }
        while (!boxes.empty()) {
            tree.remove(leaves[boxes.begin()->first]);
            boxes.erase(boxes.begin());
            ASSERT_TRUE(tree.validate());
        }
        EXPECT_EQ(tree.size(), 0);
        EXPECT_EQ(tree.height(), 0);
    }
}

TYPED_TEST(TreeTest, finds_every_pair_once) {
    constexpr int D = TypeParam::value;
    Random random(7);
    for (const int count : {0, 1, 2, 3, 50, 400}) {
        std::vector<typename Tree<D>::Entry> here, there;
        for (int i = 0; i < count; ++i) here.push_back({random_box<D>(random, 10, 1), std::uint32_t(i)});
        for (int i = 0; i < count / 2; ++i)
            there.push_back({random_box<D>(random, 10, 1), std::uint32_t(1000 + i)});
        Tree<D> a, b;
        a.build(here);
        for (const auto& entry : there) b.insert(entry.box, entry.payload);

        using Pairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;
        Pairs expected, found;
        for (const auto& x : here)
            for (const auto& y : there)
                if (overlaps(x.box, y.box)) expected.emplace(x.payload, y.payload);
        a.query_pairs(b, [&](std::uint32_t x, std::uint32_t y) { found.emplace(x, y); });
        EXPECT_EQ(found, expected);

        expected.clear();
        found.clear();
        for (const auto& x : here)
            for (const auto& y : here)
                if (x.payload < y.payload && overlaps(x.box, y.box)) expected.emplace(x.payload, y.payload);
        a.query_pairs(
            a, [&](std::uint32_t x, std::uint32_t y) { found.emplace(std::min(x, y), std::max(x, y)); });
        EXPECT_EQ(found, expected);
    }
}

TYPED_TEST(TreeTest, building_numbers_the_leaves_like_the_entries) {
    constexpr int D = TypeParam::value;
    Random random(3);
    std::vector<typename Tree<D>::Entry> entries;
    for (std::uint32_t i = 0; i < 100; ++i) entries.push_back({random_box<D>(random, 10, 1), 5 * i});
    Tree<D> tree;
    tree.insert(entries[7].box, 7);  // is replaced
    tree.build(entries);
    ASSERT_TRUE(tree.validate());
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(tree.payload(std::int32_t(i)), 5 * i);
        EXPECT_EQ(tree.box(std::int32_t(i)), entries[i].box);
    }
}

TYPED_TEST(TreeTest, moves_many_at_once_and_stays_good) {
    constexpr int D = TypeParam::value;
    Random random(8);
    Tree<D> tree;
    Boxes<D> boxes;
    std::vector<std::int32_t> leaves;
    for (std::uint32_t i = 0; i < 400; ++i) {
        boxes[i] = random_box<D>(random, 10, 0.5);
        leaves.push_back(tree.insert(boxes[i], i));
    }
    for (int round = 0; round < 200; ++round) {
        std::vector<std::int32_t> moved;
        for (std::uint32_t i = 0; i < 400; ++i) {
            if (random.below(3) == 0) continue;
            const Vec<D> shift = random.in_cube<D>(random.below(20) == 0 ? 3 : 0.2);
            const Aabb<D> box = widened(boxes[i]);
            boxes[i] = Aabb<D>{box.lower + shift, box.upper + shift};
            moved.push_back(leaves[i]);
        }
        tree.move_all(moved, [&](std::uint32_t payload) -> const OuterBox<D>& { return boxes[payload]; });
        if (round % 20 == 0) expect_same_answers(tree, boxes, random);
    }
    expect_same_answers(tree, boxes, random);
    const double moved = tree.cost();
    tree.rebuild();
    EXPECT_LE(moved, 1.3 * tree.cost());
    tree.clear();
    tree.move_all({}, [&](std::uint32_t payload) -> const OuterBox<D>& { return boxes[payload]; });
    EXPECT_TRUE(tree.validate());
}

TYPED_TEST(TreeTest, holds_infinite_and_equal_boxes) {
    constexpr int D = TypeParam::value;
    Random random(5);
    Tree<D> tree;
    Boxes<D> boxes;
    const auto add = [&](const Aabb<D>& box) {
        const auto payload = std::uint32_t(boxes.size());
        tree.insert(box, payload);
        boxes[payload] = box;
    };
    Aabb<D> half_space, everything;
    for (int i = 0; i < D; ++i) {
        everything.lower[i] = half_space.lower[i] = -1e300;
        everything.upper[i] = half_space.upper[i] = 1e300;
    }
    half_space.upper[1] = 0;
    for (int i = 0; i < 100; ++i) {
        add(random_box<D>(random, 10, 1));
        add(Aabb<D>{});
        if (i % 25 == 0) add(half_space);
        if (i % 25 == 1) add(everything);
    }
    expect_same_answers(tree, boxes, random);
    tree.rebuild();
    expect_same_answers(tree, boxes, random);
}

TYPED_TEST(TreeTest, stays_good_when_boxes_come_in_order) {
    constexpr int D = TypeParam::value;
    Tree<D> row;
    for (int i = 0; i < 4096; ++i) {
        Aabb<D> box;
        for (int k = 0; k < D; ++k) box.upper[k] = 1;
        box.lower.x += 1.5 * i;
        box.upper.x += 1.5 * i;
        row.insert(box, std::uint32_t(i));
    }
    EXPECT_LE(row.height(), 30);
    const double inserted = row.cost();
    row.rebuild();
    EXPECT_LE(row.height(), 14);
    EXPECT_LE(inserted, 1.5 * row.cost());
}

TYPED_TEST(TreeTest, inserting_comes_close_to_building_at_once) {
    constexpr int D = TypeParam::value;
    Random random(11);
    Tree<D> tree;
    for (std::uint32_t i = 0; i < 3000; ++i) tree.insert(random_box<D>(random, 50, 0.5), i);
    const double inserted = tree.cost();
    tree.rebuild();
    ASSERT_TRUE(tree.validate());
    EXPECT_LE(inserted, 1.2 * tree.cost());
}

}  // namespace
}  // namespace carom::detail
