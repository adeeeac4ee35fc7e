#include "math/trig.hpp"

#include <cstdint>
#include <limits>

#include "math/exact.hpp"

namespace carom::detail {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double largest = std::numeric_limits<double>::max();

// To twice the precision of double:
constexpr DoubleDouble pi_exact{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
constexpr DoubleDouble half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr DoubleDouble quarter_pi{0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55};

/// The bits of 2/π behind the point, after 64 zeros.
constexpr std::uint32_t two_over_pi[] = {
    0x00000000, 0x00000000, 0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041,
    0xfe5163ab, 0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e,
    0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b,
    0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d,
    0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046};

/// x = (quadrant + 4 n) π/2 + rest for some whole n and |rest| ≤ π/4.
struct Reduced {
    int quadrant;
    DoubleDouble rest;
};

/// Payne and Hanek 1983: x = m 2^e with a whole m of 53 bits. Of the product m · (2/π) only the bits matter
/// that, times 2^e, weigh less than 4; seven words of 2/π give these, and behind the point at least 137 more.
/// The multiple of π/2 that is nearest to a double is 2^-61 away from it, so 76 bits of the rest are left.
Reduced reduce(double x) {
    constexpr int words = 7;
    int exponent;
    const auto m = static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(x), &exponent), 53));
    exponent -= 53;
    const std::uint64_t m_low = m & 0xffffffff, m_high = m >> 32;

    const int skipped = (exponent + 62) / 32;
    const int point = 32 * (words + skipped) - 64 - exponent;  // place of the bit of weight 1
    std::uint32_t product[words];                              // low words first, the words above dropped
    std::uint64_t carry = 0;
    for (int i = 0; i < words; ++i) {
        const std::uint64_t word = two_over_pi[skipped + words - 1 - i];
        const std::uint64_t below = i == 0 ? 0 : two_over_pi[skipped + words - i];
        const std::uint64_t low = m_low * word, high = m_high * below;
        const std::uint64_t sum = (carry & 0xffffffff) + (low & 0xffffffff) + (high & 0xffffffff);
        product[i] = static_cast<std::uint32_t>(sum);
        carry = (carry >> 32) + (low >> 32) + (high >> 32) + (sum >> 32);
    }

    const auto bit = [&](int place) { return static_cast<int>(product[place / 32] >> (place % 32) & 1u); };
    int quadrant = 2 * bit(point + 1) + bit(point);
    const bool round_up = bit(point - 1) != 0;
    // The fraction, less 1 when it was at least 1/2 (then negated), summed from its largest word down.
    DoubleDouble fraction;
    double weight = std::ldexp(1.0, 32 * (point / 32) - point);
    for (int i = point / 32; i >= 0; --i) {
        std::uint32_t word = round_up ? ~product[i] : product[i];
        if (i == point / 32) word &= (std::uint32_t{1} << (point % 32)) - 1;
        const DoubleDouble sum = two_sum(fraction.high, word * weight);
        fraction = {sum.high, fraction.low + sum.low};
        weight *= 0x1p-32;
    }
    fraction = ordered_sum(fraction.high, fraction.low);
    DoubleDouble rest = two_product(fraction.high, half_pi.high);
    rest = ordered_sum(rest.high, rest.low + fraction.high * half_pi.low + fraction.low * half_pi.high);
    if (round_up) {
        quadrant += 1;
        rest = {-rest.high, -rest.low};
    }
    if (x < 0) return {-quadrant & 3, {-rest.high, -rest.low}};
    return {quadrant & 3, rest};
}

/// (atan √z / √z − 1) / z for 0 ≤ z ≤ tan² π/8. The best polynomial of its degree for the relative error of
/// atan (found by Remez's exchange, 2^-58 after rounding of the coefficients).
constexpr double atan_series(double z) {
    return -0.33333333333333326 +
           z * (0.19999999999997647 +
                z * (-0.14285714285385698 +
                     z * (0.11111111088053019 +
                          z * (-0.0909090814064408 +
                               z * (0.07692282683297845 +
                                    z * (-0.06666225809639888 +
                                         z * (0.05877013974567092 +
                                              z * (-0.05218362514483708 +
                                                   z * (0.04503410519183284 +
                                                        z * (-0.033471889421874616 +
                                                             z * 0.01519316599638645))))))))));
}

/// The angle from the longer one of two perpendicular sides to the hypotenuse, in [0, π/4].
DoubleDouble angle_below_diagonal(DoubleDouble shorter, DoubleDouble longer) {
    constexpr double tan_of_eighth = 0.41421356237309503;
    const double ratio = shorter.high / longer.high;
    if (ratio < 0x1p-28) return {ratio, 0};  // atan t = t (1 − t²/3 …)
    DoubleDouble base{0, 0};
    if (ratio > tan_of_eighth) {
        // atan(s/l) = π/4 + atan((s − l)/(s + l))
        base = quarter_pi;
        const DoubleDouble difference = two_sum(shorter.high, -longer.high);
        const DoubleDouble sum = two_sum(shorter.high, longer.high);
        const double difference_low = difference.low + (shorter.low - longer.low);
        longer = {sum.high, sum.low + (shorter.low + longer.low)};
        shorter = {difference.high, difference_low};
    }
    const double t = shorter.high / longer.high;
    const DoubleDouble back = two_product(t, longer.high);
    const double rest =
        (((shorter.high - back.high) - back.low) + (shorter.low - t * longer.low)) / longer.high;
    const double z = t * t;
    const DoubleDouble sum = two_sum(base.high, t);
    return {sum.high, sum.low + (base.low + (rest * (1 - z) + t * z * atan_series(z)))};
}

DoubleDouble difference(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble sum = two_sum(a.high, -b.high);
    return {sum.high, sum.low + (a.low - b.low)};
}

/// Angle of the point (x, y), given to twice the precision and with |x|, |y| between 1e-100 and 1e100 or so.
double angle_of(DoubleDouble y, DoubleDouble x) {
    const bool left = x.high < 0, below = y.high < 0;
    if (left) x = {-x.high, -x.low};
    if (below) y = {-y.high, -y.low};
    DoubleDouble angle =
        y.high > x.high ? difference(half_pi, angle_below_diagonal(x, y)) : angle_below_diagonal(y, x);
    if (left) angle = difference(pi_exact, angle);
    return below ? -(angle.high + angle.low) : angle.high + angle.low;
}

/// √(1 − x²) for |x| ≤ 1.
DoubleDouble other_side(double x) {
    const DoubleDouble square = two_product(x, x);
    const DoubleDouble rest = two_sum(1, -square.high);
    const double root = std::sqrt(rest.high);
    if (root == 0) return {0, 0};
    const DoubleDouble back = two_product(root, root);
    return {root, (((rest.high - back.high) - back.low) + (rest.low - square.low)) / (2 * root)};
}

}  // namespace

SinCos sin_cos_far(double x) {
    if (!(std::fabs(x) <= largest)) return {not_a_number, not_a_number};
    const Reduced reduced = reduce(x);
    const SinCos near = sin_cos_near_zero(reduced.rest.high, reduced.rest.low);
    switch (reduced.quadrant) {
        case 0:
            return near;
        case 1:
            return {near.cos, -near.sin};
        case 2:
            return {-near.sin, -near.cos};
        default:
            return {-near.cos, near.sin};
    }
}

double atan2(double y, double x) {
    const double larger = std::fabs(x) > std::fabs(y) ? std::fabs(x) : std::fabs(y);
    if (!(std::fabs(x) <= largest && std::fabs(y) <= largest)) return not_a_number;
    if (larger == 0) return 0;
    // So flat that nothing is left to compute; what follows may scale y down to nothing.
    if (std::fabs(y) < 0x1p-60 * larger) return x > 0 ? y / x : y < 0 ? -pi : pi;
    if (larger < 1e-100 || larger > 1e100) {
        int exponent;
        std::frexp(larger, &exponent);
        x = std::ldexp(x, -exponent);
        y = std::ldexp(y, -exponent);
    }
    return angle_of({y, 0}, {x, 0});
}

double asin(double x) {
    if (!(std::fabs(x) <= 1)) return not_a_number;
    return angle_of({x, 0}, other_side(x));
}

double acos(double x) {
    if (!(std::fabs(x) <= 1)) return not_a_number;
    return angle_of(other_side(x), {x, 0});
}

double exp(double x) {
    if (x != x) return x;
    if (x > 709.79) return std::numeric_limits<double>::infinity();
    if (x < -745.2) return 0;
    // e^x = 2^k e^r with |r| ≤ ln 2 / 2; the upper part of ln 2 has 42 bits, so that its product with k is
    // exact.
    constexpr double ln2_upper = 0x1.62e42fefa3800p-1, ln2_lower = 0x1.ef35793c76730p-45;
    constexpr double over_ln2 = 0x1.71547652b82fep+0;
    const double k = std::floor(x * over_ln2 + 0.5);
    const double upper = x - k * ln2_upper, lower = k * ln2_lower;
    const double r = upper - lower;
    const double rest = (upper - r) - lower;
    // (e^r − 1 − r − r²/2) / r³; the best polynomial of its degree for the relative error of e^r (found by
    // Remez's exchange, 2^-60 after rounding of the coefficients).
    const double series =
        0.1666666666666668 +
        r * (0.04166666666666641 +
             r * (0.00833333333331853 +
                  r * (0.001388888888903323 +
                       r * (0.00019841269893336891 +
                            r * (2.480158702567617e-05 +
                                 r * (2.7557237457330856e-06 +
                                      r * (2.755752603838935e-07 +
                                           r * (2.5111245872660823e-08 + r * 2.0838527641001923e-09))))))));
    return std::ldexp(1 + (r + (rest + r * r * (0.5 + r * series))), static_cast<int>(k));
}

}  // namespace carom::detail
