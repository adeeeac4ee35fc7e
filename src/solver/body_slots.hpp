#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/body.hpp"

namespace carom::detail {

/// The bodies that move, close together: each has a slot for as long as it moves. Slot 0 stands for all that
/// stands still; then come those that only the user moves, and from `first_movable` on those that can be
/// pushed.
class BodySlots {
  public:
    static constexpr std::uint32_t still = 0;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// Gives a slot to each of these bodies, and takes it from all others. Returns whether any slot changed.
    bool follow(std::span<const std::uint32_t> awake, std::span<const BodyType> types);

    std::uint32_t slot(std::uint32_t body) const { return body < slot_.size() ? slot_[body] : still; }
    /// Of the slot, or `none`.
    std::uint32_t body(std::uint32_t slot) const { return body_[slot]; }
    /// Did the body get another slot when `follow` was last called?
    bool changed(std::uint32_t body) const { return body < changed_.size() && changed_[body]; }
    std::uint32_t first_movable() const { return first_movable_; }
    /// One more than the last slot.
    std::uint32_t size() const { return static_cast<std::uint32_t>(body_.size()); }

  private:
    void take(std::uint32_t body, bool dynamic);
    void release(std::uint32_t body);
    void mark(std::uint32_t body);

    std::uint32_t first_movable_ = 8;
    std::vector<std::uint32_t> slot_;                         ///< by body
    std::vector<std::uint32_t> body_ = std::vector(8, none);  ///< by slot
    std::vector<std::uint32_t> free_;              ///< of the movable slots; the last is taken first
    std::vector<std::uint32_t> followed_;          ///< the bodies that have a slot
    std::vector<std::uint8_t> changed_, follows_;  ///< by body
    std::vector<std::uint32_t> changes_;           ///< bodies that changed
};

}  // namespace carom::detail
