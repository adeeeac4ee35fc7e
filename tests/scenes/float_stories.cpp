#include <gtest/gtest.h>

#include <string>

#include "io/scene.hpp"

// What is lighter than water floats and comes to rest, and what is heavier sinks.

namespace carom::io {
namespace {

template <int D>
void play(double depth, const std::string& passenger) {
    const Scene scene =
        load_scene(CAROM_SOURCE_DIR "/scenes/" + std::to_string(D) + "d/floating_crates.json");
    SceneWorld<D> built = build<D>(scene);
    World<D>& world = built.world;
    for (int i = 0; i < 1800; ++i) world.step(scene.step);
    int floating = 0, sunken = 0;
    double raft = 0;
    for (const BodyId<D> body : built.bodies) {
        const std::string name(world.name(body));
        if (world.type(body) != BodyType::dynamic) continue;
        SCOPED_TRACE(name);
        EXPECT_FALSE(world.awake(body));
        if (name == "raft") raft = world.position(body).y;
        if (name == passenger) {
            EXPECT_GT(world.position(body).y, raft + 0.4);
        }
        if (name.ends_with("stone")) {
            EXPECT_LT(world.position(body).y, 1);
            ++sunken;
        } else if (name != "buoy") {
            EXPECT_NEAR(world.position(body).y, depth, 0.9);
            ++floating;
        }
    }
    EXPECT_EQ(floating, D == 2 ? 12 : 18);
    EXPECT_EQ(sunken, D == 2 ? 2 : 1);
}

TEST(FloatStories, the_lake_in_the_plane) { play<2>(4, "nobody"); }
TEST(FloatStories, the_lake_in_space_where_the_passenger_stays_dry) { play<3>(3.5, "passenger"); }

}  // namespace
}  // namespace carom::io
