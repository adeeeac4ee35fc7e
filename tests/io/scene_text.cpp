#include "io/json_text.hpp"
#include "support.hpp"

namespace carom::io {
namespace {

std::string text_error(const std::string& text) {
    return error_of([&] { parse_json(text, "t"); });
}

TEST(SceneText, truncation_is_found_at_line_and_column) {
    const std::string whole = scene_text(2, "\"name\": \"x\",\n\"bodies\": [\n{}]");
    for (std::size_t length = 1; length < whole.size(); ++length) {
        const std::string message = text_error(whole.substr(0, length));
        EXPECT_NE(message.find(": line "), std::string::npos) << length << ": " << message;
    }
    EXPECT_EQ(text_error("{\"a\": [1,\n 2").substr(0, 22), "t: line 2, column 2: a");
    EXPECT_EQ(text_error("").substr(0, 22), "t: line 1, column 0: s");
}

TEST(SceneText, doubled_keys) {
    EXPECT_EQ(text_error("{\"a\": 1, \"a\": 2}"), "t: a: this key is there twice");
    EXPECT_EQ(text_error("{\"list\": [0, {\"b\": 1, \"c\": 3, \"b\": 2}]}"),
              "t: list[1].b: this key is there twice");
    EXPECT_NO_THROW(parse_json("[{\"a\": 1}, {\"a\": {\"a\": 2}}]", "t"));
}

TEST(SceneText, places_of_values_within_lists) {
    EXPECT_NE(text_error("{\"a\": [[1, 2], [3, x]]}").find("a[1][1]"), std::string::npos);
    EXPECT_NE(text_error("{\"a\": [[1, 2], [3, 4], x]}").find("a[2]"), std::string::npos);
}

TEST(SceneText, nesting_has_a_limit) {
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_NO_THROW(parse_json(nested(64), "t"));
    EXPECT_NE(text_error(nested(65)).find("stand more than 64 deep"), std::string::npos);
    EXPECT_NE(text_error(std::string(10'000'000, '[')).find("stand more than 64 deep"), std::string::npos);
    std::string objects;
    for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
    EXPECT_NE(text_error(objects).find("stand more than 64 deep"), std::string::npos);
}

TEST(SceneText, number_of_values_has_a_limit) {
    std::string many = "[0";
    for (int i = 0; i < 4'000'000; ++i) many += ",0";
    many += "]";
    EXPECT_EQ(text_error(many), "t: more than 4000000 values; a scene has fewer");
    EXPECT_NO_THROW(parse_json("[0,0]", "t", {.values = 3}));
    EXPECT_THROW(parse_json("[0,0,0]", "t", {.values = 3}), Error);
}

TEST(SceneText, byte_order_marks) {
    EXPECT_NO_THROW(parse_scene("\xef\xbb\xbf" + scene_text(2, ""), "t"));
    EXPECT_NE(text_error("\xef\xbb{}").find("line 1"), std::string::npos);
    EXPECT_NE(text_error(std::string("\xff\xfe{\0}\0", 6)).find("line 1"), std::string::npos);
}

TEST(SceneText, bytes_that_are_not_utf8) {
    for (const char* bytes : {"\xff", "\xc3(", "\xe2\x82", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xc0\xaf"}) {
        const std::string message = text_error(std::string("{\"name\": \"") + bytes + "\"}");
        EXPECT_NE(message.find("name"), std::string::npos) << message;
        EXPECT_NE(message.find("UTF-8"), std::string::npos) << message;
    }
    // Bytes in a message are escaped by the parser, so that a terminal shows them harmlessly.
    for (const char byte : text_error("\x1b[31m")) EXPECT_NE(byte, '\x1b');
}

TEST(SceneText, messages_stay_short) {
    const std::string name(5'000'000, 'x');
    EXPECT_LT(text_error("{\"" + name).size(), 500u);
    EXPECT_LT(text_error("{\"" + name + "\": 1, \"" + name + "\": 2}").size(), 500u);
    const auto refused = [](const std::string& text) { return error_of([&] { parse_and_build(text); }); };
    EXPECT_LT(refused(scene_text(2, "\"" + name + "\": 1")).size(), 500u);
    EXPECT_LT(refused(scene_text(2, "\"bodies\": \"" + name + "\"")).size(), 500u);
    EXPECT_LT(
        refused(force_text(2, "\"type\": \"force\", \"value\": [0,0], \"body\": \"" + name + "\"")).size(),
        500u);
}

TEST(SceneText, files_that_cannot_be_read) {
    const TestFolder folder;
    EXPECT_EQ(error_of([&] { load_scene(folder.path("none.json")); }),
              folder.path("none.json") + ": cannot be read: No such file or directory");
    EXPECT_EQ(error_of([&] { load_scene(folder.path("")); }),
              folder.path("") + ": this is a folder, not a file");
    EXPECT_NE(error_of([&] { load_scene("/dev/zero"); }).find("is longer than 64 MiB"), std::string::npos);
}

TEST(SceneText, a_hundred_megabytes_are_refused_unread) {
    const TestFolder folder;
    const std::string path = folder.write("big.json", "");
    std::filesystem::resize_file(path, 100u << 20);
    EXPECT_EQ(error_of([&] { load_scene(path); }), path + ": is longer than 64 MiB, the most that is read");
    EXPECT_NE(error_of([&] { parse_json(std::string((64u << 20) + 1, ' '), "t"); }).find("is longer"),
              std::string::npos);
}

TEST(SceneText, a_scene_without_a_name_takes_that_of_its_file) {
    const TestFolder folder;
    EXPECT_EQ(load_scene(folder.write("little.json", scene_text(3, ""))).name, "little");
    EXPECT_EQ(load_scene(folder.write("other.json", scene_text(3, "\"name\": \"great\""))).name, "great");
}

}  // namespace
}  // namespace carom::io
