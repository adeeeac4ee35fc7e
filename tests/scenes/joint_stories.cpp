#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "io/scene.hpp"

// What the scenes with joints are about comes true.

namespace carom::io {
namespace {

template <int D>
struct Played {
    explicit Played(const std::string& name)
        : scene(load_scene(CAROM_SOURCE_DIR "/scenes/" + name + ".json")), built(build<D>(scene)) {}

    World<D>& world() { return built.world; }
    BodyId<D> body(const std::string& name) {
        for (const BodyId<D> body : built.bodies)
            if (built.world.name(body) == name) return body;
        ADD_FAILURE() << "no body is called " << name;
        return {};
    }
    double worst_error() {
        double worst = 0;
        for (const JointId<D> joint : world().joints())
            worst = std::max(worst, std::max(world().linear_error(joint), world().angular_error(joint)));
        return worst;
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) built.world.step(scene.step);
    }

    Scene scene;
    SceneWorld<D> built;
};

TEST(JointStories, the_cradle_swings_on_the_other_side) {
    Played<2> cradle("2d/newtons_cradle");
    const BodyId2 last = cradle.body("ball 5"), middle = cradle.body("ball 3");
    const double start = cradle.world().position(last).x;
    double farthest = 0, middle_moved = 0;
    const double middle_start = cradle.world().position(middle).x;
    for (int i = 0; i < 90; ++i) {
        cradle.run(1);
        farthest = std::max(farthest, cradle.world().position(last).x - start);
        middle_moved = std::max(middle_moved, std::fabs(cradle.world().position(middle).x - middle_start));
    }
    EXPECT_GT(farthest, 0.9);  // the first came from 1.175 m
    EXPECT_LT(middle_moved, 0.2);
}

template <int D>
void expect_bridge(const std::string& name, double deepest) {
    Played<D> bridge(name);
    bridge.run(600);
    EXPECT_LT(bridge.worst_error(), 1e-2);
    for (int i = 1; i <= 4; ++i)
        EXPECT_GT(bridge.world().position(bridge.body("crate " + std::to_string(i))).y, deepest);
}

TEST(JointStories, the_bridges_hold) {
    expect_bridge<2>("2d/bridge", -3);
    expect_bridge<3>("3d/bridge", -3);
}

TEST(JointStories, ragdolls_stay_whole) {
    for (const auto& name : {"2d/ragdolls"}) {
        Played<2> dolls(name);
        dolls.run(600);
        EXPECT_LT(dolls.worst_error(), 5e-3);
    }
    Played<3> dolls("3d/ragdolls");
    dolls.run(600);
    EXPECT_LT(dolls.worst_error(), 1e-2);
}

TEST(JointStories, the_cars_drive) {
    Played<2> flat("2d/car");
    flat.run(480);
    EXPECT_GT(flat.world().position(flat.body("chassis")).x, 25);
    EXPECT_LT(std::fabs(flat.world().rotation(flat.body("chassis")).angle()), 1);
    Played<3> car("3d/car");
    car.run(240);
    const BodyId3 chassis = car.body("chassis");
    EXPECT_GT(car.world().position(chassis).x, 10);
    EXPECT_GT(rotate(car.world().rotation(chassis), Vec3{0, 1, 0}).y, 0.9);
}

TEST(JointStories, the_motorcycle_rides_over_the_hills) {
    Played<2> hills("2d/motorcycle");
    hills.run(600);
    EXPECT_GT(hills.world().position(hills.body("frame")).x, 15);
    EXPECT_LT(std::fabs(hills.world().rotation(hills.body("frame")).angle()), 1);
    EXPECT_LT(hills.worst_error(), 1e-2);
}

TEST(JointStories, the_tracked_vehicle_crosses_a_sill_and_turns) {
    Played<3> tracks("3d/tracked_vehicle");
    tracks.run(300);
    const BodyId3 hull = tracks.body("hull");
    EXPECT_GT(tracks.world().position(hull).x, 10);
    EXPECT_LT(tracks.world().position(hull).z, -1);  // the right track is the faster one
    EXPECT_GT(rotate(tracks.world().rotation(hull), Vec3{0, 1, 0}).y, 0.9);
    EXPECT_LT(tracks.worst_error(), 1e-2);
}

TEST(JointStories, the_crane_swings_its_ball) {
    Played<2> crane("2d/crane");
    crane.run(600);
    EXPECT_GT(crane.world().position(crane.body("ball")).y, 3);
    EXPECT_LT(crane.worst_error(), 0.02);
}

TEST(JointStories, the_bucket_goes_up) {
    Played<2> well("2d/pulley_well");
    const double start = well.world().position(well.body("bucket")).y;
    well.run(300);
    EXPECT_GT(well.world().position(well.body("bucket")).y, start + 1);
    EXPECT_LT(well.worst_error(), 1e-2);
}

}  // namespace
}  // namespace carom::io
