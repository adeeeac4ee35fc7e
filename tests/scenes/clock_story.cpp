#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/scene.hpp"

// The clock goes right: its pendulum has the period of a compound pendulum of its swing, its driven wheel
// turns once a minute and never back, and the hands follow through their gears.

namespace carom::io {
namespace {

/// Of a pendulum that swings by so much: the small swing's, times a series of sin² ½ amplitude.
double period_of(double length, double inertia_over_mass, double amplitude) {
    const double m = std::pow(std::sin(amplitude / 2), 2);
    return 2 * 3.14159265358979323846 * std::sqrt((length * length + inertia_over_mass) / (9.81 * length)) *
           (1 + m / 4 + 9 * m * m / 64);
}

TEST(ClockStory, ItGoesRightForAMinute) {
    const Scene scene = load_scene(CAROM_SOURCE_DIR "/scenes/2d/clock.json");
    SceneWorld<2> built = build<2>(scene);
    World<2>& world = built.world;
    const JointId2 suspension = built.joints[0], click = built.joints[1], minutes = built.joints[2],
                   hours = built.joints[3];
    const double start = std::atan2(0.1725697, 0.9788936);
    double last_angle = start, time = 0, first = 0, latest = 0, least = 0, back = 0, farthest = 0;
    double early = start, late = 0;
    int crossings = 0;
    for (int i = 0; i < std::lround(60 / scene.step); ++i) {
        world.step(scene.step);
        time += scene.step;
        const double angle = start + world.coordinate(suspension);
        if (last_angle > 0 && angle <= 0) {
            latest = time - scene.step * angle / (angle - last_angle);
            if (crossings++ == 0) first = latest;
        }
        last_angle = angle;
        if (time > 57) late = std::max(late, angle);
        least = std::min(least, angle);
        farthest = std::max(farthest, world.coordinate(click));
        back = std::max(back, farthest - world.coordinate(click));
    }
    const double period = (latest - first) / (crossings - 1);
    const double length = std::hypot(0.1725697, 0.9788936);
    EXPECT_NEAR(period, period_of(length, 0.5 * 0.12 * 0.12, 0.5 * (early + late)), 1e-3 * period);
    EXPECT_GT(late, 0.9 * early) << "it hardly tires";
    EXPECT_LT(back, 1e-4) << "the click holds the wheel";
    EXPECT_NEAR(farthest, 2 * 3.14159265358979323846, 2e-3) << "a turn a minute";
    EXPECT_NEAR(world.coordinate(minutes), -farthest / 60, 1e-4);
    EXPECT_NEAR(world.coordinate(hours), farthest / 60 / 12, 1e-4);
}

}  // namespace
}  // namespace carom::io
