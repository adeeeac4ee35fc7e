#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace carom::detail {

/// Slots of the two bodies of a contact.
struct SlotPair {
    std::uint32_t a = 0, b = 0;
};

/// Deals contacts into colours: no two contacts of one colour share a body that can be pushed, so those of a
/// colour can be solved side by side, and in any order with the same result. Each contact takes the first
/// colour that is free at both of its bodies (greedy colouring), so the colours follow from the order of the
/// contacts alone. Contacts with a body that cannot be pushed have the last colours: what stands on the
/// ground is then pushed last in every pass, which stiffens stacks. What finds no colour is the overflow.
class Colours {
  public:
    static constexpr int between_movable = 40, with_fixed = 24;
    static constexpr int count = between_movable + with_fixed;
    static constexpr int overflow = count;

    /// Slots below `first_movable` are of bodies that cannot be pushed; `slots` is one more than the last
    /// slot.
    void deal(std::span<const SlotPair> contacts, std::uint32_t first_movable, std::size_t slots) {
        taken_.assign(slots, 0);
        colour_.resize(contacts.size());
        sizes_.fill(0);
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const auto [a, b] = contacts[i];
            const bool fixed = a < first_movable || b < first_movable;
            const std::uint64_t free = ~(taken_[a] | taken_[b]) & (fixed ? last_colours : first_colours);
            const int colour = std::countr_zero(free);  // 64, the overflow, when none is free
            const std::uint64_t bit = free & (~free + 1);
            if (a >= first_movable) taken_[a] |= bit;
            if (b >= first_movable) taken_[b] |= bit;
            colour_[i] = static_cast<std::uint8_t>(colour);
            ++sizes_[colour];
        }
    }

    /// Of the contact with this index, or `overflow`.
    int operator[](std::size_t contact) const { return colour_[contact]; }
    /// How many contacts have the colour, or none.
    std::size_t size(int colour) const { return sizes_[colour]; }

  private:
    static constexpr std::uint64_t first_colours = (std::uint64_t{1} << between_movable) - 1;
    static constexpr std::uint64_t last_colours = ~first_colours;

    std::vector<std::uint64_t> taken_;  ///< by slot: colours of its contacts
    std::vector<std::uint8_t> colour_;
    std::array<std::size_t, count + 1> sizes_{};
};

}  // namespace carom::detail
