#include "io/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <vector>

#include "carom/error.hpp"

namespace carom::io {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t mebibyte = 1u << 20;

/// The text up to `length` bytes, cut between two characters of UTF-8.
std::string shortened(std::string text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) --length;
    return text.substr(0, length) + "…";
}

/// The library's words without its own prefixes, such as `[json.exception.parse_error.101] parse error at
/// line 1, column 2: `.
std::string reason_of(const std::exception& error) {
    std::string reason = error.what();
    if (const auto end = reason.find("] "); reason.starts_with("[json.exception") && end != std::string::npos)
        reason.erase(0, end + 2);
    if (const auto end = reason.find(": "); reason.starts_with("parse error at") && end != std::string::npos)
        reason.erase(0, end + 2);
    return reason;
}

/// Builds the document from the events of the parser, which itself neither counts nor recurses.
class Builder final : public nlohmann::json_sax<json> {
  public:
    Builder(std::string_view text, std::string_view where, const JsonLimits& limits)
        : text_(text), where_(where), limits_(limits) {}

    json take() { return std::move(root_); }

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(json::object()); }
    bool start_array(std::size_t) override { return open(json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& key) override {
        Level& level = open_.back();
        level.key = std::move(key);
        if (level.container->contains(level.key)) refuse("this key is there twice");
        return true;
    }

    bool parse_error(std::size_t position, const std::string&, const json::exception& error) override {
        const std::string_view before = text_.substr(0, std::min(position, text_.size()));
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const auto line_start = before.find_last_of('\n');
        const auto column = line_start == before.npos ? before.size() : before.size() - line_start - 1;
        throw Error(fmt::format("{}: line {}, column {}: {}{}", where_, line, column, path_prefix(),
                                shortened(reason_of(error), limits_.message_length)));
    }

  private:
    struct Level {
        json* container;
        std::string key;  ///< of the value that is being read, in an object
    };

    json& place(json&& value) {
        if (++values_ > limits_.values)
            throw Error(fmt::format("{}: more than {} values; a scene has fewer", where_, limits_.values));
        if (open_.empty()) return root_ = std::move(value);
        Level& level = open_.back();
        if (level.container->is_array()) return level.container->emplace_back(std::move(value));
        return (*level.container)[level.key] = std::move(value);
    }

    bool add(json&& value) {
        place(std::move(value));
        return true;
    }

    bool open(json&& value) {
        if (open_.size() >= limits_.depth)
            refuse(fmt::format("lists and objects stand more than {} deep in one another", limits_.depth));
        json& container = place(std::move(value));
        open_.push_back({&container, {}});
        return true;
    }

    bool close() {
        open_.pop_back();
        return true;
    }

    /// Where in the document the parser is, as `bodies[3].radius: `.
    std::string path_prefix() const {
        std::string path;
        for (const Level& level : open_) {
            // What is open stands in its list already; the value that is being read does not.
            const bool innermost = &level == &open_.back();
            if (level.container->is_array())
                path += fmt::format("[{}]", level.container->size() - (innermost ? 0 : 1));
            else if (!level.key.empty())
                path += path_step(level.key);
        }
        if (path.starts_with('.')) path.erase(0, 1);
        if (path.size() > limits_.message_length) return {};
        return path.empty() ? path : path + ": ";
    }

    [[noreturn]] void refuse(const std::string& reason) const {
        std::string path = path_prefix();
        throw Error(fmt::format("{}: {}{}", where_, path, reason));
    }

    std::string_view text_, where_;
    JsonLimits limits_;
    json root_;
    std::vector<Level> open_;
    std::size_t values_ = 0;
};

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

std::string path_step(std::string_view key) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    const std::string shown = shortened(std::string(key), 60);
    if (!shown.empty() && std::all_of(shown.begin(), shown.end(), plain)) return "." + shown;
    return fmt::format("[{}]", json(shown).dump(-1, ' ', false, json::error_handler_t::replace));
}

std::string read_text_file(const fs::path& path, const JsonLimits& limits) {
    const auto refuse = [&](const std::string& reason) -> Error {
        return Error(fmt::format("{}: {}", path.string(), reason));
    };
    std::error_code error;
    if (fs::is_directory(path, error)) throw refuse("this is a folder, not a file");
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.string().c_str(), "rb"));
    if (!file) throw refuse("cannot be read: " + std::generic_category().message(errno));

    std::string text;
    const auto too_long = [&] {
        return refuse(fmt::format("is longer than {} MiB, the most that is read", limits.bytes / mebibyte));
    };
    // A pipe or a device has no size beforehand, so the length is watched while reading too.
    if (const auto size = fs::file_size(path, error); !error) {
        if (size > limits.bytes) throw too_long();
        text.reserve(size);
    }
    std::vector<char> chunk(mebibyte);
    while (const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), file.get())) {
        if (text.size() + count > limits.bytes) throw too_long();
        text.append(chunk.data(), count);
    }
    if (std::ferror(file.get())) throw refuse("cannot be read: " + std::generic_category().message(errno));
    return text;
}

json parse_json(std::string_view text, std::string_view where, const JsonLimits& limits) {
    if (text.size() > limits.bytes)
        throw Error(
            fmt::format("{}: is longer than {} MiB, the most that is read", where, limits.bytes / mebibyte));
    Builder builder(text, where, limits);
    json::sax_parse(text, &builder);
    return builder.take();
}

}  // namespace carom::io
