#pragma once

#include <span>
#include <string>
#include <vector>

#include "validate/case.hpp"

namespace carom::app {

/// A case and what it measured.
struct MeasuredCase {
    Case measured;
    std::vector<Result> results;
};

/// A page that shows the cases with their results, bounds and figures; it needs nothing beside itself.
std::string validation_page(std::span<const MeasuredCase> cases);

}  // namespace carom::app
