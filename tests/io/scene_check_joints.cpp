#include "io/scene_check.hpp"
#include "support.hpp"

// What `carom check` says of joints, forces and materials, and what to change.

namespace carom::io {
namespace {

void expect_one(const std::string& text, const std::string& place, const std::string& words) {
    const auto found = check_scene(parse_scene(text, "t"));
    ASSERT_EQ(found.size(), 1u) << text
                                << (found.empty() ? "" : "\n" + found[0].what + "\n" + found.back().what);
    EXPECT_EQ(found[0].place, place);
    EXPECT_NE(found[0].what.find(words), std::string::npos) << found[0].what;
}
void expect_none(const std::string& text) {
    const auto found = check_scene(parse_scene(text, "t"));
    EXPECT_TRUE(found.empty()) << text << (found.empty() ? "" : "\n" + found[0].what);
}

const std::string two_bodies = R"("bodies": [
    {"name": "a", "shapes": [{"type": "box", "size": [1, 1]}]},
    {"name": "b", "position": [2, 0], "shapes": [{"type": "box", "size": [1, 1]}]},
    {"name": "wall", "type": "fixed", "position": [-5, 0], "shapes": [{"type": "box", "size": [1, 1]}]}])";

std::string joined(const std::string& joints) {
    return scene_text(2, two_bodies + ", \"joints\": [" + joints + "]");
}

TEST(SceneCheckJoints, TwoJointsForOne) {
    const std::string hinge = R"({"type": "hinge", "a": "a", "b": "b", "anchor": [1, 0]})";
    expect_none(joined(hinge));
    expect_one(joined(hinge + ", " + hinge), "joints[1]", "are redundant");
    expect_none(joined(
        hinge + R"(, {"type": "distance", "a": "a", "b": "b", "anchor_a": [0, 0.5], "anchor_b": [2, 0.5]})"));
}

TEST(SceneCheckJoints, LoopsThatAreHeldTooOften) {
    // Two bodies have six ways to move; a weld holds three, and each hinge two.
    expect_one(joined(R"({"type": "weld", "b": "a"}, {"type": "hinge", "a": "a", "b": "b", "anchor": [1, 0]},
                         {"type": "hinge", "b": "b", "anchor": [3, 0]})"),
               "joints[2]", "the loop is redundant");
    // A linkage of four bars, the ground being one, still moves.
    expect_none(joined(R"({"type": "hinge", "b": "a", "anchor": [0, -1]},
                          {"type": "hinge", "a": "a", "b": "b", "anchor": [1, 0]},
                          {"type": "distance", "b": "b", "anchor_a": [3, -1], "anchor_b": [3, 0]})"));
}

TEST(SceneCheckJoints, LimitsMotorsAndSprings) {
    const auto hinge = [](const std::string& more) {
        return joined(R"({"type": "hinge", "a": "a", "b": "b", "anchor": [1, 0], )" + more + "}");
    };
    expect_none(hinge(R"("limits": [-1, 1])"));
    expect_one(hinge(R"("limits": [-90, 90])"), "joints[0].limits", "in radians");
    expect_one(hinge(R"("limits": [0.5, 1])"), "joints[0].limits", "outside of its limits");
    expect_one(hinge(R"("motor": {"speed": 360, "max": 10})"), "joints[0].motor.speed", "6 rad a step");
    expect_one(hinge(R"("motor": {"speed": 3, "max": 0})"), "joints[0].motor.max", "no effect");
    expect_none(hinge(R"("spring": {"frequency": 30, "damping_ratio": 1})"));
    expect_one(hinge(R"("spring": {"frequency": 100, "damping_ratio": 1})"), "joints[0].spring.frequency",
               "below 60 Hz");
}

TEST(SceneCheckJoints, HeavyOnLightWhereJointsAreSolvedInTurn) {
    const auto chain = [](const std::string& method) {
        return scene_text(2, "\"world\": {\"joints\": \"" + method + R"("}, "bodies": [
            {"name": "link", "mass": 1, "shapes": [{"type": "box", "size": [1, 1]}]},
            {"name": "end", "mass": 1000, "position": [3, 0], "shapes": [{"type": "box", "size": [1, 1]}]}],
            "joints": [{"type": "hinge", "a": "link", "b": "end", "anchor": [1.5, 0]}])");
    };
    expect_none(chain("automatic"));
    expect_one(chain("iterative"), "joints[0]", "1000 times heavier");
}

TEST(SceneCheckForces, Units) {
    const auto forced = [](const std::string& force) {
        return scene_text(
            2, R"("bodies": [{"name": "b", "mass": 1, "shapes": [{"type": "ball", "radius": 0.5}]}],
                                "forces": [)" +
                   force + "]");
    };
    expect_none(forced(R"({"type": "force", "body": "b", "value": [20, 0]})"));
    expect_one(forced(R"({"type": "force", "body": "b", "value": [20000, 0]})"), "forces[0].value",
               "in newtons");
    expect_one(forced(R"({"type": "impulse", "body": "b", "value": [100, 0], "at": 0})"), "forces[0].value",
               "100 m/s fast");
}

TEST(SceneCheckBodies, WhatNoBodyIs) {
    expect_one(scene_text(2, R"("world": {"gravity": [0, 9.81]})"), "world.gravity", "upwards");
    expect_one(body_text(2, R"("shapes": [{"type": "box", "size": [1, 0.0005]}])"), "bodies[0]", "m thin");
    expect_one(body_text(2, R"("shapes": [{"type": "ball", "radius": 0.5, "friction": 50}])"),
               "bodies[0].shapes[0].friction", "rubber");
    expect_one(body_text(2, R"("linear_damping": 90, "shapes": [{"type": "ball", "radius": 0.5}])"),
               "bodies[0]", "in tar");
    expect_one(body_text(3, R"("mass": 5000000, "shapes": [{"type": "ball", "radius": 0.5}])"),
               "bodies[0].mass", "in kilograms");
    expect_one(
        body_text(3, R"("mass": 500, "inertia": [1, 1, 3], "shapes": [{"type": "ball", "radius": 0.5}])"),
        "bodies[0].inertia", "sum of the others");
    expect_one(body_text(2, R"("mass": 1, "inertia": 30, "shapes": [{"type": "ball", "radius": 0.5}])"),
               "bodies[0].inertia", "more than \"#0\" can have");
}

}  // namespace
}  // namespace carom::io
