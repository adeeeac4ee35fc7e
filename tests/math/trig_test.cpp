#include "math/trig.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Where long double is no wider than double, libm is no better a reference than ours.
constexpr double slack = LDBL_MANT_DIG > DBL_MANT_DIG ? 0 : 1;

/// The distance of the result from the true value, in units in the last place of that value.
double ulps(double result, long double truth) {
    int exponent;
    std::frexp(static_cast<double>(truth), &exponent);
    const long double unit = std::ldexp(1.0, std::max(exponent - 53, -1074));
    return static_cast<double>(std::fabs(static_cast<long double>(result) - truth) / unit);
}

/// A number of any size between the powers of two, of either sign.
double of_any_size(Random& random, int lowest, int highest) {
    const double fraction = random.between(0.5, 1);
    const double size = std::ldexp(fraction, lowest + 1 + random.below(highest - lowest));
    return random.below(2) == 0 ? size : -size;
}

void expect_sin_cos(double x) {
    const auto [sine, cosine] = sin_cos(x);
    const long double true_sine = std::sin(static_cast<long double>(x));
    const long double true_cosine = std::cos(static_cast<long double>(x));
    EXPECT_LE(ulps(sine, true_sine), 0.8 + slack) << x;
    EXPECT_LE(ulps(cosine, true_cosine), 0.8 + slack) << x;
    EXPECT_LE(ulps(tan(x), std::tan(static_cast<long double>(x))), 2.5 + slack) << x;
    EXPECT_EQ(sin(x), sine);
    EXPECT_EQ(cos(x), cosine);
}

TEST(Trig, SinCosOfSmallAngles) {
    Random random(1);
    for (int k = 0; k < 100000; ++k) expect_sin_cos(random.between(-pi / 4, pi / 4));
    for (int k = 0; k < 1000; ++k) expect_sin_cos(of_any_size(random, -1021, 0));
    for (const double x : {pi / 4, -pi / 4, std::nextafter(pi / 4, 1), std::nextafter(-pi / 4, -1)})
        expect_sin_cos(x);
}

TEST(Trig, SinCosOfAnyAngle) {
    Random random(2);
    for (int k = 0; k < 50000; ++k) expect_sin_cos(random.between(-100, 100));
    for (int k = 0; k < 50000; ++k) expect_sin_cos(of_any_size(random, -2, 1023));
}

TEST(Trig, SinCosAtTheBordersOfQuadrants) {
    Random random(3);
    for (int k = 0; k < 20000; ++k) {
        const double border = (k < 1000 ? k : static_cast<double>(random.bits() >> (11 + k % 40))) * pi / 4;
        expect_sin_cos(border);
        expect_sin_cos(-std::nextafter(border, infinity));
        expect_sin_cos(std::nextafter(border, 0));
    }
}

TEST(Trig, SinCosOfHugeNumbers) {
    // To 3000 bits: 10²², the largest double, and the double that is nearest to a multiple of π/2.
    const struct {
        double x, sine, cosine;
    } cases[] = {{0x1.0f0cf064dd592p+73, -0x1.b453ab76bf397p-1, 0x1.0be2cef01c8f4p-1},
                 {0x1.fffffffffffffp+1023, 0x1.452fc98b34e97p-8, -0x1.fffe62ecfab75p-1},
                 {0x1.6ac5b262ca1ffp+849, 0x1.0000000000000p+0, -0x1.14ae72e6ba22fp-61}};
    for (const auto& c : cases) {
        EXPECT_EQ(sin(c.x), c.sine) << c.x;
        EXPECT_EQ(cos(c.x), c.cosine) << c.x;
        EXPECT_EQ(sin(-c.x), -c.sine) << c.x;
    }
}

TEST(Trig, ExactPlaces) {
    EXPECT_EQ(sin(0), 0);
    EXPECT_EQ(cos(0), 1);
    EXPECT_EQ(tan(0), 0);
    EXPECT_EQ(sin(5e-324), 5e-324);
    EXPECT_EQ(sin(pi / 2), 1);
    EXPECT_EQ(cos(pi), -1);
    EXPECT_EQ(exp(0), 1);
    EXPECT_EQ(acos(1), 0);
    EXPECT_EQ(acos(-1), pi);
    EXPECT_EQ(acos(0), pi / 2);
    EXPECT_EQ(asin(1), pi / 2);
    EXPECT_EQ(asin(-1), -pi / 2);
    EXPECT_EQ(asin(0), 0);
    EXPECT_EQ(atan2(0, 0), 0);
    EXPECT_EQ(atan2(0, 1), 0);
    EXPECT_EQ(atan2(0, -1), pi);
    EXPECT_EQ(atan2(-0.0, -1), pi);
    EXPECT_EQ(atan2(1, 0), pi / 2);
    EXPECT_EQ(atan2(-1, 0), -pi / 2);
    EXPECT_EQ(atan2(3, 3), pi / 4);
    EXPECT_EQ(atan2(3, -3), 3 * pi / 4);
}

TEST(Trig, WhatIsNotFinite) {
    for (const double x : {infinity, -infinity, not_a_number}) {
        EXPECT_TRUE(std::isnan(sin(x)));
        EXPECT_TRUE(std::isnan(cos(x)));
        EXPECT_TRUE(std::isnan(tan(x)));
        EXPECT_TRUE(std::isnan(atan2(x, 1)));
        EXPECT_TRUE(std::isnan(atan2(1, x)));
        EXPECT_TRUE(std::isnan(acos(x)));
        EXPECT_TRUE(std::isnan(asin(x)));
    }
    EXPECT_TRUE(std::isnan(acos(std::nextafter(1, 2))));
    EXPECT_TRUE(std::isnan(asin(std::nextafter(-1, -2))));
    EXPECT_TRUE(std::isnan(exp(not_a_number)));
    EXPECT_EQ(exp(infinity), infinity);
    EXPECT_EQ(exp(-infinity), 0);
    EXPECT_EQ(exp(710), infinity);
    EXPECT_EQ(exp(-746), 0);
}

void expect_atan2(double y, double x) {
    EXPECT_LE(ulps(atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))),
              0.7 + slack)
        << y << ", " << x;
}

TEST(Trig, Atan2) {
    Random random(4);
    for (int k = 0; k < 100000; ++k) {
        const double y = random.between(-1, 1);
        expect_atan2(y, random.between(-1, 1));
    }
    for (int k = 0; k < 20000; ++k) {
        const double y = of_any_size(random, -1070, 1023);
        expect_atan2(y, of_any_size(random, -1070, 1023));
    }
    for (int k = 0; k < 20000; ++k) {
        // Near the diagonals and near the place where the series changes.
        const double x = of_any_size(random, -300, 300), far = of_any_size(random, -52, -1);
        expect_atan2(x * (1 + far), x);
        expect_atan2(x * (std::sqrt(2) - 1 + far), -x);
        expect_atan2(x, x * far);
    }
}

TEST(Trig, AsinAcos) {
    Random random(5);
    const auto expect = [](double x) {
        EXPECT_LE(ulps(asin(x), std::asin(static_cast<long double>(x))), 0.7 + slack) << x;
        EXPECT_LE(ulps(acos(x), std::acos(static_cast<long double>(x))), 0.7 + slack) << x;
    };
    for (int k = 0; k < 100000; ++k) expect(random.between(-1, 1));
    for (int k = 0; k < 20000; ++k) {
        const double small = of_any_size(random, -1000, -1);
        expect(small);
        expect(std::copysign(1 - std::fabs(small), small));
    }
}

TEST(Trig, Exp) {
    Random random(6);
    const auto expect = [](double x) {
        EXPECT_LE(ulps(exp(x), std::exp(static_cast<long double>(x))), 0.9 + slack) << x;
    };
    for (int k = 0; k < 100000; ++k) expect(random.between(-1, 1));
    for (int k = 0; k < 100000; ++k) expect(random.between(-708.3, 709.7));
    for (int k = 0; k < 10000; ++k) expect(of_any_size(random, -1000, 0));
    for (int k = 0; k < 10000; ++k) {
        // Subnormal results are rounded a second time.
        const double x = random.between(-745, -708.3);
        EXPECT_LE(ulps(exp(x), std::exp(static_cast<long double>(x))), 1.01 + slack) << x;
    }
    for (int k = -1000; k < 1000; ++k) expect(k * std::log(2.0) / 2);
}

/// The bits of many results, which no compiler, no option and no machine may change.
TEST(Trig, BitsAreTheSameEverywhere) {
    Random random(7);
    std::uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&hash](double value) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3;
    };
    for (int k = 0; k < 10000; ++k) {
        const double x = random.between(-2, 2), y = random.between(-2, 2),
                     huge = of_any_size(random, 0, 1023);
        add(sin(x));
        add(cos(x));
        add(tan(y));
        add(sin(huge));
        add(atan2(x, y));
        add(asin(x / 2));
        add(acos(y / 2));
        add(exp(100 * x));
    }
    EXPECT_EQ(hash, 1040717776616088350u);
}

}  // namespace
}  // namespace carom::detail
