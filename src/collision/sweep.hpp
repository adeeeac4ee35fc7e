#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/box.hpp"
#include "collision/sweep_columns.hpp"

namespace carom::detail {

/// Finds all pairs of overlapping boxes among many at once: sorts them along the axis on which they lie
/// furthest apart and sweeps over them, many at a time (Baraff 1992), within strips across the second such
/// axis. For a crowd in which most boxes are new this is far cheaper than a question to a tree for each. An
/// object of it keeps its buffers.
template <int D>
class Sweep {
  public:
    /// Calls `visit(a, b)` once for each two of the `listed` boxes, which are numbers into `boxes`, that
    /// overlap and of which one is marked in `fresh`. The order depends on the boxes, on that of `listed`,
    /// and on nothing else.
    template <class Visitor>
    void find(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes,
              std::span<const std::uint8_t> fresh, Visitor&& visit) {
        arrange(listed, boxes);
        const SweepKernel<D>& kernel = sweep_kernel<D>();
        const SweepColumns<D> columns = this->columns();
        for (std::uint32_t strip = 0; strip + 1 < starts_.size(); ++strip) {
            const std::uint32_t end = starts_[strip + 1] - SweepKernel<D>::most_lanes;
            for (std::uint32_t row = starts_[strip]; row < end; ++row) {
                const std::uint32_t count = kernel.overlapping(columns, row, found_.data());
                const Place& one = places_[row];
                for (std::uint32_t k = 0; k < count; ++k) {
                    const Place& other = places_[found_[k]];
                    // Two that share several strips meet in the first of these.
                    const bool here = std::max(one.first_strip, other.first_strip) == strip;
                    if (here && (fresh[one.box] || fresh[other.box])) visit(one.box, other.box);
                }
            }
        }
        for (std::size_t i = 0; i < wide_.size(); ++i) {
            const auto meet = [&](std::uint32_t other) {
                const bool new_one = fresh[wide_[i]] || fresh[other];
                if (new_one && overlaps(boxes[wide_[i]], boxes[other])) visit(wide_[i], other);
            };
            for (const Ordered& other : order_) meet(other.box);
            for (std::size_t k = i + 1; k < wide_.size(); ++k) meet(wide_[k]);
        }
    }

  private:
    /// A box in the order of the sweep; `key` orders as its lower end does.
    struct Ordered {
        std::uint32_t key, box;
        std::uint32_t first_strip, last_strip;
    };
    struct Place {
        std::uint32_t box, first_strip;
    };

    void arrange(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes);
    void choose_axes(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes);
    void sort();
    void fill_columns(std::span<const OuterBox<D>> boxes);
    std::uint32_t strip_of(float at) const;
    SweepColumns<D> columns() const;

    int axes_[D];            ///< of the sweep, of the strips, and the third
    float strip_begin_ = 0;  ///< where strip 0 begins
    float per_length_ = 0;   ///< strips a metre
    std::uint32_t strips_ = 1;
    std::vector<Ordered> order_, sorted_;
    std::vector<std::uint32_t> wide_;           ///< boxes across too many strips: compared with all
    std::vector<std::uint32_t> starts_, next_;  ///< places, by strip
    std::vector<Place> places_;
    std::vector<float> lower_[D], upper_[D];  ///< by place
    std::vector<std::uint32_t> found_;
};

}  // namespace carom::detail
