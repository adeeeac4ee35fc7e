#pragma once

#include <cmath>

/// The lane functions for one lane: `float` itself. Constraint rows are written with these names only, so
/// that the same rows run on wide lanes, whose masks are not `bool`.
namespace carom::detail {

inline float maximum(float a, float b) { return a > b ? a : b; }
inline float minimum(float a, float b) { return a < b ? a : b; }
inline float square_root(float a) { return std::sqrt(a); }

}  // namespace carom::detail
