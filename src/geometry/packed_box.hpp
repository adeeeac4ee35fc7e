#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "math/dim.hpp"

namespace carom::detail {

/// Four floats that are worked on at once, with the bits of one by one.
using Four [[gnu::vector_size(16)]] = float;

inline Four least(const Four& a, const Four& b) { return a < b ? a : b; }
inline Four greatest(const Four& a, const Four& b) { return a > b ? a : b; }

/// A box in the plane or in space in single precision, with two numbers in the places that are left.
struct PackedBox {
    Four lower, upper;

    std::uint32_t number() const { return std::bit_cast<Bits>(lower)[3] ^ common; }
    /// Less than 2^30.
    void set_number(std::uint32_t n) {
        Bits bits = std::bit_cast<Bits>(lower);
        bits[3] = n ^ common;
        lower = std::bit_cast<Four>(bits);
    }
    /// Twice the middle.
    Four center() const { return lower + upper; }

  private:
    using Bits = std::array<std::uint32_t, 4>;
    /// With this bit no number is a denormal float, with which processors are slow.
    static constexpr std::uint32_t common = 1u << 30;
};

/// What holds all boxes that it was told of.
struct PackedBounds {
    static constexpr float most = std::numeric_limits<float>::infinity();
    Four lower{most, most, most, most}, upper{-most, -most, -most, -most};

    void hold(const Four& point) {
        lower = least(lower, point);
        upper = greatest(upper, point);
    }
    template <class Box>
    void hold(const Box& box) {
        lower = least(lower, box.lower);
        upper = greatest(upper, box.upper);
    }
};

/// Half of the perimeter (2D) or of the surface (3D): how likely a random line is to hit the box.
template <int D>
float half_surface(const PackedBounds& box) {
    const Four size = box.upper - box.lower;
    if constexpr (D == 2)
        return size[0] + size[1];
    else
        return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

/// How boxes are parted in two: by the surface-area heuristic over bins of their middles (Wald: On fast
/// Construction of SAH-based Bounding Volume Hierarchies, 2007). Bins of the same boxes are the same whatever
/// the order in which, and the number of parts from which, they were gathered.
template <int D>
class Bins {
  public:
    static constexpr int most_bins = 16;

    /// For `count` boxes whose middles, taken twice, have these bounds.
    Bins(const PackedBounds& centers, std::size_t count)
        : count_(int(std::min<std::size_t>(most_bins, count))), lowest_(centers.lower) {
        const Four size = centers.upper - centers.lower;
        for (int i = 0; i < D; ++i) {
            scale_[i] = size[i] > 1e-20f ? float(count_) / size[i] : 0;  // or all in one place
            for (int k = 0; k < count_; ++k) rows_[i][k] = {};
        }
    }

    void add(const PackedBox& box) {
        const std::array<std::int32_t, 4> places = places_of(box);
        for (int i = 0; i < D; ++i) {
            Bin& bin = rows_[i][places[i]];
            bin.bounds.hold(box);
            ++bin.count;
        }
    }
    void add(const Bins& others) {
        for (int i = 0; i < D; ++i) {
            for (int k = 0; k < count_; ++k) rows_[i][k].add(others.rows_[i][k]);
        }
    }

    /// What a border between two bins makes of the boxes.
    struct Side {
        PackedBounds bounds;
        std::uint32_t count = 0;

        void add(const Side& other) {
            bounds.hold(other.bounds);
            count += other.count;
        }
        float cost() const { return half_surface<D>(bounds) * float(count); }
    };
    struct Border {
        int axis = -1;  ///< none: all boxes are in one place
        int place = 0;
        Side below, above;
    };
    /// The border at which surface × number, summed over both sides, is least.
    Border cheapest() const {
        Border best;
        float least_cost = PackedBounds::most;
        for (int i = 0; i < D; ++i) {
            if (scale_[i] == 0) continue;
            std::array<Side, most_bins> above;
            Side side;
            for (int k = count_ - 1; k > 0; --k) {
                side.add(rows_[i][k]);
                above[k] = side;
            }
            side = {};
            for (int k = 1; k < count_; ++k) {
                side.add(rows_[i][k - 1]);
                if (side.count == 0 || above[k].count == 0) continue;
                const float cost = side.cost() + above[k].cost();
                if (cost >= least_cost) continue;
                least_cost = cost;
                best = {i, k, side, above[k]};
            }
        }
        return best;
    }
    bool is_below(const Border& border, const PackedBox& box) const {
        const float along =
            (box.lower[border.axis] + box.upper[border.axis] - lowest_[border.axis]) * scale_[border.axis];
        return std::min(int(along), count_ - 1) < border.place;
    }

  private:
    using Bin = Side;

    std::array<std::int32_t, 4> places_of(const PackedBox& box) const {
        using Ints [[gnu::vector_size(16)]] = std::int32_t;
        const Ints places = __builtin_convertvector((box.center() - lowest_) * scale_, Ints);
        const Ints last = Ints{} + (count_ - 1);
        return std::bit_cast<std::array<std::int32_t, 4>>(places < last ? places : last);
    }

    int count_;
    Four lowest_, scale_{};
    std::array<std::array<Bin, most_bins>, D> rows_;
};

}  // namespace carom::detail
