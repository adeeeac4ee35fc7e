#include "io/obj.hpp"

#include <fmt/format.h>

#include <charconv>

#include "carom/error.hpp"
#include "io/json_text.hpp"

namespace carom::io {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

class ObjReader {
  public:
    explicit ObjReader(std::string_view where) : where_(where) {}

    void read_line(std::string_view line) {
        ++line_;
        rest_ = line.substr(0, line.find('#'));
        const std::string_view keyword = next_word();
        if (keyword == "v") read_vertex();
        if (keyword == "f") read_face();
    }
    Mesh& mesh() { return mesh_; }

  private:
    [[noreturn]] void fail(std::string_view what) const {
        throw Error(fmt::format("{}: line {}: {}", where_, line_, what));
    }

    /// The next word of the line; empty at its end.
    std::string_view next_word() {
        const std::size_t start = std::min(rest_.find_first_not_of(blanks), rest_.size());
        const std::size_t end = std::min(rest_.find_first_of(blanks, start), rest_.size());
        const std::string_view word = rest_.substr(start, end - start);
        rest_.remove_prefix(end);
        return word;
    }

    template <class Number>
    Number number(std::string_view word, std::string_view what) const {
        std::string_view digits = word;
        if (digits.starts_with('+')) digits.remove_prefix(1);
        Number result{};
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), result);
        if (error != std::errc() || end != digits.data() + digits.size())
            fail(fmt::format("\"{}\" is not {}", word.substr(0, 40), what));
        return result;
    }

    void read_vertex() {
        Vec3 vertex;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = next_word();
            if (word.empty()) fail("a vertex needs three coordinates");
            vertex[i] = number<double>(word, "a number");
        }
        mesh_.vertices.push_back(vertex);
    }

    std::uint32_t read_corner(std::string_view word) const {
        const auto written = number<long long>(word.substr(0, word.find('/')), "the index of a vertex");
        const auto count = static_cast<long long>(mesh_.vertices.size());
        const long long index = written < 0 ? count + written : written - 1;
        if (index < 0 || index >= count)
            fail(fmt::format("{} is not the index of one of the {} vertices before it", written, count));
        return static_cast<std::uint32_t>(index);
    }

    void read_face() {
        std::uint32_t first = 0, last = 0;
        int corners = 0;
        for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
            const std::uint32_t corner = read_corner(word);
            if (corners == 0) first = corner;
            if (corners >= 2 && first != last && last != corner && corner != first)
                mesh_.triangles.push_back({first, last, corner});
            last = corner;
            ++corners;
        }
        if (corners < 3) fail("a face needs three corners at least");
    }

    std::string_view where_;
    std::string_view rest_;
    std::size_t line_ = 0;
    Mesh mesh_;
};

}  // namespace

Mesh parse_obj(std::string_view text, std::string_view where) {
    ObjReader reader(where);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        reader.read_line(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return std::move(reader.mesh());
}

Mesh load_obj(const std::filesystem::path& path) {
    JsonLimits limits;
    limits.bytes = std::size_t{1} << 30;
    return parse_obj(read_text_file(path, limits), path.string());
}

}  // namespace carom::io
