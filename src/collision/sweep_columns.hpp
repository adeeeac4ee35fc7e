#pragma once

#include <cstdint>

namespace carom::detail {

/// Boxes in the order of their lower ends along the first axis, as columns of numbers; the axes stand in the
/// order of the sweep. A row that begins at infinity holds no box.
template <int D>
struct SweepColumns {
    const float* lower[D];
    const float* upper[D];
    const float* lower_before[D];  ///< the boxes as they were
    const float* upper_before[D];
};

/// Two rows of the columns, the second after the first.
struct SweepPair {
    std::uint32_t row, other;
};

/// How far a search came: it goes on with the rows from `next` on for the one at `row`.
struct SweepCursor {
    std::uint32_t row, next;
};

/// The search for one lane width.
template <int D>
struct SweepKernel {
    static constexpr std::uint32_t most_lanes = 16;

    /// Writes those rows from the cursor to `end` and rows after them whose boxes overlap and did not before,
    /// until all are found, and the cursor's row is `end`, or there may be no room for more than `room`
    /// pairs, of which `most_lanes` at least are asked for. Returns how many were written. After every row
    /// there must be one that begins beyond its end along the first axis, and `most_lanes` numbers in every
    /// column beyond that.
    std::uint32_t (*find)(const SweepColumns<D>& columns, SweepCursor& cursor, std::uint32_t end,
                          SweepPair* found, std::uint32_t room);
};

template <int D>
const SweepKernel<D>& sweep_kernel_1();
template <int D>
const SweepKernel<D>& sweep_kernel_4();
template <int D>
const SweepKernel<D>& sweep_kernel_8();
template <int D>
const SweepKernel<D>& sweep_kernel_16();

/// Of the width that `lane_width` says.
template <int D>
const SweepKernel<D>& sweep_kernel();

}  // namespace carom::detail
