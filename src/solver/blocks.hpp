#pragma once

#include <cstdint>
#include <vector>

#include "solver/lane_store.hpp"
#include "solver/passes.hpp"

namespace carom::detail {

/// Blocks of contacts in the order in which they are solved. A place is a lane of a block: place p is lane
/// p mod width of block p / width.
template <int D>
class ContactBlocks {
  public:
    using Rows = ContactRows<D, float>;
    static constexpr std::uint32_t nobody = 0;  ///< slot of a lane that holds no contact

    void clear(const Passes<D>& passes) {
        passes_ = &passes;
        rows_.set_width(passes.width);
        resize(0);
    }
    /// Appends blocks for this many contacts and returns the first place. The rows are not yet defined.
    std::size_t append(std::size_t contacts) {
        const std::size_t first = places();
        resize(first / rows_.width() + rows_.blocks_for(contacts));
        return first;
    }

    const Passes<D>& passes() const { return *passes_; }
    std::size_t width() const { return rows_.width(); }
    std::size_t blocks() const { return traits_.size(); }
    std::size_t places() const { return a_.size(); }
    bool empty() const { return a_.empty(); }

    LaneStore<Rows>& rows() { return rows_; }
    const LaneStore<Rows>& rows() const { return rows_; }
    std::uint32_t& a(std::size_t place) { return a_[place]; }
    std::uint32_t& b(std::size_t place) { return b_[place]; }
    std::uint8_t& traits(std::size_t block) { return traits_[block]; }

    /// The blocks from `first` on, `count` of them.
    BlockSpan<D> span(std::size_t first, std::size_t count) {
        const std::size_t place = first * width();
        BlockSpan<D> span;
        span.rows = rows_.data() + place * LaneStore<Rows>::fields;
        span.a = a_.data() + place;
        span.b = b_.data() + place;
        span.traits = traits_.data() + first;
        span.blocks = count;
        return span;
    }
    BlockSpan<D> span() { return span(0, blocks()); }

  private:
    void resize(std::size_t blocks) {
        rows_.resize(blocks);
        a_.resize(blocks * width(), nobody);
        b_.resize(blocks * width(), nobody);
        traits_.resize(blocks, 0);
    }

    const Passes<D>* passes_ = nullptr;
    LaneStore<Rows> rows_;
    std::vector<std::uint32_t> a_, b_;
    std::vector<std::uint8_t> traits_;
};

}  // namespace carom::detail
