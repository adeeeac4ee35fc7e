#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "validate/figure.hpp"

namespace carom::app {

/// How close to the reference a result must be in every build (`hard`), and how close the most accurate
/// engine of its class should come (`gold`).
struct Bounds {
    double hard = 0;
    std::optional<double> gold{};
};

/// One number that a case measured.
struct Result {
    std::string what;  ///< for example "distance at 2 s, friction 0.3"
    double reference = 0;
    double result = 0;
    double error = 0;  ///< absolute or relative, as the bounds are
    Bounds bounds{};

    /// `gold`, `hard` (that bound alone is met) or `fail`. A result that is not a number fails.
    std::string_view status() const {
        if (bounds.gold && error <= *bounds.gold) return "gold";
        return error <= bounds.hard ? "hard" : "fail";
    }
};

/// A result whose error is |result − reference|.
inline Result absolute(std::string what, double reference, double result, Bounds bounds) {
    return {std::move(what), reference, result, std::fabs(result - reference), bounds};
}

/// A result whose error is |result − reference| / |reference|.
inline Result relative(std::string what, double reference, double result, Bounds bounds) {
    return {std::move(what), reference, result, std::fabs(result - reference) / std::fabs(reference), bounds};
}

/// A physics case with a known answer.
struct Case {
    std::string_view name;         ///< for example "A1"
    std::string_view description;  ///< a line
    std::vector<Result> (*measure)();
    std::vector<Figure> (*figures)() = nullptr;  ///< what it looks like, for those that show it
};

/// All cases, in the order in which they run.
std::span<const Case> validation_cases();

}  // namespace carom::app
