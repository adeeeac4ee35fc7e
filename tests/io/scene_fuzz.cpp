#include <array>
#include <filesystem>
#include <random>

#include "support.hpp"

namespace carom::io {
namespace {

std::vector<std::string> scene_texts() {
    std::vector<std::string> texts;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(CAROM_SOURCE_DIR "/scenes"))
        if (entry.path().extension() == ".json" && entry.file_size() < 20'000)
            texts.push_back(file_text(entry.path()));
    texts.push_back(
        shape_text(3, R"("type": "hull", "points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "rounding": 0.1)"));
    texts.push_back(shape_text(3, R"("type": "cylinder", "radius": 1, "height": 2, "material": "m")"));
    texts.push_back(
        body_text(3, R"("mass": 2, "inertia": [[2,0,0],[0,2,0],[0,0,3]], "rotation": [0,0,0,1])"));
    texts.push_back(
        body_text(2, R"("type": "kinematic", "locks": ["x"], "velocity": [1e3, 0], "bullet": true)"));
    texts.push_back(force_text(2, R"("type": "spring", "b": "b", "stiffness": 10, "to": 2)"));
    texts.push_back(force_text(2, R"("type": "buoyancy", "surface": 1, "density": 900, "drag": 0.5)"));
    texts.push_back(force_text(3, R"("type": "drag", "quadratic": 0.5, "linear": 1)"));
    return texts;
}

/// Puts `word` in the place of the token after `at` that is made of `characters`.
void replace_token(std::string& text, std::size_t at, std::string_view characters, std::string_view word) {
    const std::size_t start = text.find_first_of(characters, at);
    if (start == text.npos) return;
    const std::size_t end = std::min(text.find_first_not_of(characters, start), text.size());
    text.replace(start, end - start, word);
}

/// Spoils a text in one of the ways in which files are spoilt.
void mutate(std::string& text, std::mt19937_64& random) {
    static constexpr std::array<std::string_view, 15> numbers = {
        "-1",    "0",      "0.001",  "2",      "3.5",
        "17",    "-0.25",  "1e5",    "1e-9",   "1e999",
        "1e308", "-1e308", "5e-324", "1e-300", "18446744073709551615"};
    static constexpr std::array<std::string_view, 13> words = {"NaN",     "null",    "true",    "[]", "{}",
                                                               "\"\"",    "\"x\"",   "[[[[",    "}}", "\xff",
                                                               "\\u0000", "[0,0,0]", "\"type\""};
    if (text.empty()) return;
    const std::size_t at = random() % text.size();
    switch (random() % 20) {
        case 0:
            text[at] = static_cast<char>(random());
            break;
        case 1:
            text.erase(at, random() % 12);
            break;
        case 2:
            text.insert(at, text.substr(random() % text.size(), 12));
            break;
        case 3:
            text.resize(at);
            break;
        case 4:
        case 5:
            replace_token(text, at, "abcdefghijklmnopqrstuvwxyz_\"[]", words[random() % words.size()]);
            break;
        default:
            replace_token(text, at, "0123456789.-+e", numbers[random() % numbers.size()]);
    }
}

TEST(SceneFuzz, spoilt_scenes_are_refused_or_simulated) {
    std::mt19937_64 random(20'240'611);
    const std::vector<std::string> texts = scene_texts();
    const std::string where = CAROM_SOURCE_DIR "/scenes/3d/fuzz.json";  // beside the meshes that scenes name
    int refused = 0, simulated = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string text = texts[random() % texts.size()];
        for (auto count = 1 + random() % 2; count > 0; --count) mutate(text, random);
        try {
            const Scene scene = parse_scene(text, where);
            const auto step = [&](auto built) { built.world.step(scene.step); };
            scene.dimension() == 2 ? step(build<2>(scene)) : step(build<3>(scene));
            ++simulated;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, where.size() + 1), where + ":") << error.what();
            ++refused;
        }
    }
    EXPECT_GT(refused, 300);
    EXPECT_GT(simulated, 300);
}

}  // namespace
}  // namespace carom::io
