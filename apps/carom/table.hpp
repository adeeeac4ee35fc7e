#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace carom::app {

/// A heading and rows of text, printed with columns that line up: words to the left, numbers to the right.
class Table {
  public:
    struct Column {
        std::string_view heading;
        bool number = false;
    };
    explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    std::string text() const;

  private:
    std::vector<Column> columns_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace carom::app
