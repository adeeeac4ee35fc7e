#include "math/check.hpp"

#include <gtest/gtest.h>

namespace carom::detail {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Action>
std::string message_of(Action action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Check, NumbersAreShortAndExact) {
    EXPECT_EQ(to_text(-1), "-1");
    EXPECT_EQ(to_text(0.1), "0.1");
    EXPECT_EQ(to_text(1.0 / 3), "0.3333333333333333");
    EXPECT_EQ(to_text(1e300), "1e+300");
    EXPECT_EQ(to_text(-infinity), "-inf");
    EXPECT_EQ(to_text(-not_a_number), "nan");
}

TEST(Check, Numbers) {
    EXPECT_EQ(message_of([] { require_finite(1e308, "x"); }), "no error");
    EXPECT_EQ(message_of([] { require_finite(infinity, "x"); }), "x: inf is not finite");
    EXPECT_EQ(message_of([] { require_finite(not_a_number, "x"); }), "x: nan is not finite");
    EXPECT_EQ(message_of([] { require_positive(5e-324, "radius"); }), "no error");
    EXPECT_EQ(message_of([] { require_positive(0, "radius"); }), "radius: 0 is not positive");
    EXPECT_EQ(message_of([] { require_positive(-1, "radius"); }), "radius: -1 is not positive");
    EXPECT_EQ(message_of([] { require_positive(infinity, "radius"); }), "radius: inf is not finite");
    EXPECT_EQ(message_of([] { require_positive(not_a_number, "radius"); }), "radius: nan is not finite");
    EXPECT_EQ(message_of([] { require_not_negative(0, "density"); }), "no error");
    EXPECT_EQ(message_of([] { require_not_negative(-0.5, "density"); }), "density: -0.5 is negative");
    EXPECT_EQ(message_of([] { require_not_negative(not_a_number, "density"); }),
              "density: nan is not finite");
    EXPECT_EQ(message_of([] { require_in(0, 0, 1, "restitution"); }), "no error");
    EXPECT_EQ(message_of([] { require_in(1, 0, 1, "restitution"); }), "no error");
    EXPECT_EQ(message_of([] { require_in(1.5, 0, 1, "restitution"); }),
              "restitution: 1.5 is not between 0 and 1");
    EXPECT_EQ(message_of([] { require_in(not_a_number, 0, 1, "restitution"); }),
              "restitution: nan is not finite");
}

TEST(Check, Vectors) {
    EXPECT_EQ(message_of([] { require_finite(Vec3{1, 2, 3}, "center"); }), "no error");
    EXPECT_EQ(message_of([] {
                  require_finite(Vec3{1, 2, infinity}, "center");
              }),
              "center[2]: inf is not finite");
    EXPECT_EQ(message_of([] { require_positive(Vec2{1, 0}, "size"); }), "size[1]: 0 is not positive");
    EXPECT_EQ(message_of([] {
                  require_positive(Vec2{not_a_number, 0}, "size");
              }),
              "size[0]: nan is not finite");
    EXPECT_EQ(message_of([] {
                  require_in(Vec2{1, -3}, -2, 2, "from");
              }),
              "from[1]: -3 is not between -2 and 2");
    EXPECT_EQ(message_of([] {
                  require_in(Vec2{not_a_number, 0}, -2, 2, "from");
              }),
              "from[0]: nan is not finite");
    EXPECT_EQ(message_of([] {
                  require_finite(Symmetric3<double>{1, 1, 1, 0, not_a_number, 0}, "inertia");
              }),
              "inertia: nan is not finite");
}

TEST(Check, Rotations) {
    EXPECT_EQ(message_of([] { require_unit(Rotation2{0.6, 0.8}, "rotation"); }), "no error");
    EXPECT_EQ(message_of([] { require_unit(Rotation2{1.00009, 0}, "rotation"); }), "no error");
    EXPECT_EQ(message_of([] {
                  require_unit(Rotation2{3, 4}, "rotation");
              }),
              "rotation: its length is 5, not 1");
    EXPECT_EQ(message_of([] {
                  require_unit(Rotation3{0, 0, 0, 0}, "rotation");
              }),
              "rotation: its length is 0, not 1");
    EXPECT_EQ(message_of([] { require_unit(Rotation3{0.5, 0.5, 0.5, 0.5}, "rotation"); }), "no error");
    EXPECT_EQ(message_of([] {
                  require_unit(Rotation2{not_a_number, 0}, "rotation");
              }),
              "rotation: its length is nan, not 1");
}

TEST(Check, RotationsFromBadAngles) {
    EXPECT_EQ(message_of([] { Rotation2::from_angle(infinity); }), "angle: inf is not finite");
    EXPECT_EQ(message_of([] { Rotation3::from_axis_angle({0, 0, 0}, 1); }), "axis: all components are zero");
    EXPECT_EQ(message_of([] {
                  Rotation3::from_axis_angle({0, not_a_number, 0}, 1);
              }),
              "axis[1]: nan is not finite");
    EXPECT_EQ(message_of([] {
                  Rotation3::from_axis_angle({0, 1, 0}, not_a_number);
              }),
              "angle: nan is not finite");
}

}  // namespace
}  // namespace carom::detail
