#pragma once

#include "collision/sweep_columns.hpp"
#include "simd/scalar.hpp"

namespace carom::detail {

/// The search of a sweep for the lanes `F`.
template <int D, class F>
struct SweepIn {
    static std::uint32_t overlapping(const SweepColumns<D>& columns, std::uint32_t row,
                                     std::uint32_t* found) {
        constexpr auto lanes = static_cast<std::uint32_t>(lane_count<F>);
        constexpr std::uint32_t all = (1u << lanes) - 1;
        F lower[D], upper[D];
        for (int i = 0; i < D; ++i) {
            lower[i] = F(columns.lower[i][row]);
            upper[i] = F(columns.upper[i][row]);
        }
        std::uint32_t* next = found;
        for (std::uint32_t first = row + 1;; first += lanes) {
            const auto beyond = load_lanes<F>(columns.lower[0] + first) > upper[0];
            auto apart = beyond;
            for (int i = 1; i < D; ++i) {
                const auto above = load_lanes<F>(columns.lower[i] + first) > upper[i];
                const auto below = lower[i] > load_lanes<F>(columns.upper[i] + first);
                apart = either(apart, either(above, below));
            }
            for (std::uint32_t bits = all & ~bits_of(apart); bits != 0; bits &= bits - 1)
                *next++ = first + static_cast<std::uint32_t>(__builtin_ctz(bits));
            if (bits_of(beyond) != 0) return static_cast<std::uint32_t>(next - found);
        }
    }

    static constexpr SweepKernel<D> kernel{&overlapping};
};

}  // namespace carom::detail
