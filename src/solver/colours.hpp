#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom::detail {

/// The two bodies of a contact: their slots, and a number that does not depend on these.
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
/// A contact keeps its colour for as long as the solver has it. The colour is drawn by lot among the free
/// ones of the first few, and the lot follows from the pair. With the first free colour, contacts that are
/// created alike, say all to the left of their boxes, would get the same colour and be solved before those
/// to the right: a pyramid of 100 rows in the plane then leans by 28 cm within 500 steps, and with lots by 2.
class Colours {
  public:
    static constexpr int with_fixed = 24, between_movable = 40;
    static constexpr int count = with_fixed + between_movable;
    static constexpr int overflow = count;

    /// Draws a colour, or `overflow`, for a contact. Slots below `first_movable` are of bodies that cannot be
    /// pushed.
    int take(const SlotPair& pair, std::uint32_t first_movable) {
        const std::size_t slots = std::size_t{std::max(pair.a, pair.b)} + 1;
        if (taken_.size() < slots) taken_.resize(slots, 0);
        const bool fixed = pair.a < first_movable || pair.b < first_movable;
        const std::uint64_t free =
            ~(taken_[pair.a] | taken_[pair.b]) & (fixed ? first_colours : ~first_colours);
        const int colour = fixed ? std::countr_zero(free) : draw(free, static_cast<int>(pair.key % lots));
        set(pair, colour, first_movable, true);
        return colour;
    }
    /// The contact is no more.
    void give_back(const SlotPair& pair, int colour, std::uint32_t first_movable) {
        set(pair, colour, first_movable, false);
    }

  private:
    static constexpr std::uint64_t first_colours = (std::uint64_t{1} << with_fixed) - 1;
    static constexpr int lots = 4;

    /// The free colour with this number, or the last where there are fewer; 64, the overflow, when none is.
    static int draw(std::uint64_t free, int lot) {
        for (; lot > 0 && (free & (free - 1)) != 0; --lot) free &= free - 1;
        return std::countr_zero(free);
    }

    void set(const SlotPair& pair, int colour, std::uint32_t first_movable, bool taken) {
        if (colour == overflow) return;
        const std::uint64_t bit = std::uint64_t{1} << colour;
        for (const std::uint32_t slot : {pair.a, pair.b}) {
            if (slot >= first_movable) taken_[slot] = taken ? taken_[slot] | bit : taken_[slot] & ~bit;
        }
    }

    std::vector<std::uint64_t> taken_;  ///< by slot: colours of its contacts
};

}  // namespace carom::detail
