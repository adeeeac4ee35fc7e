#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

// Only for sources that are compiled for one instruction set: everything here lives in a namespace of that
// set, so that sources compiled for different sets share no inline function.
#define HWY_COMPILE_ONLY_STATIC
#include <hwy/highway.h>

#include "simd/scalar.hpp"

namespace carom::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<float>;
using Register = hn::Vec<Tag>;
using WideTag = hn::Repartition<double, Tag>;
using WideRegister = hn::Vec<WideTag>;

template <int n>
using Floats = hn::Vec<hn::FixedTag<float, n>>;

/// Quads of floats that follow one another in each of some records. Nested, not an array, so that compilers
/// keep them in registers.
template <int n, int quads>
struct Quads {
    Floats<n> first;
    Quads<n, quads - 1> rest;
};
template <int n>
struct Quads<n, 0> {};

template <int quads>
CAROM_INLINE Quads<4, quads> load_quads(const float* from) {
    if constexpr (quads > 0)
        return {hn::LoadU(hn::FixedTag<float, 4>(), from), load_quads<quads - 1>(from + 4)};
    else
        return {};
}
template <int quads>
CAROM_INLINE void store_quads(const Quads<4, quads>& from, float* to) {
    if constexpr (quads > 0) {
        hn::StoreU(from.first, hn::FixedTag<float, 4>(), to);
        store_quads<quads - 1>(from.rest, to + 4);
    }
}

template <int n, int quads>
CAROM_INLINE Quads<2 * n, quads> combined(const Quads<n, quads>& low, const Quads<n, quads>& high) {
    if constexpr (quads > 0)
        return {hn::Combine(hn::FixedTag<float, 2 * n>(), high.first, low.first),
                combined<n, quads - 1>(low.rest, high.rest)};
    else
        return {};
}
template <int n, int quads>
CAROM_INLINE Quads<n / 2, quads> lower_half(const Quads<n, quads>& all) {
    if constexpr (quads > 0)
        return {hn::LowerHalf(hn::FixedTag<float, n / 2>(), all.first), lower_half<n, quads - 1>(all.rest)};
    else
        return {};
}
template <int n, int quads>
CAROM_INLINE Quads<n / 2, quads> upper_half(const Quads<n, quads>& all) {
    if constexpr (quads > 0)
        return {hn::UpperHalf(hn::FixedTag<float, n / 2>(), all.first), upper_half<n, quads - 1>(all.rest)};
    else
        return {};
}

/// Of the lanes 0, 4, 8, ... of `index`. All quads of a record are read together, so that where it lies is
/// worked out once.
template <int n, int quads>
CAROM_INLINE Quads<n, quads> load_quads(const float* base, const std::uint32_t* index, std::size_t stride) {
    if constexpr (n == 4)
        return load_quads<quads>(base + index[0] * stride);
    else
        return combined<n / 2, quads>(load_quads<n / 2, quads>(base, index, stride),
                                      load_quads<n / 2, quads>(base, index + n / 2, stride));
}
template <int n, int quads>
CAROM_INLINE void store_quads(float* base, const std::uint32_t* index, std::size_t stride,
                              const Quads<n, quads>& from) {
    if constexpr (n == 4) {
        store_quads<quads>(from, base + index[0] * stride);
    } else {
        store_quads<n / 2, quads>(base, index, stride, lower_half<n, quads>(from));
        store_quads<n / 2, quads>(base, index + n / 2, stride, upper_half<n, quads>(from));
    }
}

constexpr std::uint32_t lane_numbers[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Two doubles each for the lanes 0, 2, 4, ... of `index`.
template <int n>
CAROM_INLINE auto load_pairs(const double* base, const std::uint32_t* index, std::size_t stride) {
    const hn::FixedTag<double, n> tag;
    if constexpr (n == 2) {
        return hn::LoadU(tag, base + index[0] * stride);
    } else {
        return hn::Combine(tag, load_pairs<n / 2>(base, index + n / 2, stride),
                           load_pairs<n / 2>(base, index, stride));
    }
}

/// Transposes each group of four lanes: from a register a lane to a register a component, and back.
CAROM_INLINE void transpose(Register& a, Register& b, Register& c, Register& d) {
    const Tag tag;
    const hn::Repartition<std::uint64_t, Tag> pairs;
    const auto low_ab = hn::BitCast(pairs, hn::InterleaveLower(tag, a, b));
    const auto high_ab = hn::BitCast(pairs, hn::InterleaveUpper(tag, a, b));
    const auto low_cd = hn::BitCast(pairs, hn::InterleaveLower(tag, c, d));
    const auto high_cd = hn::BitCast(pairs, hn::InterleaveUpper(tag, c, d));
    a = hn::BitCast(tag, hn::InterleaveLower(pairs, low_ab, low_cd));
    b = hn::BitCast(tag, hn::InterleaveUpper(pairs, low_ab, low_cd));
    c = hn::BitCast(tag, hn::InterleaveLower(pairs, high_ab, high_cd));
    d = hn::BitCast(tag, hn::InterleaveUpper(pairs, high_ab, high_cd));
}

/// As many doubles side by side as `Lanes` has floats: two registers of them.
class WideLanes {
  public:
    explicit WideLanes(double all) : low_(hn::Set(WideTag(), all)), high_(low_) {}
    WideLanes() : WideLanes(0.0) {}
    WideLanes(WideRegister low, WideRegister high) : low_(low), high_(high) {}

    WideRegister low() const { return low_; }
    WideRegister high() const { return high_; }

    friend WideLanes operator+(WideLanes a, WideLanes b) {
        return {hn::Add(a.low_, b.low_), hn::Add(a.high_, b.high_)};
    }
    friend WideLanes operator-(WideLanes a, WideLanes b) {
        return {hn::Sub(a.low_, b.low_), hn::Sub(a.high_, b.high_)};
    }
    friend WideLanes operator*(WideLanes a, WideLanes b) {
        return {hn::Mul(a.low_, b.low_), hn::Mul(a.high_, b.high_)};
    }
    friend WideLanes operator/(WideLanes a, WideLanes b) {
        return {hn::Div(a.low_, b.low_), hn::Div(a.high_, b.high_)};
    }
    friend WideLanes operator-(WideLanes a) { return {hn::Neg(a.low_), hn::Neg(a.high_)}; }
    friend WideLanes sqrt(WideLanes a) { return {hn::Sqrt(a.low_), hn::Sqrt(a.high_)}; }

    CAROM_INLINE friend void gather_pairs(const double* base, const std::uint32_t* index, std::size_t stride,
                                          WideLanes& a, WideLanes& b) {
        constexpr int half = HWY_LANES(double);
        const auto both = [&](const std::uint32_t* of, WideRegister& first, WideRegister& second) {
            const auto even = load_pairs<half>(base, of, stride),
                       odd = load_pairs<half>(base, of + 1, stride);
            first = hn::InterleaveLower(WideTag(), even, odd);
            second = hn::InterleaveUpper(WideTag(), even, odd);
        };
        both(index, a.low_, b.low_);
        both(index + half, a.high_, b.high_);
    }

  private:
    WideRegister low_, high_;
};

/// Several floats side by side, as many as the instruction set has in a register. Sums, products, quotients
/// and roots are those of IEEE 754 in every lane, so a computation gives the same bits in lanes of any width.
class Lanes {
  public:
    static constexpr int count = HWY_LANES(float);
    struct Mask {
        hn::Mask<Tag> m;
        friend Mask both(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
        friend Mask either(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
        friend Mask operator!(Mask a) { return {hn::Not(a.m)}; }
    };

    Lanes() : v_(hn::Zero(Tag())) {}
    explicit Lanes(float all) : v_(hn::Set(Tag(), all)) {}
    /// Rounded to the nearest.
    explicit Lanes(WideLanes wide) {
        const hn::Half<Tag> half;
        v_ = hn::Combine(Tag(), hn::DemoteTo(half, wide.high()), hn::DemoteTo(half, wide.low()));
    }
    explicit operator WideLanes() const {
        const hn::Half<Tag> half;
        return {hn::PromoteTo(WideTag(), hn::LowerHalf(half, v_)),
                hn::PromoteTo(WideTag(), hn::UpperHalf(half, v_))};
    }
    static Lanes load(const float* lanes) { return hn::LoadU(Tag(), lanes); }

    friend Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v_, b.v_); }
    friend Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v_, b.v_); }
    friend Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v_, b.v_); }
    friend Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v_, b.v_); }
    friend Lanes operator-(Lanes a) { return hn::Neg(a.v_); }
    friend Mask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v_, b.v_)}; }

    friend Lanes select(Mask mask, Lanes yes, Lanes no) { return hn::IfThenElse(mask.m, yes.v_, no.v_); }
    friend Lanes fabs(Lanes a) { return hn::Abs(a.v_); }
    friend Lanes sqrt(Lanes a) { return hn::Sqrt(a.v_); }
    friend Lanes square_root(Lanes a) { return hn::Sqrt(a.v_); }
    /// A bit a lane, the first lane in the lowest.
    friend std::uint32_t bits_of(Mask mask) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(Tag(), mask.m, bytes);
        return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
    }
    friend bool any(Mask mask) { return !hn::AllFalse(Tag(), mask.m); }
    // The second operand where they are equal or one is not a number, like `a > b ? a : b`.
#if HWY_ARCH_X86
    friend Lanes maximum(Lanes a, Lanes b) { return hn::Max(a.v_, b.v_); }
    friend Lanes minimum(Lanes a, Lanes b) { return hn::Min(a.v_, b.v_); }
#else
    friend Lanes maximum(Lanes a, Lanes b) { return select(a > b, a, b); }
    friend Lanes minimum(Lanes a, Lanes b) { return select(b > a, a, b); }
#endif

    template <class... More>
    CAROM_INLINE friend void gather_record(const float* base, const std::uint32_t* index, std::size_t stride,
                                           Lanes& a, Lanes& b, Lanes& c, Lanes& d, More&... more) {
        constexpr int quads = 1 + sizeof...(more) / 4;
        give_out<quads>(load_quads<count, quads>(base, index, stride),
                        load_quads<count, quads>(base, index + 1, stride),
                        load_quads<count, quads>(base, index + 2, stride),
                        load_quads<count, quads>(base, index + 3, stride), a, b, c, d, more...);
    }

    template <class... More>
    CAROM_INLINE friend void scatter_record(float* base, const std::uint32_t* index, std::size_t stride,
                                            Lanes a, Lanes b, Lanes c, Lanes d, More... more) {
        constexpr int quads = 1 + sizeof...(more) / 4;
        Quads<count, quads> k0, k1, k2, k3;
        take_in<quads>(k0, k1, k2, k3, a, b, c, d, more...);
        store_quads<count, quads>(base, index, stride, k0);
        store_quads<count, quads>(base, index + 1, stride, k1);
        store_quads<count, quads>(base, index + 2, stride, k2);
        store_quads<count, quads>(base, index + 3, stride, k3);
    }

    template <class... More>
    CAROM_INLINE friend void scatter_record_from(std::uint32_t first, float* base, const std::uint32_t* index,
                                                 std::size_t stride, Lanes a, Lanes b, Lanes c, Lanes d,
                                                 More... more) {
        constexpr int floats = 4 + sizeof...(more);
        alignas(64) float close[count][floats];
        scatter_record(close[0], lane_numbers, floats, a, b, c, d, more...);
        for (int lane = 0; lane < count; ++lane) {
            if (index[lane] >= first)
                std::memcpy(base + index[lane] * stride, close[lane], sizeof(close[lane]));
        }
    }

  private:
    Lanes(Register v) : v_(v) {}

    /// From registers of records, of the lanes k, k + 4, k + 8, ..., to registers of lanes.
    template <int quads, class... More>
    CAROM_INLINE static void give_out(Quads<count, quads> k0, Quads<count, quads> k1, Quads<count, quads> k2,
                                      Quads<count, quads> k3, Lanes& a, Lanes& b, Lanes& c, Lanes& d,
                                      More&... more) {
        transpose(k0.first, k1.first, k2.first, k3.first);
        a.v_ = k0.first, b.v_ = k1.first, c.v_ = k2.first, d.v_ = k3.first;
        if constexpr (quads > 1) give_out<quads - 1>(k0.rest, k1.rest, k2.rest, k3.rest, more...);
    }
    /// And back.
    template <int quads, class... More>
    CAROM_INLINE static void take_in(Quads<count, quads>& k0, Quads<count, quads>& k1,
                                     Quads<count, quads>& k2, Quads<count, quads>& k3, Lanes a, Lanes b,
                                     Lanes c, Lanes d, More... more) {
        transpose(a.v_, b.v_, c.v_, d.v_);
        k0.first = a.v_, k1.first = b.v_, k2.first = c.v_, k3.first = d.v_;
        if constexpr (quads > 1) take_in<quads - 1>(k0.rest, k1.rest, k2.rest, k3.rest, more...);
    }

    Register v_;
};

template <int n>
CAROM_INLINE void scatter_some(double* base, const std::uint32_t* index, std::size_t stride,
                               Lanes::Mask wanted, const WideLanes (&values)[n]) {
    constexpr int half = HWY_LANES(double);
    alignas(64) double all[n][Lanes::count];
    for (int k = 0; k < n; ++k) {
        hn::Store(values[k].low(), WideTag(), all[k]);
        hn::Store(values[k].high(), WideTag(), all[k] + half);
    }
    const std::uint32_t bits = bits_of(wanted);
    for (int lane = 0; lane < Lanes::count; ++lane) {
        if (!(bits >> lane & 1)) continue;
        double* to = base + index[lane] * stride;
        for (int k = 0; k < n; ++k) to[k] = all[k][lane];
    }
}

}  // namespace carom::detail::HWY_NAMESPACE

namespace carom::detail {
template <>
struct WideOf<HWY_NAMESPACE::Lanes> {
    using Type = HWY_NAMESPACE::WideLanes;
};
}  // namespace carom::detail
