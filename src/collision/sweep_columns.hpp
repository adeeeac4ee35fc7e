#pragma once

#include <cstdint>

namespace carom::detail {

/// Boxes in the order of their lower ends along the first axis, as columns of numbers; the axes stand in the
/// order of the sweep.
template <int D>
struct SweepColumns {
    const float* lower[D];
    const float* upper[D];
};

/// The search for one lane width.
template <int D>
struct SweepKernel {
    static constexpr std::uint32_t most_lanes = 16;

    /// Writes the places after `row` of the boxes that overlap the one there, up to the first box that begins
    /// beyond its end along the first axis, and returns how many these are. There must be such a box, and
    /// `most_lanes` numbers in every column and places in `found` beyond it.
    std::uint32_t (*overlapping)(const SweepColumns<D>& columns, std::uint32_t row, std::uint32_t* found);
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
