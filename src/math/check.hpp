#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "carom/error.hpp"
#include "carom/inertia.hpp"
#include "carom/rotation.hpp"
#include "carom/vec.hpp"

/// Checks of what users give us. Each throws `Error` with a message like `radius: -1 is not positive`.
namespace carom::detail {

/// The number in as few digits as give it back exactly.
std::string to_text(double value);

/// Throws the error `field: value what`, for example `radius: -1 is not positive`.
[[noreturn]] void refuse(std::string_view field, double value, std::string_view what);

/// The name of a component, as it is written in C++ and in JSON: `size[1]`.
std::string component(std::string_view field, int index);

inline bool is_finite(double value) { return std::fabs(value) <= std::numeric_limits<double>::max(); }

inline void require_finite(double value, std::string_view field) {
    if (!is_finite(value)) refuse(field, value, "is not finite");
}

inline void require_positive(double value, std::string_view field) {
    require_finite(value, field);
    if (!(value > 0)) refuse(field, value, "is not positive");
}

inline void require_not_negative(double value, std::string_view field) {
    require_finite(value, field);
    if (value < 0) refuse(field, value, "is negative");
}

void require_in(double value, double lowest, double highest, std::string_view field);

template <int D>
void require_in(const Vec<D>& value, double lowest, double highest, std::string_view field) {
    for (int i = 0; i < D; ++i) {
        if (!(value[i] >= lowest && value[i] <= highest)) {
            require_in(value[i], lowest, highest, component(field, i));
        }
    }
}

template <int D>
void require_finite(const Vec<D>& value, std::string_view field) {
    for (int i = 0; i < D; ++i) {
        if (!is_finite(value[i])) refuse(component(field, i), value[i], "is not finite");
    }
}

template <int D>
void require_positive(const Vec<D>& value, std::string_view field) {
    require_finite(value, field);
    for (int i = 0; i < D; ++i) {
        if (!(value[i] > 0)) refuse(component(field, i), value[i], "is not positive");
    }
}

void require_finite(const Symmetric3<double>& value, std::string_view field);

/// The length must be 1, within 1e-4.
void require_unit(const Rotation2& value, std::string_view field);
void require_unit(const Rotation3& value, std::string_view field);

}  // namespace carom::detail
