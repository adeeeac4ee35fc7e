#include "io/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "carom/error.hpp"
#include "io/json_text.hpp"

namespace carom::io {
namespace {

using nlohmann::json;

/// The value as it may stand in a message: short, and in one line.
std::string quoted(const json& value) {
    constexpr std::size_t longest = 60;
    if (value.is_object()) return "an object";
    if (value.is_array() && value.size() > 8) return fmt::format("a list of {}", value.size());
    if (value.is_array()) {
        std::string list;
        for (const json& element : value) list += (list.empty() ? "" : ", ") + quoted(element);
        return "[" + list + "]";
    }
    if (value.is_string() && value.get_ref<const std::string&>().size() > longest)
        return fmt::format("a text of {} bytes", value.get_ref<const std::string&>().size());
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// How many characters must be added, dropped, changed or swapped with their neighbour to make `b` of `a`
/// (Damerau 1964, restricted form).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d.back().back();
}

template <std::size_t count>
std::array<double, count> read_numbers(const Value& value, std::string_view meaning) {
    if (!value.json().is_array() || value.json().size() != count)
        value.refuse(fmt::format("is not a list of {} numbers{}", count, meaning));
    std::array<double, count> numbers{};
    std::size_t next = 0;
    for_each_element(value, [&](const Value& element) { read(element, numbers[next++]); });
    return numbers;
}

}  // namespace

std::string Value::path() const {
    if (!parent_) return {};
    const std::string before = parent_->path();
    if (index_) return fmt::format("{}[{}]", before, *index_);
    const std::string step = path_step(key_);
    return before.empty() && step.front() == '.' ? step.substr(1) : before + step;
}

void Value::fail(std::string_view message) const {
    const std::string place = path();
    throw Error(fmt::format("{}: {}{}{}", where_, place, place.empty() ? "" : ": ", message));
}

void Value::refuse(std::string_view why) const { fail(fmt::format("{} {}", quoted(json_), why)); }

void read(const Value& value, double& target) {
    if (!value.json().is_number()) value.refuse("is not a number");
    target = value.json().get<double>();
}

void read(const Value& value, bool& target) {
    if (!value.json().is_boolean()) value.refuse("is neither true nor false");
    target = value.json().get<bool>();
}

void read(const Value& value, int& target) {
    constexpr int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
    const double number = value.json().is_number_integer() ? value.json().get<double>() : 0.5;
    if (number != std::floor(number) || number < least || number > most)
        value.refuse(fmt::format("is not a whole number from {} to {}", least, most));
    target = static_cast<int>(number);
}

void read(const Value& value, std::uint64_t& target) {
    if (!value.json().is_number_unsigned())
        value.refuse(
            fmt::format("is not a whole number from 0 to {}", std::numeric_limits<std::uint64_t>::max()));
    target = value.json().get<std::uint64_t>();
}

void read(const Value& value, std::string& target) {
    if (!value.json().is_string()) value.refuse("is not a text");
    target = value.json().get<std::string>();
}

template <int D>
void read(const Value& value, Vec<D>& target) {
    const auto numbers = read_numbers<D>(value, D == 2 ? " [x, y]" : " [x, y, z]");
    for (int i = 0; i < D; ++i) target[i] = numbers[static_cast<std::size_t>(i)];
}
template void read(const Value&, Vec<2>&);
template void read(const Value&, Vec<3>&);

void read(const Value& value, Rotation<2>& target) {
    constexpr double most = 1e9;  // what the engine's sine and cosine take
    double angle = 0;
    read(value, angle);
    if (std::fabs(angle) > most) value.refuse("is not an angle from -1e9 to 1e9 rad");
    target = Rotation<2>::from_angle(angle);
}

void read(const Value& value, Rotation<3>& target) {
    // So much may be lost where numbers are written with four digits.
    constexpr double tolerance = 1e-3;
    const auto [x, y, z, w] = read_numbers<4>(value, " [x, y, z, w], a quaternion");
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    if (!(std::fabs(length - 1) <= tolerance))
        value.refuse(fmt::format("has the length {:.6g}; a rotation has 1", length));
    target = normalized(Rotation<3>{x, y, z, w});
}

void read(const Value& value, Symmetric3<double>& target) {
    if (!value.json().is_array() || value.json().size() != 3)
        value.refuse("is neither a list of 3 numbers nor a symmetric 3x3 matrix");
    if (!value.json().front().is_array()) {
        const auto [xx, yy, zz] = read_numbers<3>(value, "");
        target = {xx, yy, zz, 0, 0, 0};
        return;
    }
    Vec3 rows[3];
    int next = 0;
    for_each_element(value, [&](const Value& row) { read(row, rows[next++]); });
    if (rows[0].y != rows[1].x || rows[0].z != rows[2].x || rows[1].z != rows[2].y)
        value.refuse("is not symmetric");
    target = {rows[0].x, rows[1].y, rows[2].z, rows[0].y, rows[0].z, rows[1].z};
}

Field not_negative(std::string_view key, double& target) {
    return {key, [&target](const Value& value) {
                read(value, target);
                if (target < 0) value.refuse("is negative");
            }};
}

const json& member(const Value& object, std::string_view key) {
    if (!object.json().is_object()) object.refuse("is not an object");
    const auto found = object.json().find(key);
    if (found == object.json().end()) object.fail(fmt::format("\"{}\" is missing", key));
    return *found;
}

void read_object(const Value& value, const Fields& fields) {
    for_each_entry(value, [&](const Value& entry) {
        if (std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.key == entry.key(); }))
            return;
        std::vector<std::string_view> known;
        for (const Field& field : fields) known.push_back(field.key);
        entry.fail(fmt::format("this key is not known{}; allowed are {}", suggestion(entry.key(), known),
                               listed(known)));
    });
    for (const Field& field : fields) {
        if (field.required || value.json().contains(field.key))
            field.read(Value(value, member(value, field.key), field.key));
    }
}

Fields operator+(Fields first, Fields second) {
    std::move(second.begin(), second.end(), std::back_inserter(first));
    return first;
}

std::string listed(std::span<const std::string_view> names) {
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string suggestion(std::string_view written, std::span<const std::string_view> names) {
    // Beyond a few slips, and in the shortest names, what is near is another word rather than this one.
    constexpr std::size_t longest = 40, most_slips = 3;
    if (written.size() > longest) return {};
    std::string_view nearest;
    std::size_t least = std::min(written.size() / 2, most_slips) + 1;
    for (const std::string_view name : names) {
        if (name.size() > longest) continue;
        const std::size_t distance = edit_distance(written, name);
        if (distance < least) {
            least = distance;
            nearest = name;
        }
    }
    return nearest.empty() ? std::string() : fmt::format(" (did you mean \"{}\"?)", nearest);
}

std::size_t read_choice(const Value& value, std::span<const std::string_view> names) {
    std::string written;
    read(value, written);
    const auto found = std::find(names.begin(), names.end(), written);
    if (found == names.end())
        value.refuse(
            fmt::format("is not known{}; allowed are {}", suggestion(written, names), listed(names)));
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace carom::io
