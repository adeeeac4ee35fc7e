#pragma once

#include <cmath>

/// Sums and products without rounding error: the exact result is the unevaluated sum of two doubles.
namespace carom::detail {

/// The number high + low, where |low| is at most half a unit in the last place of high.
struct DoubleDouble {
    double high = 0, low = 0;
};

/// a + b, exactly (Knuth 1969, The Art of Computer Programming 2, 4.2.2, theorem B).
constexpr DoubleDouble two_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a + b, exactly, where |a| ≥ |b| or a = 0 (Dekker 1971).
constexpr DoubleDouble ordered_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// a × b, exactly, where nothing over- or underflows: 1e-140 < |a|, |b| < 1e140 is enough (Dekker 1971: each
/// factor is split into halves of 26 bits, whose products are exact).
constexpr DoubleDouble two_product(double a, double b) {
    constexpr double splitter = 134217729;  // 2²⁷ + 1
    const double a_scaled = splitter * a, b_scaled = splitter * b;
    const double a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
    const double a_low = a - a_high, b_low = b - b_high;
    const double product = a * b;
    return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

}  // namespace carom::detail
