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

/// In each of the four places of a block its own furthest of every other block, and which block it is in.
struct Highest {
    Four height;
    Index block;

    void begin(const double* blocks, const Direction& v, long long at) {
        products_of(blocks + 12 * at, v, height);
        block = Index{at, at, at, at};
    }
    void look(const double* blocks, const Direction& v, long long at) {
        Four now;
        products_of(blocks + 12 * at, v, now);
        const Index higher = now > height;
        height = higher ? now : height;
        block = higher ? Index{at, at, at, at} : block;
    }
};

std::size_t furthest(const double* blocks, std::size_t count, const double* direction) {
    const Direction v(direction);
    const auto end = static_cast<long long>(count);
    // Two, so that one need not wait for the other.
    Highest even, odd;
    even.begin(blocks, v, 0);
    odd.begin(blocks, v, end > 1 ? 1 : 0);
    long long i = 2;
    for (; i + 1 < end; i += 2) {
        even.look(blocks, v, i);
        odd.look(blocks, v, i + 1);
    }
    if (i < end) even.look(blocks, v, i);
    // Of equal ones the first; nobody could tell which it is, so nothing branches.
    double reached = even.height[0];
    for (int place = 0; place < 4; ++place) {
        reached = even.height[place] > reached ? even.height[place] : reached;
        reached = odd.height[place] > reached ? odd.height[place] : reached;
    }
    long long best = 4 * end;
    for (int place = 0; place < 4; ++place) {
        const long long of_even = even.height[place] == reached ? 4 * even.block[place] + place : best;
        best = of_even < best ? of_even : best;
        const long long of_odd = odd.height[place] == reached ? 4 * odd.block[place] + place : best;
        best = of_odd < best ? of_odd : best;
    }
    return static_cast<std::size_t>(best);
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
