#include <gtest/gtest.h>

namespace {

struct Wide {
    double x, y;
};
struct Narrow {
    float x, y;
};

/// What is lost when two numbers are rounded to float, written as the solver does it. It is a function of its
/// own, behind a volatile pointer, so that it is compiled for any numbers and not for those of the test.
Narrow lost_by_rounding(const Wide& wide, Narrow& rounded) {
    rounded = {static_cast<float>(wide.x), static_cast<float>(wide.y)};
    const Wide back{static_cast<double>(rounded.x), static_cast<double>(rounded.y)};
    return {static_cast<float>(wide.x - back.x), static_cast<float>(wide.y - back.y)};
}

/// Twice the same product and sum, which a fused multiply-add would round differently.
double product_and_sum(double a, double b, double c) { return a * b + c; }

Narrow (*volatile lost_function)(const Wide&, Narrow&) = lost_by_rounding;
double (*volatile product_function)(double, double, double) = product_and_sum;

// GCC 12 takes the rounding for nothing when it vectorises straight code.
TEST(Rounding, IsNotOptimisedAway) {
    Narrow rounded{};
    const Narrow lost = lost_function({0.1, 0.3}, rounded);
    EXPECT_EQ(rounded.x, 0.1f);
    EXPECT_EQ(rounded.y, 0.3f);
    EXPECT_EQ(lost.x, static_cast<float>(0.1 - 0.10000000149011612));
    EXPECT_EQ(lost.y, static_cast<float>(0.3 - 0.30000001192092896));
}

// (1 + 2⁻³⁰)² = 1 + 2⁻²⁹ + 2⁻⁶⁰, whose last term only a fused operation would see.
TEST(Rounding, ProductsAreNotFusedWithSums) {
    const double a = 1 + 0x1p-30;
    EXPECT_EQ(product_function(a, a, -(1 + 0x1p-29)), 0);
}

}  // namespace
