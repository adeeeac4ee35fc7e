#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "io/json_reader.hpp"

namespace carom::io {

/// The things of a scene that may be named by others, by their names.
class IndexByName {
  public:
    /// Things without a name cannot be named.
    void add(std::string_view name, std::uint32_t index) {
        if (!name.empty()) indices_.emplace(name, index);
    }
    /// The same for a name that was read; refuses one that is taken.
    void add(const Value& value, std::string_view name, std::uint32_t index, std::string_view kind);
    /// The thing whose name the value holds; `what` says what it has to be, for the message.
    std::uint32_t find(const Value& value, std::string_view what) const;

  private:
    std::map<std::string, std::uint32_t, std::less<>> indices_;
};

}  // namespace carom::io
