#include "geometry/facet_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>

#include "../collision/random.hpp"

// The tree of a mesh's facets, built by one thread and by several.

namespace carom::test {
namespace {

using detail::FacetTree;

template <class T>
struct FacetTrees : testing::Test {};
using BothDimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FacetTrees, BothDimensions);

/// Boxes around `base`, of many sizes; a few lie in one place.
template <int D>
std::vector<typename FacetTree<D>::Item> random_items(int count, const Vec<D>& base, Random& random) {
    std::vector<typename FacetTree<D>::Item> items;
    for (int i = 0; i < count; ++i) {
        const Vec<D> center = base + (random.below(20) == 0 ? Vec<D>{} : random.in_cube<D>(100));
        Vec<D> half;
        for (int k = 0; k < D; ++k) half[k] = random.below(4) == 0 ? 0 : random.between(0, 2);
        items.push_back({{center - half, center + half}, std::uint32_t(i)});
    }
    return items;
}

template <int D>
std::vector<std::uint32_t> found_in(const FacetTree<D>& tree, const Aabb<D>& box) {
    std::vector<std::uint32_t> found;
    tree.query(box, [&](std::uint32_t facet) { found.push_back(facet); });
    return found;
}

TYPED_TEST(FacetTrees, are_the_same_however_many_threads_build_them) {
    constexpr int D = TypeParam::value;
    Random random(41);
    const auto items = random_items<D>(100'000, Vec<D>{}, random);
    FacetTree<D> alone;
    alone.build(items);
    for (const int threads : {1, 2, 5}) {
        FacetTree<D> together;
        const auto pool = make_thread_pool(threads);
        together.build(items, pool.get());
        ASSERT_EQ(together.bytes(), alone.bytes());
        for (int i = 0; i < 200; ++i) {
            const Vec<D> center = random.in_cube<D>(100), half = random.between(0, 10) * Vec<D>{1, 1};
            const Aabb<D> box{center - half, center + half};
            ASSERT_EQ(found_in(together, box), found_in(alone, box));  // in the same order, too
        }
    }
}

TYPED_TEST(FacetTrees, miss_nothing_wherever_they_are) {
    constexpr int D = TypeParam::value;
    Random random(42);
    for (const double distance : {0.0, 1e3, 1e7}) {
        const Vec<D> base = distance * random.direction<D>();
        const auto items = random_items<D>(3000, base, random);
        FacetTree<D> tree;
        tree.build(items);
        for (int i = 0; i < 300; ++i) {
            // Every other question touches an item's box with a corner alone.
            Aabb<D> box{base + random.in_cube<D>(100), {}};
            box.upper = box.lower;
            if (i % 2 == 0) box.lower = box.upper = items[std::size_t(random.below(3000))].box.upper;
            const auto found = found_in(tree, box);
            for (const auto& item : items) {
                bool meets = true;
                for (int k = 0; k < D; ++k)
                    meets &= item.box.lower[k] <= box.upper[k] && box.lower[k] <= item.box.upper[k];
                // Once, and a few that are near besides.
                const auto times = std::ranges::count(found, item.facet);
                ASSERT_TRUE(times == 1 || (times == 0 && !meets)) << distance << ", " << i;
            }
        }
    }
}

}  // namespace
}  // namespace carom::test
