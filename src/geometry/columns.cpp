#include "geometry/columns.hpp"

#include <algorithm>
#include <cstring>

#include "geometry/columns_in_lanes.hpp"
#include "simd/width.hpp"

namespace carom::detail {

namespace {

/// What does the work in place of the loops below, or null.
const ColumnsKernel* kernel() {
#ifdef CAROM_WIDE_LANES
    if (lane_width() >= 8) return &columns_kernel_8;
#endif
    return nullptr;
}

template <class Blocks>
const double* doubles(const Blocks& blocks) {
    return reinterpret_cast<const double*>(blocks.data());
}

}  // namespace

Columns::Columns(const std::vector<Vec3>& list) : blocks_((list.size() + 3) / 4) {
    for (std::size_t i = 0; i < 4 * blocks_.size(); ++i) {
        const Vec3& v = list[std::min(i, list.size() - 1)];
        Block& block = blocks_[i / 4];
        block.x[i / 2 % 2][i % 2] = v.x;
        block.y[i / 2 % 2][i % 2] = v.y;
        block.z[i / 2 % 2][i % 2] = v.z;
    }
}

std::size_t Columns::furthest(const Vec3& direction) const {
    if (const auto* wide = kernel()) return wide->furthest(doubles(blocks_), blocks_.size(), &direction.x);
    // In each of the four places of a block its own furthest, and the block that it is in.
    Two highest[2], now[2];
    using Index [[gnu::vector_size(16)]] = long long;
    Index at[2] = {};
    products(blocks_[0], direction, highest);
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
        products(blocks_[i], direction, now);
        const long long here = static_cast<long long>(i);
        for (int k = 0; k < 2; ++k) {
            const Index higher = now[k] > highest[k];
            highest[k] = higher ? now[k] : highest[k];
            at[k] = (higher & here) | (~higher & at[k]);
        }
    }
    std::size_t best = 4 * std::size_t(at[0][0]);
    double reached = highest[0][0];
    for (std::size_t place = 1; place < 4; ++place) {
        const double height = highest[place / 2][place % 2];
        const std::size_t index = 4 * std::size_t(at[place / 2][place % 2]) + place;
        if (height < reached || (height == reached && index > best)) continue;
        reached = height;
        best = index;
    }
    return best;
}

void Columns::products(const Vec3& v, double* result) const {
    if (const auto* wide = kernel()) return wide->products(doubles(blocks_), blocks_.size(), &v.x, result);
    for (const Block& block : blocks_) {
        Two now[2];
        products(block, v, now);
        std::memcpy(result, now, sizeof now);
        result += 4;
    }
}

std::array<double, 2> Columns::range(const Vec3& direction) const {
    if (const auto* wide = kernel()) {
        std::array<double, 2> result;
        wide->range(doubles(blocks_), blocks_.size(), &direction.x, result.data());
        return result;
    }
    Two lowest[2], highest[2], now[2];
    products(blocks_[0], direction, lowest);
    for (int k = 0; k < 2; ++k) highest[k] = lowest[k];
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
        products(blocks_[i], direction, now);
        for (int k = 0; k < 2; ++k) {
            lowest[k] = now[k] < lowest[k] ? now[k] : lowest[k];
            highest[k] = now[k] > highest[k] ? now[k] : highest[k];
        }
    }
    return {std::min({lowest[0][0], lowest[0][1], lowest[1][0], lowest[1][1]}),
            std::max({highest[0][0], highest[0][1], highest[1][0], highest[1][1]})};
}

}  // namespace carom::detail
