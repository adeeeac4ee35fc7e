#pragma once

#include <bit>
#include <cstdint>

namespace carom::detail {

/// A running hash of numbers, the same on every machine: each 64-bit word is folded in by a multiply and a
/// rotate, then mixed at the end (the finaliser of MurmurHash3, A. Appleby, public domain constants).
class Hash {
  public:
    void add(std::uint64_t word) {
        state_ = std::rotl(state_ ^ (word * 0x9e3779b97f4a7c15u), 27) * 0xbf58476d1ce4e5b9u;
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(float value) { add(std::uint64_t{std::bit_cast<std::uint32_t>(value)}); }

    std::uint64_t value() const {
        std::uint64_t h = state_;
        h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdu;
        h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53u;
        return h ^ (h >> 33);
    }

  private:
    std::uint64_t state_ = 0x2545f4914f6cdd1du;
};

}  // namespace carom::detail
