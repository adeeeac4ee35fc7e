#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace carom::detail {

/// Groups of things that touch one another, by union and find (Tarjan 1975) with path halving. The smaller
/// index becomes the root, so that the result does not depend on the order of the calls.
class Islands {
  public:
    void reset(std::size_t count) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace carom::detail
