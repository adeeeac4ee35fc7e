#pragma once

#include <limits>

#include "collision/sweep_columns.hpp"
#include "simd/scalar.hpp"

namespace carom::detail {

/// The search of a sweep for the lanes `F`.
template <int D, class F>
struct SweepIn {
    /// A box, the same in every lane.
    struct Box {
        F lower[D], upper[D];

        Box(const float* const* lowers, const float* const* uppers, std::uint32_t row) {
            for (int i = 0; i < D; ++i) {
                lower[i] = F(lowers[i][row]);
                upper[i] = F(uppers[i][row]);
            }
        }
        /// Which of the boxes from the row `first` on lie beside it along axis i?
        CAROM_INLINE auto misses(const float* const* lowers, const float* const* uppers, std::uint32_t first,
                                 int i) const {
            return either(load_lanes<F>(lowers[i] + first) > upper[i],
                          lower[i] > load_lanes<F>(uppers[i] + first));
        }
    };

    static std::uint32_t find(const SweepColumns<D>& columns, SweepCursor& cursor, std::uint32_t end,
                              SweepPair* found, std::uint32_t room) {
        constexpr auto lanes = static_cast<std::uint32_t>(lane_count<F>);
        constexpr std::uint32_t all = (1u << lanes) - 1;
        SweepPair* next = found;
        for (std::uint32_t row = cursor.row; row < end; ++row, cursor = {row, row + 1}) {
            if (columns.lower[0][row] == std::numeric_limits<float>::infinity()) continue;
            const Box box(columns.lower, columns.upper, row);
            const Box box_before(columns.lower_before, columns.upper_before, row);
            for (std::uint32_t first = cursor.next;; first += lanes) {
                if (next + SweepKernel<D>::most_lanes > found + room) {
                    cursor = {row, first};
                    return static_cast<std::uint32_t>(next - found);
                }
                const auto beyond = load_lanes<F>(columns.lower[0] + first) > box.upper[0];
                auto apart = beyond;
                for (int i = 1; i < D; ++i)
                    apart = either(apart, box.misses(columns.lower, columns.upper, first, i));
                std::uint32_t bits = all & ~bits_of(apart);
                if (bits != 0) {
                    auto before = box_before.misses(columns.lower_before, columns.upper_before, first, 0);
                    for (int i = 1; i < D; ++i) {
                        before = either(
                            before, box_before.misses(columns.lower_before, columns.upper_before, first, i));
                    }
                    for (bits &= bits_of(before); bits != 0; bits &= bits - 1)
                        *next++ = {row, first + static_cast<std::uint32_t>(__builtin_ctz(bits))};
                }
                if (bits_of(beyond) != 0) break;
            }
        }
        return static_cast<std::uint32_t>(next - found);
    }

    static constexpr SweepKernel<D> kernel{&find};
};

}  // namespace carom::detail
