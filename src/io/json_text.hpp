#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace carom::io {

/// What a text may hold at most. The limits are far above any scene, and keep a file that is none from
/// taking minutes or the machine's memory.
struct JsonLimits {
    std::size_t bytes = 64u << 20;     ///< length of the file
    std::size_t depth = 64;            ///< lists and objects within one another
    std::size_t values = 4'000'000;    ///< numbers, texts, lists, …, altogether
    std::size_t message_length = 200;  ///< longest reason in a message
};

/// The whole of a file. Throws `Error` that names the file when it cannot be read or is too long.
std::string read_text_file(const std::filesystem::path& path, const JsonLimits& limits = {});

/// Reads JSON (UTF-8, with or without a byte order mark). Beyond what JSON itself asks, a key may stand in an
/// object once only, and numbers must fit a double. Throws `Error` that names `where` (the file), line,
/// column and path of the fault.
nlohmann::json parse_json(std::string_view text, std::string_view where, const JsonLimits& limits = {});

/// One step into a JSON path: `.key`, or `["odd key"]` where a key is not a plain word.
std::string path_step(std::string_view key);

}  // namespace carom::io
