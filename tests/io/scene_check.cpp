#include "io/scene_check.hpp"

#include "support.hpp"

namespace carom::io {
namespace {

std::vector<Suspicion> suspicions(const std::string& text) { return check_scene(parse_scene(text, "t")); }

/// The scene gives one suspicion, at this place and with these words.
void expect_one(const std::string& text, const std::string& place, const std::string& words) {
    const auto found = suspicions(text);
    ASSERT_EQ(found.size(), 1u) << text << (found.empty() ? "" : "\n" + found[0].what);
    EXPECT_EQ(found[0].place, place);
    EXPECT_NE(found[0].what.find(words), std::string::npos) << found[0].what;
}

const std::string ground =
    R"("bodies": [{"type": "fixed", "shapes": [{"type": "box", "size": [50, 1], "center": [0, -0.5]}]}, )";

std::string on_ground(const std::string& bodies) { return scene_text(2, ground + bodies + "]"); }

TEST(SceneCheck, nothing_suspicious) {
    EXPECT_TRUE(suspicions(scene_text(2, "")).empty());
    EXPECT_TRUE(suspicions(on_ground(R"({"position": [0, 0.5], "shapes": [{"type": "box", "size": [1, 1]}]},
                                        {"position": [0, 1.5], "shapes": [{"type": "box", "size": [1, 1]}]})"))
                    .empty());
}

TEST(SceneCheck, units) {
    expect_one(scene_text(2, R"("world": {"gravity": [0, -981]})"), "world.gravity",
               "100 times that of the Earth");
    expect_one(scene_text(2, R"("world": {"step": 0.1})"), "world.step", "0.1 s is long");
    expect_one(body_text(3, R"("shapes": [{"type": "ball", "radius": 0.001}])"), "bodies[0]", "0.002 m long");
    expect_one(body_text(3, R"("name": "big", "shapes": [{"type": "box", "size": [1, 200, 1]}])"),
               "bodies[0]", "\"big\" is 200 m long");
    expect_one(body_text(3, R"("shapes": [{"type": "ball", "radius": 0.5, "density": 0.6}])"),
               "bodies[0].shapes[0]", "0.6 kg/m³");
    EXPECT_TRUE(
        suspicions(body_text(2, R"("shapes": [{"type": "ball", "radius": 0.5, "density": 0.6}])")).empty());
}

TEST(SceneCheck, overlap_at_the_start) {
    expect_one(
        on_ground(R"({"name": "sunk", "position": [0, 0.4], "shapes": [{"type": "box", "size": [1, 1]}]})"),
        "bodies[1]", "\"sunk\" begins 0.1 m deep inside \"#0\"");
}

TEST(SceneCheck, heavy_on_light) {
    expect_one(
        on_ground(R"({"name": "feather", "position": [0, 0.5], "shapes": [{"type": "ball", "radius": 0.5,
                             "density": 1}]},
                            {"name": "anvil", "position": [0, 1.5], "shapes": [{"type": "ball", "radius": 0.5}]})"),
        "bodies[2]", "1000 times lighter");
}

TEST(SceneCheck, fast_for_the_step) {
    const std::string ball = R"("shapes": [{"type": "ball", "radius": 0.1}], "velocity": [60, 0])";
    expect_one(body_text(2, ball), "bodies[0].velocity", "moves 1 m a step");
    EXPECT_TRUE(suspicions(body_text(2, ball + ", \"bullet\": true")).empty());
    expect_one(body_text(2, R"("shapes": [{"type": "ball", "radius": 0.1}], "angular_velocity": 90)"),
               "bodies[0].angular_velocity", "turns 1.5 rad a step");
}

TEST(SceneCheck, springs_against_the_step) {
    const std::string unit = R"("name": "b", "mass": 1, "shapes": [{"type": "ball", "radius": 1}])";
    const auto with_spring = [&](const std::string& spring) {
        return scene_text(2, "\"bodies\": [{" + unit +
                                 "}], \"forces\": [{\"type\": \"spring\", \"b\": \"b\", " + spring + "}]");
    };
    // ω h = 1 at a stiffness of 3600 N/m.
    EXPECT_TRUE(suspicions(with_spring("\"stiffness\": 3500")).empty());
    expect_one(with_spring("\"stiffness\": 3700"), "forces[0].stiffness", "1.01 rad a step");
    expect_one(with_spring("\"stiffness\": 1, \"damping\": 61"), "forces[0].damping", "61 N·s/m");
}

TEST(SceneCheck, settings_without_effect) {
    expect_one(body_text(2, R"("type": "fixed", "velocity": [1, 0])"), "bodies[0].velocity", "no effect");
    expect_one(body_text(2, R"("type": "fixed", "mass": 5)"), "bodies[0].mass", "no effect");
    expect_one(scene_text(2, R"("bodies": [{"name": "wall", "type": "fixed"}],
                                "forces": [{"type": "force", "body": "wall", "value": [1, 0]}])"),
               "forces[0].body", "\"wall\" is not dynamic");
    expect_one(scene_text(2, R"("bodies": [{"name": "wall", "type": "fixed"}],
                                "forces": [{"type": "spring", "b": "wall", "stiffness": 1}])"),
               "forces[0]", "neither end");
}

}  // namespace
}  // namespace carom::io
