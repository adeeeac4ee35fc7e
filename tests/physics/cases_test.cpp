#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Every case of `carom validate` meets its hard bounds, and its gold bounds where that is promised.

namespace {

struct Output {
    std::string text;
    int status = -1;
};

Output validate(const std::string& arguments) {
    const std::string command = std::string("'") + CAROM_PROGRAM + "' validate " + arguments;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return {};
    Output output;
    std::array<char, 4096> part;
    for (std::size_t n = 0; (n = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
        output.text.append(part.data(), n);
    output.status = pclose(pipe);
    return output;
}

const char* const names[] = {"A1", "A2", "A3", "A4", "A5", "B1", "B2", "B3", "B4", "B6", "B7", "B8", "B15",
                             "C1", "C2", "C3", "C5", "C6", "D4", "E1", "E2", "E3", "E4", "E5", "E6", "E7"};

class PhysicsCase : public testing::TestWithParam<const char*> {};

TEST_P(PhysicsCase, MeetsItsHardBounds) {
    const Output output = validate(std::string(GetParam()) + " --json");
    EXPECT_EQ(output.status, 0);
    const nlohmann::json results = nlohmann::json::parse(output.text, nullptr, false);
    ASSERT_TRUE(results.is_array()) << output.text;
    ASSERT_FALSE(results.empty());
    for (const nlohmann::json& r : results) EXPECT_NE(r.at("status"), "fail") << r.dump(2);
}

INSTANTIATE_TEST_SUITE_P(All, PhysicsCase, testing::ValuesIn(names),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(PhysicsCases, ListHasNoOthers) {
    std::string expected;
    for (const char* name : names) expected += std::string(name) + "\n";
    std::string listed;
    const Output output = validate("--list");
    for (std::size_t at = 0; at < output.text.size();) {
        const std::size_t end = output.text.find('\n', at);
        listed += output.text.substr(at, output.text.find(' ', at) - at) + "\n";
        if (end == std::string::npos) break;
        at = end + 1;
    }
    EXPECT_EQ(listed, expected);
}

/// Every result of the case whose description holds all of `parts` is gold, and there is one.
void expect_gold(const std::string& name, const std::vector<std::string>& parts) {
    const nlohmann::json results = nlohmann::json::parse(validate(name + " --json").text, nullptr, false);
    ASSERT_TRUE(results.is_array());
    int found = 0;
    for (const nlohmann::json& r : results) {
        const std::string what = r.at("what");
        const auto in_it = [&](const std::string& part) { return what.find(part) != std::string::npos; };
        if (!std::all_of(parts.begin(), parts.end(), in_it)) continue;
        EXPECT_EQ(r.at("status"), "gold") << r.dump(2);
        ++found;
    }
    EXPECT_GT(found, 0);
}

TEST(PhysicsCases, DefaultWorldFliesExactly) { expect_gold("A1", {"default world"}); }
TEST(PhysicsCases, TennisRacketIsGold) { expect_gold("A5", {}); }
TEST(PhysicsCases, BouncingBallIsGold) { expect_gold("B6", {}); }
TEST(PhysicsCases, CradlesAreGold) {
    expect_gold("B8", {"in empty space"});
    expect_gold("B8", {"smooth floor"});
}
TEST(PhysicsCases, MirrorImagesAreGold) { expect_gold("B8", {"asymmetry"}); }
TEST(PhysicsCases, FrictionIsTheSameInEveryDirection) { expect_gold("B2", {"upright", "spread"}); }

}  // namespace
