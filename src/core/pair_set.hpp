#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace carom::detail {

/// A set of unordered pairs of numbers, by open addressing with linear probing. Only membership is asked, so
/// the order inside never shows.
class PairSet {
  public:
    /// Adds the pair; false when it was there.
    bool insert(std::uint32_t a, std::uint32_t b) {
        if (2 * (count_ + 1) > table_.size()) grow();
        const std::uint64_t key = key_of(a, b);
        std::size_t i = place(key);
        if (table_[i] == key) return false;
        table_[i] = key;
        ++count_;
        return true;
    }

    bool contains(std::uint32_t a, std::uint32_t b) const {
        return !table_.empty() && table_[place(key_of(a, b))] != empty;
    }

    void erase(std::uint32_t a, std::uint32_t b) {
        std::size_t hole = place(key_of(a, b));
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
    static constexpr std::uint64_t empty = ~std::uint64_t{0};

    static std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
        return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
    }
    static std::uint64_t hash(std::uint64_t key) {
        key = (key ^ (key >> 32)) * 0x9e3779b97f4a7c15u;
        return key ^ (key >> 29);
    }
    std::size_t place(std::uint64_t key) const {
        const std::size_t mask = table_.size() - 1;
        std::size_t i = hash(key) & mask;
        while (table_[i] != empty && table_[i] != key) i = (i + 1) & mask;
        return i;
    }
    void grow() {
        std::vector<std::uint64_t> old(table_.empty() ? 64 : 2 * table_.size(), empty);
        std::swap(old, table_);
        for (const std::uint64_t key : old) {
            if (key != empty) table_[place(key)] = key;
        }
    }

    std::vector<std::uint64_t> table_;
    std::size_t count_ = 0;
};

}  // namespace carom::detail
