#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// For the arithmetic of the inner loops: what a loop holds in registers should stay there, and compilers do
/// not put functions of this size into it by themselves.
#define CAROM_INLINE [[gnu::always_inline]] inline
#define CAROM_INLINE_LAMBDA __attribute__((always_inline))  // stands between the parameters and the body

/// The lane functions for one lane: `float` itself. Constraint rows are written with these names only, so
/// that the same rows run on wide lanes (simd/lanes.hpp), whose masks are not `bool`.
namespace carom::detail {

template <class F>
constexpr int lane_count = F::count;
template <>
inline constexpr int lane_count<float> = 1;

/// As many doubles as `F` has floats.
template <class F>
struct WideOf;
template <>
struct WideOf<float> {
    using Type = double;
};
template <class F>
using Wide = typename WideOf<F>::Type;

template <class F>
CAROM_INLINE F load_lanes(const float* lanes) {
    return F::load(lanes);
}
template <>
CAROM_INLINE float load_lanes<float>(const float* lanes) {
    return *lanes;
}

inline float maximum(float a, float b) { return a > b ? a : b; }
inline float minimum(float a, float b) { return a < b ? a : b; }
inline float square_root(float a) { return std::sqrt(a); }
inline double maximum(double a, double b) { return a > b ? a : b; }
inline double minimum(double a, double b) { return a < b ? a : b; }
inline double square_root(double a) { return std::sqrt(a); }
inline bool any(bool mask) { return mask; }
inline bool both(bool a, bool b) { return a && b; }
inline bool either(bool a, bool b) { return a || b; }
inline std::uint32_t bits_of(bool mask) { return mask; }

/// Reads floats, a multiple of four, that lie side by side at `base + index[lane] · stride` for every lane.
template <class... Floats>
inline void gather_record(const float* base, const std::uint32_t* index, std::size_t stride, float& first,
                          Floats&... more) {
    const float* p = base + index[0] * stride;
    first = *p;
    ((more = *++p), ...);
}

/// Reads two doubles that lie side by side at `base + index[lane] · stride` for every lane.
inline void gather_pairs(const double* base, const std::uint32_t* index, std::size_t stride, double& a,
                         double& b) {
    a = base[index[0] * stride], b = base[index[0] * stride + 1];
}

/// Writes `n` doubles that lie side by side at `base + index[lane] · stride` for every lane that is wanted.
template <int n>
inline void scatter_some(double* base, const std::uint32_t* index, std::size_t stride, bool wanted,
                         const double (&values)[n]) {
    if (!wanted) return;
    for (int k = 0; k < n; ++k) base[index[0] * stride + k] = values[k];
}

/// Writes what `gather_record` read. No two lanes may have the same index.
template <class... Floats>
inline void scatter_record(float* base, const std::uint32_t* index, std::size_t stride, float first,
                           Floats... more) {
    float* p = base + index[0] * stride;
    *p = first;
    ((*++p = more), ...);
}

/// The same, but only lanes with an index of at least `first` are written; the others may be equal.
template <class... Floats>
inline void scatter_record_from(std::uint32_t first, float* base, const std::uint32_t* index,
                                std::size_t stride, Floats... all) {
    if (index[0] >= first) scatter_record(base, index, stride, all...);
}

}  // namespace carom::detail
