#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "io/scene.hpp"

// What the scenes are about comes true.

namespace carom::io {
namespace {

constexpr int ten_seconds = 600;

template <int D>
struct Played {
    explicit Played(const std::string& name)
        : scene(load_scene(CAROM_SOURCE_DIR "/scenes/" + name + ".json")), built(build<D>(scene)) {}

    World<D>& world() { return built.world; }

    /// Calls `visit(body)` for every body whose name begins so; returns how many there are.
    template <class Visit>
    int each(const std::string& beginning, const Visit& visit) {
        int count = 0;
        for (const BodyId<D> body : built.bodies) {
            if (!built.world.name(body).starts_with(beginning)) continue;
            SCOPED_TRACE(std::string(built.world.name(body)));
            visit(body);
            ++count;
        }
        return count;
    }

    void run(int steps) {
        for (int i = 0; i < steps; ++i) built.world.step(scene.step);
    }

    Scene scene;
    SceneWorld<D> built;
};

/// The last ones may jam on the last belt, against what has filled the bin before them.
TEST(Stories, belts_carry_everything_up_and_nearly_everything_into_the_bin) {
    Played<2> conveyor("2d/conveyor");
    conveyor.run(ten_seconds);
    int things = 0, in_bin = 0;
    for (const std::string kind : {"crate", "parcel", "nut", "tube", "wedge", "wool ball"})
        things += conveyor.each(kind, [&](const BodyId2 body) {
            EXPECT_GT(conveyor.world().position(body).x, 6.5);
            in_bin += conveyor.world().position(body).x > 8.7;
            EXPECT_LT(conveyor.world().position(body).x, 12.9);
            EXPECT_GT(conveyor.world().position(body).y, 0.1);
        });
    EXPECT_EQ(things, 15);
    EXPECT_GE(in_bin, 12);
}

TEST(Stories, frogs_jump_through_platforms_and_balls_do_not_come_back_through_the_gate) {
    Played<2> one_way("2d/one_way");
    one_way.run(ten_seconds);
    const auto on_top = [&](const BodyId2 body) {
        EXPECT_GT(one_way.world().position(body).y, 4.8);
        EXPECT_LT(length(one_way.world().velocity(body)), 0.01);
    };
    EXPECT_EQ(one_way.each("frog", on_top), 4);
    EXPECT_EQ(one_way.each("crate", on_top), 1);
    const auto behind = [&](const BodyId2 body) { EXPECT_GT(one_way.world().position(body).x, 2.3); };
    EXPECT_EQ(one_way.each("ball", behind), 3);
}

TEST(Stories, gates_see_every_ball_come_and_go_once) {
    Played<3> gates("3d/sensor_gates");
    std::map<std::string, int> begun, ended;
    for (int i = 0; i < ten_seconds; ++i) {
        gates.run(1);
        const auto label = [&](const ShapePair<3>& pair) {
            return std::string(gates.world().name(pair.body_a)) + ", " +
                   std::string(gates.world().name(pair.body_b));
        };
        for (const SensorBegin<3>& event : gates.world().sensor_begins()) ++begun[label(event)];
        for (const SensorEnd<3>& event : gates.world().sensor_ends()) ++ended[label(event)];
    }
    for (const std::string ball : {"red", "blue", "green", "yellow", "purple"}) {
        for (const std::string gate : {"gate 1", "gate 2", "gate 3"}) {
            EXPECT_EQ(begun[gate + ", " + ball], 1) << gate << ", " << ball;
            EXPECT_EQ(ended[gate + ", " + ball], 1) << gate << ", " << ball;
        }
        EXPECT_EQ(begun["finish, " + ball] - ended["finish, " + ball], 1) << ball;
    }
    EXPECT_EQ(gates.each("finish",
                         [&](const BodyId3 body) {
                             EXPECT_EQ(gates.world().inside(gates.world().shapes(body)[0]).size(), 5u);
                         }),
              1);
}

TEST(Stories, what_rolls_down_the_hills_falls_through_the_hole) {
    Played<2> terrain("2d/terrain");
    double lowest = 0;
    for (int i = 0; i < ten_seconds; ++i) {
        terrain.run(1);
        for (const BodyId2 body : terrain.built.bodies)
            lowest = std::min(lowest, terrain.world().center_of_mass(body).y);
    }
    EXPECT_GT(lowest, -3.5);  // the bottom of the cave
    const auto in_cave = [&](const BodyId2 body) {
        EXPECT_LT(terrain.world().position(body).y, -1);
        EXPECT_NEAR(terrain.world().position(body).x, 7.5, 2.2);
    };
    EXPECT_EQ(terrain.each("ball", in_cave), 3);
    // The others slide as far as friction lets them and lie on the ground.
    for (const std::string kind : {"sledge", "crate", "log", "stone", "box", "tube"})
        EXPECT_EQ(terrain.each(kind,
                               [&](const BodyId2 body) {
                                   EXPECT_GT(terrain.world().position(body).y, 0);
                                   EXPECT_LT(length(terrain.world().velocity(body)), 0.05);
                               }),
                  1);
}

/// The height of the surface above a point; each cell is divided along its main diagonal.
double height_at(const HeightField3& field, double x, double z) {
    const double column = std::floor(x / field.spacing[0]), row = std::floor(z / field.spacing[1]);
    const double u = x / field.spacing[0] - column, v = z / field.spacing[1] - row;
    const auto height = [&](int down, int right) {
        return field.heights.at(static_cast<std::size_t>(row) + down)
            .at(static_cast<std::size_t>(column) + right);
    };
    const double middle = u > v ? height(0, 1) : height(1, 0);
    const double first = u > v ? u : v, second = u > v ? v : u;
    return height(0, 0) + first * (middle - height(0, 0)) + second * (height(1, 1) - middle);
}

TEST(Stories, rocks_and_balls_come_down_into_the_valley) {
    Played<3> terrain("3d/terrain");
    terrain.run(ten_seconds);
    const auto& field =
        std::get<HeightField3>(std::get<SceneData<3>>(terrain.scene.data).bodies[0].shapes[0].geometry);
    const Vec3 corner = std::get<SceneData<3>>(terrain.scene.data).bodies[0].shapes[0].center;
    const auto in_valley = [&](const BodyId3 body) {
        const Vec3 place = terrain.world().center_of_mass(body);
        EXPECT_GT(place.y, height_at(field, place.x - corner.x, place.z - corner.z));
        EXPECT_LT(std::fabs(place.z), 6);
    };
    EXPECT_EQ(terrain.each("rock", in_valley), 14);
    EXPECT_EQ(terrain.each("ball", in_valley), 4);
}

TEST(Stories, all_marbles_reach_the_end_of_the_chute) {
    Played<3> run("3d/marble_run");
    run.run(ten_seconds + 60);  // the last one comes into the tray at 9.9 s, among those that lie there
    const auto in_tray = [&](const BodyId3 marble) {
        const Vec3 place = run.world().position(marble);
        EXPECT_NEAR(place.x, 2.4, 1.5);
        EXPECT_NEAR(place.z, 2.1, 1.7);
        EXPECT_NEAR(place.y, -0.2, 0.05);
    };
    EXPECT_EQ(run.each("marble", in_tray), 12);
}

}  // namespace
}  // namespace carom::io
