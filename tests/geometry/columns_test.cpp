#include "geometry/columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "simd/width.hpp"

namespace carom::detail {
namespace {

/// Vectors with few different coordinates, so that many products are equal.
std::vector<Vec3> some_vectors(std::mt19937_64& random, std::size_t count) {
    const auto coordinate = [&] { return 0.375 * static_cast<double>(random() % 9) - 1.5; };
    std::vector<Vec3> list(count);
    for (Vec3& v : list) v = {coordinate(), coordinate(), coordinate()};
    return list;
}

TEST(Columns, say_what_one_vector_after_the_other_says_at_any_width) {
    std::mt19937_64 random(20261123);
    for (std::size_t count = 1; count <= 70; ++count) {
        const std::vector<Vec3> list = some_vectors(random, count);
        const Columns columns(list);
        for (int trial = 0; trial < 20; ++trial) {
            const Vec3 direction = some_vectors(random, 1)[0];
            std::size_t furthest = 0;
            double lowest = dot(list[0], direction), highest = lowest;
            for (std::size_t i = 1; i < count; ++i) {
                const double product = dot(list[i], direction);
                if (product > highest) furthest = i;
                lowest = std::min(lowest, product);
                highest = std::max(highest, product);
            }
            for (const int width : {1, 4, 8, 16}) {
                if (!can_run_lanes(width)) continue;
                set_lane_width(width);
                EXPECT_EQ(columns.furthest(direction), furthest) << count << " vectors, width " << width;
                const auto range = columns.range(direction);
                EXPECT_EQ(range[0], lowest);
                EXPECT_EQ(range[1], highest);
                std::vector<double> products(columns.padded_size());
                columns.products(direction, products.data());
                for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(products[i], dot(list[i], direction));
            }
            set_lane_width(0);
        }
    }
}

}  // namespace
}  // namespace carom::detail
