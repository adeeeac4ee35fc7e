#include "io/names.hpp"

#include <fmt/format.h>

namespace carom::io {

void IndexByName::add(const Value& value, std::string_view name, std::uint32_t index, std::string_view kind) {
    if (name.empty()) value.refuse("is empty; leave the key out instead");
    if (!indices_.emplace(name, index).second)
        value.refuse(fmt::format("is the name of an earlier {} already", kind));
}

std::uint32_t IndexByName::find(const Value& value, std::string_view what) const {
    std::string name;
    read(value, name);
    const auto found = indices_.find(name);
    if (found != indices_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [known_name, index] : indices_) known.push_back(known_name);
    value.refuse(fmt::format("is not the name of {}{}", what, suggestion(name, known)));
}

}  // namespace carom::io
