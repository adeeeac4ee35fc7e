#include "math/check.hpp"

#include <array>
#include <charconv>

namespace carom::detail {
namespace {

void require_unit_length(double length_squared, std::string_view field) {
    const double length = std::sqrt(length_squared);
    if (!(std::fabs(length - 1) <= 1e-4)) {
        throw Error(std::string(field) + ": its length is " + to_text(length) + ", not 1");
    }
}

}  // namespace

std::string to_text(double value) {
    if (value != value) return "nan";  // without a sign
    std::array<char, 32> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), result.ptr};
}

void refuse(std::string_view field, double value, std::string_view what) {
    throw Error(std::string(field) + ": " + to_text(value) + " " + std::string(what));
}

std::string component(std::string_view field, int index) {
    return std::string(field) + "[" + std::to_string(index) + "]";
}

void require_in(double value, double lowest, double highest, std::string_view field) {
    require_finite(value, field);
    if (value < lowest || value > highest) {
        refuse(field, value, "is not between " + to_text(lowest) + " and " + to_text(highest));
    }
}

void require_finite(const Symmetric3<double>& value, std::string_view field) {
    for (const double entry : {value.xx, value.yy, value.zz, value.xy, value.xz, value.yz}) {
        require_finite(entry, field);
    }
}

void require_unit(const Rotation2& value, std::string_view field) {
    require_unit_length(value.c * value.c + value.s * value.s, field);
}

void require_unit(const Rotation3& value, std::string_view field) {
    require_unit_length(value.x * value.x + value.y * value.y + value.z * value.z + value.w * value.w, field);
}

}  // namespace carom::detail
