#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace carom::detail {

/// The two bodies of a contact: their slots, and a number that stays the same from step to step.
struct SlotPair {
    std::uint32_t a = 0, b = 0;
    std::uint32_t key = 0;
};

/// A number for two bodies, as good as drawn by lot: finalizer of SplitMix64 (Steele, Lea, Flood 2014).
constexpr std::uint32_t pair_key(std::uint32_t body_a, std::uint32_t body_b) {
    std::uint64_t z = (std::uint64_t{body_a} << 32 | body_b) + 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<std::uint32_t>(z ^ (z >> 31));
}

/// Deals contacts into colours: no two contacts of one colour share a body that can be pushed, so those of a
/// colour can be solved side by side, and in any order with the same result. What finds no colour is the
/// overflow. Contacts with a body that cannot be pushed have the first colours, so that those in a block are
/// alike.
///
/// The contacts are taken in their order (greedy colouring), but the colour is drawn by lot among the free
/// ones of the first few, and the lot follows from the pair. With the first free colour, contacts that are
/// created alike, say all to the left of their boxes, would get the same colour and be solved before those
/// to the right: a pyramid of 100 rows in the plane then leans by 28 cm within 500 steps, and with lots by 2.
class Colours {
  public:
    static constexpr int with_fixed = 24, between_movable = 40;
    static constexpr int count = with_fixed + between_movable;
    static constexpr int overflow = count;

    /// Slots below `first_movable` are of bodies that cannot be pushed; `slots` is one more than the last
    /// slot.
    void deal(std::span<const SlotPair> contacts, std::uint32_t first_movable, std::size_t slots) {
        taken_.assign(slots, 0);
        colour_.resize(contacts.size());
        sizes_.fill(0);
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const auto [a, b, key] = contacts[i];
            const bool fixed = a < first_movable || b < first_movable;
            const std::uint64_t free = ~(taken_[a] | taken_[b]) & (fixed ? first_colours : ~first_colours);
            const int colour = fixed ? std::countr_zero(free) : draw(free, static_cast<int>(key % lots));
            const std::uint64_t bit = colour == overflow ? 0 : std::uint64_t{1} << colour;
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
    static constexpr std::uint64_t first_colours = (std::uint64_t{1} << with_fixed) - 1;
    static constexpr int lots = 4;

    /// The free colour with this number, or the last where there are fewer; 64, the overflow, when none is.
    static int draw(std::uint64_t free, int lot) {
        for (; lot > 0 && (free & (free - 1)) != 0; --lot) free &= free - 1;
        return std::countr_zero(free);
    }

    std::vector<std::uint64_t> taken_;  ///< by slot: colours of its contacts
    std::vector<std::uint8_t> colour_;
    std::array<std::size_t, count + 1> sizes_{};
};

}  // namespace carom::detail
