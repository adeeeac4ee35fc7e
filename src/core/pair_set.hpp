#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom::detail {

/// Stands for no part in particular.
constexpr std::uint32_t no_part = ~std::uint32_t{0};

/// An unordered pair of numbers, and a third one that tells several such pairs apart.
struct PairKey {
    std::uint32_t a = 0, b = 0;  ///< a < b
    std::uint32_t part = no_part;

    static PairKey of(std::uint32_t one, std::uint32_t other, std::uint32_t part = no_part) {
        return {std::min(one, other), std::max(one, other), part};
    }
    friend auto operator<=>(const PairKey&, const PairKey&) = default;
};

/// A set of pairs, by open addressing with linear probing. Only membership is asked, so the order inside
/// never shows.
class PairSet {
  public:
    /// Adds the pair; false when it was there.
    bool insert(const PairKey& key) {
        if (2 * (count_ + 1) > table_.size()) grow();
        const std::size_t i = place(key);
        if (table_[i] == key) return false;
        table_[i] = key;
        ++count_;
        return true;
    }

    bool contains(const PairKey& key) const { return !table_.empty() && table_[place(key)] != empty; }

    void erase(const PairKey& key) {
        std::size_t hole = place(key);
        if (table_[hole] == empty) return;
        --count_;
        // Move back whoever was pushed beyond the hole (Knuth, The Art of Computer Programming 6.4, R).
        const std::size_t mask = table_.size() - 1;
        for (std::size_t i = (hole + 1) & mask; table_[i] != empty; i = (i + 1) & mask) {
            const std::size_t home = hash(table_[i]) & mask;
            if (((i - home) & mask) < ((i - hole) & mask)) continue;
            table_[hole] = table_[i];
            hole = i;
        }
        table_[hole] = empty;
    }

  private:
    static constexpr PairKey empty{~std::uint32_t{0}, ~std::uint32_t{0}, 0};

    static std::uint64_t hash(const PairKey& pair) {
        std::uint64_t key = std::uint64_t{pair.a} << 32 | pair.b;
        key = (key ^ (key >> 32) ^ std::uint64_t{pair.part} * 0xc2b2ae3d27d4eb4fu) * 0x9e3779b97f4a7c15u;
        return key ^ (key >> 29);
    }
    std::size_t place(const PairKey& key) const {
        const std::size_t mask = table_.size() - 1;
        std::size_t i = hash(key) & mask;
        while (table_[i] != empty && table_[i] != key) i = (i + 1) & mask;
        return i;
    }
    void grow() {
        std::vector<PairKey> old(table_.empty() ? 64 : 2 * table_.size(), empty);
        std::swap(old, table_);
        for (const PairKey& key : old) {
            if (key != empty) table_[place(key)] = key;
        }
    }

    std::vector<PairKey> table_;
    std::size_t count_ = 0;
};

}  // namespace carom::detail
