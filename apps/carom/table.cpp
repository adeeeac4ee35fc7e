#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace carom::app {

std::string Table::text() const {
    std::vector<std::size_t> widths;
    for (const Column& column : columns_) widths.push_back(column.heading.size());
    for (const auto& row : rows_)
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], fmt::formatted_size("{}", row[i]));

    std::string result;
    const auto add_line = [&](const auto& cell) {
        std::string line;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (i > 0) line += "  ";
            line += columns_[i].number ? fmt::format("{:>{}}", cell(i), widths[i])
                                       : fmt::format("{:<{}}", cell(i), widths[i]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        result += line + '\n';
    };
    add_line([&](std::size_t i) { return columns_[i].heading; });
    for (const auto& row : rows_) add_line([&](std::size_t i) { return std::string_view(row[i]); });
    return result;
}

}  // namespace carom::app
