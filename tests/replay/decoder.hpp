#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace carom::io {

/// A page with nothing but the places that a replay fills in.
inline constexpr std::string_view bare_page =
    "<head>@carom-header@</head><motion>@carom-motion@</motion><contacts>@carom-contacts@</contacts>";

struct DecodedContact {
    int a, b;
    std::vector<double> position, normal;
    double impulse;
};

/// What a replay says, read as docs/replay-format.md describes it.
struct Decoded {
    nlohmann::json header;
    std::map<std::string, std::vector<double>> channels;  ///< by body, then by frame; positions from `start`
    std::vector<std::vector<DecodedContact>> contacts;    ///< of every recorded frame

    double value(const std::string& channel, std::size_t body, std::size_t frame) const;
    /// Place in the world along an axis.
    double place(int axis, std::size_t body, std::size_t frame) const;
};

/// Reads a `bare_page` that was filled in.
Decoded decode(const std::string& page);

}  // namespace carom::io
