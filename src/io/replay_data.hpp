#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/replay.hpp"

namespace carom::io {

/// A compressed part of a replay: what stands in it, and the bytes as text.
struct ReplayData {
    nlohmann::json description;
    std::string text;  ///< base64 of a zlib stream
};

/// The motion of all bodies, quantised, differenced in time and compressed (docs/replay-format.md).
ReplayData encode_motion(const Replay& replay);

/// The contacts of all frames, or of every 2nd, 4th, … when they exceed `replay.contact_bytes`.
ReplayData encode_contacts(const Replay& replay);

/// The first finite position of a body, from which its motion is counted; the origin if it has none.
ReplayVector start_position(const Replay& replay, std::size_t body);

}  // namespace carom::io
