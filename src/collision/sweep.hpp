#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/box.hpp"
#include "collision/sweep_columns.hpp"
#include "core/gathered.hpp"

namespace carom::detail {

/// Did two boxes overlap, either of which may be `no_box`? That has no point in common with a box without
/// ends either.
template <int D>
constexpr bool overlapped(const OuterBox<D>& a, const OuterBox<D>& b) {
    return overlaps(a, b) && a.lower.x <= a.upper.x && b.lower.x <= b.upper.x;
}

/// Finds the pairs that begin to overlap among many boxes at once: sorts them along the axis on which they
/// lie furthest apart and sweeps over them, many at a time (Baraff 1992), within strips across the second
/// such axis. For a crowd in which most boxes are new this is far cheaper than a question to a tree for each.
/// An object of it keeps its buffers.
template <int D>
class Sweep {
  public:
    /// Two boxes by their numbers.
    struct Pair {
        std::uint32_t a, b;
    };

    /// Calls `visit(a, b)` once for each two of the `listed` boxes, which are numbers into `boxes`, that
    /// overlap and did not when they were as in `before`; one that is empty there (`no_box`) overlapped
    /// nothing. The order depends on the boxes, on that of `listed`, and on nothing else.
    template <class Visitor>
    void find(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes,
              std::span<const OuterBox<D>> before, Scheduler* scheduler, Visitor&& visit) {
        look(listed, boxes, before, scheduler);
        const auto visit_pair = [&](const Pair& pair) { visit(pair.a, pair.b); };
        pairs_.each(visit_pair);
        wide_pairs_.each(visit_pair);
    }

  private:
    /// A box in the order of the sweep; `key` orders as its lower end does.
    struct Ordered {
        std::uint32_t key, box;
        std::uint32_t first_strip, last_strip;
    };
    static constexpr std::uint32_t nobody = ~std::uint32_t{0};
    struct Place {
        std::uint32_t box = nobody;
        std::uint32_t strip = 0, first_strip = 0;  ///< that of this place, and the first that the box is in
    };

    void look(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes,
              std::span<const OuterBox<D>> before, Scheduler* scheduler);
    void look_along(std::uint32_t begin, std::uint32_t end, std::vector<Pair>& pairs) const;
    void arrange(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes);
    void choose_axes(std::span<const std::uint32_t> listed, std::span<const OuterBox<D>> boxes);
    void sort();
    void fill_columns(std::span<const OuterBox<D>> boxes, std::span<const OuterBox<D>> before,
                      Scheduler* scheduler);
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
    std::vector<float> lower_before_[D], upper_before_[D];
    Gathered<Pair> pairs_, wide_pairs_;
};

}  // namespace carom::detail
