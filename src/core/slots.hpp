#pragma once

#include <cstdint>
#include <vector>

namespace carom::detail {

/// Hands out numbered places. A place that was released is given out again (the last released first), with a
/// new generation, so that a handle to what lived there before is recognised as stale.
class Slots {
  public:
    std::uint32_t acquire() {
        if (free_.empty()) {
            generations_.push_back(1);
            return static_cast<std::uint32_t>(generations_.size() - 1);
        }
        const std::uint32_t index = free_.back();
        free_.pop_back();
        ++generations_[index];  // odd while in use
        return index;
    }

    /// As many places that were never given out before, one after the other. Returns the first.
    std::uint32_t acquire_new(std::size_t count) {
        const std::uint32_t first = size();
        generations_.resize(first + count, 1);
        return first;
    }

    /// Will the next place be one that was used before?
    bool any_free() const { return !free_.empty(); }

    void release(std::uint32_t index) {
        ++generations_[index];
        free_.push_back(index);
    }

    bool in_use(std::uint32_t index) const {
        return index < generations_.size() && generations_[index] % 2 == 1;
    }

    template <class Id>
    bool contains(const Id& id) const {
        return id.index < generations_.size() && generations_[id.index] == id.generation &&
               id.generation % 2 == 1;
    }

    template <class Id>
    Id id(std::uint32_t index) const {
        return {index, generations_[index]};
    }

    /// One more than the highest place ever given out.
    std::uint32_t size() const { return static_cast<std::uint32_t>(generations_.size()); }
    std::uint32_t count() const { return size() - static_cast<std::uint32_t>(free_.size()); }

  private:
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint32_t> free_;
};

}  // namespace carom::detail
