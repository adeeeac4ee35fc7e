#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "carom/error.hpp"
#include "io/scene.hpp"

namespace carom::io {

/// A folder of its own for a test's files, removed with it.
class TestFolder {
  public:
    TestFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::path(testing::TempDir()) /
                (std::string("carom_") + test->test_suite_name() + "_" + test->name());
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TestFolder() { std::filesystem::remove_all(path_); }

    std::string path(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    }
    bool empty() const { return std::filesystem::is_empty(path_); }

  private:
    std::filesystem::path path_;
};

inline std::string file_text(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// What the error says that `act` throws; a text that matches nothing when it throws none.
template <class Act>
std::string error_of(Act act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "(no error)";
}

/// Reads a scene and makes its world, as the program does.
inline void parse_and_build(const std::string& text) {
    const Scene scene = parse_scene(text, "test.json");
    scene.dimension() == 2 ? void(build<2>(scene)) : void(build<3>(scene));
}

/// A scene with these entries beside `carom` and `dimension`.
inline std::string scene_text(int dimension, const std::string& entries) {
    return "{\"carom\": 1, \"dimension\": " + std::to_string(dimension) + (entries.empty() ? "" : ", ") +
           entries + "}";
}

/// A scene with one body of these entries.
inline std::string body_text(int dimension, const std::string& entries) {
    return scene_text(dimension, "\"bodies\": [{" + entries + "}]");
}

/// A scene with one body of one shape of these entries.
inline std::string shape_text(int dimension, const std::string& entries) {
    return body_text(dimension, "\"shapes\": [{" + entries + "}]");
}

/// A scene with a ball named "b" and one force of these entries.
inline std::string force_text(int dimension, const std::string& entries) {
    return scene_text(dimension,
                      "\"bodies\": [{\"name\": \"b\", \"shapes\": [{\"type\": \"ball\", \"radius\": 1}]}], "
                      "\"forces\": [{" +
                          entries + "}]");
}

}  // namespace carom::io
