#include "io/chrome_trace.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "carom/carom.hpp"

namespace carom::io {
namespace {

World2 falling_box() {
    World2 world;
    BodyDefinition2 ground;
    ground.type = BodyType::fixed;
    ground.shapes.push_back({Box<2>{Vec2{10, 1}}});
    world.add_body(ground);
    BodyDefinition2 box;
    box.position = {0, 1.02};
    box.shapes.push_back({Box<2>{Vec2{1, 1}}});
    world.add_body(box);
    return world;
}

TEST(Profile, IsEmptyUntilAskedFor) {
    World2 world = falling_box();
    world.step(1.0 / 60);
    EXPECT_TRUE(world.profile().stages.empty());
    world.set_profiling(true);
    world.step(1.0 / 60);
    EXPECT_FALSE(world.profile().stages.empty());
    world.set_profiling(false);
    EXPECT_TRUE(world.profile().stages.empty());
}

/// Stages follow one another without a gap and add up to the step; profiling changes no bit.
TEST(Profile, TellsWhatAStepTook) {
    World2 world = falling_box(), other = falling_box();
    world.set_profiling(true);
    for (int i = 0; i < 20; ++i) {
        world.step(1.0 / 60);
        other.step(1.0 / 60);
        const StepProfile& profile = world.profile();
        double at = profile.begin;
        for (const StageTime& stage : profile.stages) {
            EXPECT_NEAR(stage.begin, at, 1e-9) << stage.name;
            EXPECT_GE(stage.seconds, 0) << stage.name;
            at = stage.begin + stage.seconds;
        }
        EXPECT_NEAR(at, profile.begin + profile.seconds, 1e-9);
    }
    EXPECT_EQ(world.profile().stages.size(), 21u);
    EXPECT_EQ(world.profile().awake, 1u);
    EXPECT_EQ(world.profile().pairs, 1u);
    EXPECT_EQ(world.profile().solved, 1u);
    EXPECT_EQ(world.profile().largest_colour, 1u);
    EXPECT_EQ(world.profile().without_colour, 0u);
    EXPECT_EQ(world.profile().workers, 1);
    EXPECT_EQ(world.hash(), other.hash());
}

TEST(ChromeTrace, IsJsonWithABarAStage) {
    const auto path = std::filesystem::path(testing::TempDir()) / "profile.json";
    World2 world = falling_box();
    world.set_profiling(true);
    {
        ChromeTrace trace(path.string());
        for (int i = 0; i < 3; ++i) {
            world.step(1.0 / 60);
            trace.write_step(world.profile());
        }
        trace.finish();
    }
    const auto json = nlohmann::json::parse(std::ifstream(path));
    int steps = 0, stages = 0, counters = 0;
    for (const auto& event : json.at("traceEvents")) {
        if (event.at("ph") == "C") {
            EXPECT_EQ(event.at("args").at("awake bodies"), 1);
            ++counters;
            continue;
        }
        EXPECT_GE(event.at("dur").get<double>(), 0);
        event.at("name") == "step" ? ++steps : ++stages;
    }
    EXPECT_EQ(steps, 3);
    EXPECT_EQ(counters, 3);
    EXPECT_EQ(stages, 63);
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace carom::io
