#include "geometry/columns_in_lanes.hpp"

namespace carom::detail {

namespace {

using Four [[gnu::vector_size(32)]] = double;
using Index [[gnu::vector_size(32)]] = long long;

/// The same in all lanes.
struct Direction {
    Four x, y, z;
    explicit Direction(const double* v)
        : x{v[0], v[0], v[0], v[0]}, y{v[1], v[1], v[1], v[1]}, z{v[2], v[2], v[2], v[2]} {}
};

/// The products of four vectors with the direction: they have the bits of `dot`.
inline void products_of(const double* block, const Direction& v, Four& result) {
    Four x, y, z;
    __builtin_memcpy(&x, block, sizeof x);
    __builtin_memcpy(&y, block + 4, sizeof y);
    __builtin_memcpy(&z, block + 8, sizeof z);
    result = x * v.x + y * v.y + z * v.z;
}

std::size_t furthest(const double* blocks, std::size_t count, const double* direction) {
    const Direction v(direction);
    // In each of the four places of a block its own furthest, and the block that it is in.
    Four highest, now;
    Index at = {};
    products_of(blocks, v, highest);
    for (std::size_t i = 1; i < count; ++i) {
        products_of(blocks + 12 * i, v, now);
        const long long here = static_cast<long long>(i);
        const Index higher = now > highest;
        highest = higher ? now : highest;
        at = higher ? Index{here, here, here, here} : at;
    }
    std::size_t best = 4 * std::size_t(at[0]);
    double reached = highest[0];
    for (std::size_t place = 1; place < 4; ++place) {
        const std::size_t index = 4 * std::size_t(at[place]) + place;
        if (highest[place] < reached || (highest[place] == reached && index > best)) continue;
        reached = highest[place];
        best = index;
    }
    return best;
}

void products(const double* blocks, std::size_t count, const double* v, double* result) {
    const Direction along(v);
    for (std::size_t i = 0; i < count; ++i) {
        Four now;
        products_of(blocks + 12 * i, along, now);
        __builtin_memcpy(result + 4 * i, &now, sizeof now);
    }
}

void range(const double* blocks, std::size_t count, const double* direction, double* result) {
    const Direction v(direction);
    Four lowest, highest, now;
    products_of(blocks, v, lowest);
    highest = lowest;
    for (std::size_t i = 1; i < count; ++i) {
        products_of(blocks + 12 * i, v, now);
        lowest = now < lowest ? now : lowest;
        highest = now > highest ? now : highest;
    }
    result[0] = lowest[0];
    result[1] = highest[0];
    for (int place = 1; place < 4; ++place) {
        result[0] = lowest[place] < result[0] ? lowest[place] : result[0];
        result[1] = highest[place] > result[1] ? highest[place] : result[1];
    }
}

}  // namespace

const ColumnsKernel columns_kernel_8{furthest, products, range};

}  // namespace carom::detail
