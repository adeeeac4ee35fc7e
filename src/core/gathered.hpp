#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/crew.hpp"

namespace carom::detail {

/// What several workers find side by side: a list for each stretch of what they look through. The stretches
/// depend on nothing but the numbers, so the lists one after the other are the same for any number of
/// workers. An object of it keeps its room.
template <class Item>
class Gathered {
  public:
    /// Empties the lists and runs `look(begin, end, list)` for each stretch of 0 … count.
    template <class Look>
    void look_through(Scheduler* scheduler, std::size_t count, std::size_t stretch, const Look& look) {
        used_ = (count + stretch - 1) / stretch;
        if (lists_.size() < used_) lists_.resize(used_);
        run_range(scheduler, used_, 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                lists_[i].items.clear();
                look(i * stretch, std::min(count, (i + 1) * stretch), lists_[i].items);
            }
        });
    }
    /// Calls `visit(item)` for all that were found, in the order of the stretches.
    template <class Visit>
    void each(const Visit& visit) const {
        for (std::size_t i = 0; i < used_; ++i)
            for (const Item& item : lists_[i].items) visit(item);
    }

  private:
    /// On a cache line of its own, as another worker fills the next one.
    struct alignas(64) List {
        std::vector<Item> items;
    };
    std::vector<List> lists_;
    std::size_t used_ = 0;
};

}  // namespace carom::detail
