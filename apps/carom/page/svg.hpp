#pragma once

#include <string>
#include <string_view>

#include "validate/case.hpp"
#include "validate/figure.hpp"

namespace carom::app {

/// The text as HTML and SVG want it.
std::string escaped(std::string_view text);

/// The figure as an inline SVG element. Throws nothing; points that are not finite are left out.
std::string svg_of(const Figure& figure);

/// Where the error of a result lies against its bounds, on a logarithmic scale from 1e-15 to 10.
std::string error_bar(const Result& result);

}  // namespace carom::app
