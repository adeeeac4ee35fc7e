#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "carom/inertia.hpp"
#include "carom/rotation.hpp"
#include "carom/vec.hpp"

namespace carom::io {

/// A value of a JSON document that knows its place in it, for messages. It refers to the value that it was
/// reached from, so it lives within the block that reads that one.
class Value {
  public:
    /// The whole document; `where` names its file.
    Value(const nlohmann::json& json, std::string_view where) : json_(json), where_(where) {}
    Value(const Value& parent, const nlohmann::json& json, std::string_view key)
        : json_(json), where_(parent.where_), parent_(&parent), key_(key) {}
    Value(const Value& parent, const nlohmann::json& json, std::size_t index)
        : json_(json), where_(parent.where_), parent_(&parent), index_(index) {}
    Value(const Value&) = delete;
    Value& operator=(const Value&) = delete;

    const nlohmann::json& json() const { return json_; }
    std::string_view where() const { return where_; }
    std::string_view key() const { return key_; }
    /// For example `bodies[3].shapes[0].radius`; empty for the whole document.
    std::string path() const;

    /// Throws `Error` "file: path: value why".
    [[noreturn]] void refuse(std::string_view why) const;
    /// Throws `Error` "file: path: message".
    [[noreturn]] void fail(std::string_view message) const;

  private:
    const nlohmann::json& json_;
    std::string_view where_;
    const Value* parent_ = nullptr;
    std::string_view key_{};
    std::optional<std::size_t> index_{};
};

// Each `read` takes a value of the type that it gives and refuses any other.
void read(const Value& value, double& target);
void read(const Value& value, bool& target);
void read(const Value& value, int& target);
void read(const Value& value, std::uint64_t& target);
void read(const Value& value, std::string& target);
template <int D>
void read(const Value& value, Vec<D>& target);
/// An angle, rad.
void read(const Value& value, Rotation<2>& target);
/// A quaternion [x, y, z, w] of unit length, within a thousandth.
void read(const Value& value, Rotation<3>& target);
/// Three principal values, or a symmetric 3×3 matrix.
void read(const Value& value, Symmetric3<double>& target);

template <class T>
void read(const Value& value, std::optional<T>& target) {
    read(value, target.emplace());
}

/// Calls `visit(Value)` for each element of a list; refuses what is not a list.
template <class Visit>
void for_each_element(const Value& value, Visit visit) {
    if (!value.json().is_array()) value.refuse("is not a list");
    std::size_t index = 0;
    for (const nlohmann::json& element : value.json()) visit(Value(value, element, index++));
}

/// Calls `visit(Value)` for each entry of an object; refuses what is not an object.
template <class Visit>
void for_each_entry(const Value& value, Visit visit) {
    if (!value.json().is_object()) value.refuse("is not an object");
    for (const auto& [key, entry] : value.json().items()) visit(Value(value, entry, key));
}

template <int D>
void read(const Value& value, std::vector<Vec<D>>& target) {
    target.clear();
    for_each_element(value, [&](const Value& element) { read(element, target.emplace_back()); });
}

/// One key of an object, and how its value is read.
struct Field {
    std::string_view key;
    std::function<void(const Value&)> read;
    bool required = false;
};
using Fields = std::vector<Field>;

/// A key that may be left out; `target` is where its value goes, or a function that takes the value.
template <class Target>
Field field(std::string_view key, Target&& target) {
    if constexpr (std::is_invocable_v<Target&, const Value&>)
        return {key, std::forward<Target>(target)};
    else
        return {key, [&target](const Value& value) { read(value, target); }};
}

/// A key that must be there.
template <class Target>
Field required(std::string_view key, Target&& target) {
    Field result = field(key, std::forward<Target>(target));
    result.required = true;
    return result;
}

/// A number that is not negative.
Field not_negative(std::string_view key, double& target);

/// What an object holds at a key that must be there. Refuses what is not an object.
const nlohmann::json& member(const Value& object, std::string_view key);

/// Reads an object by its fields, in their order. Refuses keys that are none of them.
void read_object(const Value& value, const Fields& fields);

/// `first` and then `second`.
Fields operator+(Fields first, Fields second);

/// The names in a list, for messages: `a, b, c`.
std::string listed(std::span<const std::string_view> names);

/// " (did you mean …?)" with the name that is nearest to what was written; empty when none is near.
std::string suggestion(std::string_view written, std::span<const std::string_view> names);

/// A text that stands for one of several things.
template <class T>
using Choices = std::span<const std::pair<std::string_view, T>>;

/// Gives the index of the name that the value holds, and refuses any other text.
std::size_t read_choice(const Value& value, std::span<const std::string_view> names);

template <class T>
void read_choice(const Value& value, std::type_identity_t<Choices<T>> choices, T& target) {
    std::vector<std::string_view> names;
    for (const auto& [name, meaning] : choices) names.push_back(name);
    target = choices[read_choice(value, names)].second;
}

}  // namespace carom::io
