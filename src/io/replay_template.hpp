#pragma once

#include <string_view>

namespace carom::io {

/// The HTML page that plays a replay, without its data, as built from web/replay.
/// Empty when the program was built without it (CAROM_BUILD_REPLAY off).
std::string_view replay_template();

}  // namespace carom::io
