#pragma once

#include <string_view>

namespace carom {

/// The version of the library, `major.minor.patch`.
inline constexpr std::string_view version = "0.1.0";

}  // namespace carom
