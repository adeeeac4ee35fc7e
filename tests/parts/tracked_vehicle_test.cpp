#include "carom/parts/tracked_vehicle.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::frame_time;

constexpr double gauge = 2.4, height = 0.8;

/// 10 t on six wheels a side.
TrackedVehicleDefinition vehicle_at(const Vec3& position) {
    TrackedVehicleDefinition t;
    t.chassis.position = position;
    t.chassis.mass = 8000;
    t.chassis.shapes.push_back({Box3{{5, 0.8, 2}}});
    t.chassis.shapes.back().center = {0, 0.3, 0};
    t.chassis.center_of_mass = Vec3{0, 0.1, 0};
    for (const double z : {-0.5 * gauge, 0.5 * gauge}) {
        for (int i = 0; i < 6; ++i) {
            Wheel<3> wheel;
            wheel.position = {2.25 - 0.9 * i, -0.4, z};
            wheel.radius = 0.4;
            wheel.width = 0.4;
            wheel.mass = 150;
            wheel.frequency = 1.8;
            wheel.friction = 1;
            t.wheels.push_back(wheel);
        }
    }
    return t;
}

void add_ground(World3& world, double slope = 0) {
    BodyDefinition3 ground;
    ground.type = BodyType::fixed;
    ground.shapes.push_back({Plane<3>{{-std::sin(slope), std::cos(slope), 0}, 0}});
    ground.shapes.back().material.friction = 0.9;
    world.add_body(ground);
}

void drive(World3& world, TrackedVehicle& vehicle, const TrackControls& controls, double seconds) {
    for (int i = 0; i < seconds / frame_time; ++i) {
        vehicle.drive(world, controls, frame_time);
        world.step(frame_time);
    }
}

double upright(const World3& world, const TrackedVehicle& vehicle) {
    return rotate(world.rotation(vehicle.chassis()), Vec3{0, 1, 0}).y;
}

TEST(TrackedVehicles, StandAtTheHeightAtWhichTheyWereBuiltAndFallAsleep) {
    World3 world;
    add_ground(world);
    TrackedVehicle vehicle(world, vehicle_at({0, height, 0}));
    drive(world, vehicle, {}, 5);
    EXPECT_NEAR(world.position(vehicle.chassis()).y, height, 0.01);
    EXPECT_FALSE(world.awake(vehicle.chassis()));
    drive(world, vehicle, {.throttle = 1}, 1);
    EXPECT_GT(vehicle.speed(world), 1);
}

TEST(TrackedVehicles, GoStraightAtTheirSpeedForwardAndBack) {
    World3 world;
    add_ground(world);
    TrackedVehicle vehicle(world, vehicle_at({0, height, 0}));
    drive(world, vehicle, {.throttle = 1}, 8);
    EXPECT_NEAR(vehicle.speed(world), 12, 0.3);
    EXPECT_LT(std::fabs(world.position(vehicle.chassis()).z), 0.2);
    drive(world, vehicle, {}, 4);
    EXPECT_NEAR(vehicle.speed(world), 0, 0.02);
    drive(world, vehicle, {.throttle = -0.5}, 5);
    EXPECT_NEAR(vehicle.speed(world), -6, 0.2);
    EXPECT_GT(upright(world, vehicle), 0.99);
}

TEST(TrackedVehicles, TurnAsTheDriverWantsThoughTheirTracksSlip) {
    for (const double side : {1.0, -1.0}) {
        World3 world;
        add_ground(world);
        const TrackedVehicleDefinition design = vehicle_at({0, height, 0});
        TrackedVehicle vehicle(world, design);
        const TrackControls controls{.throttle = 0.5, .steering = 0.4 * side};
        drive(world, vehicle, controls, 5);
        double way = 0, turned = 0, least = 1;
        for (int i = 0; i < 240; ++i) {
            drive(world, vehicle, controls, frame_time);
            way += vehicle.speed(world) * frame_time;
            turned += vehicle.turn(world) * frame_time;
            least = std::min(least, upright(world, vehicle));
        }
        const double radius = 0.5 * design.max_speed / (0.4 * design.max_turn);
        EXPECT_NEAR(way / turned * side, radius, 0.1 * radius);
        EXPECT_GT(least, 0.98);
    }
}

TEST(TrackedVehicles, TurnOnTheSpot) {
    World3 world;
    add_ground(world);
    TrackedVehicle vehicle(world, vehicle_at({0, height, 0}));
    drive(world, vehicle, {.steering = 0.5}, 2);
    double turned = 0;
    const Vec3 start = world.position(vehicle.chassis());
    for (int i = 0; i < 600; ++i) {
        drive(world, vehicle, {.steering = 0.5}, frame_time);
        turned += vehicle.turn(world) * frame_time;
    }
    EXPECT_NEAR(turned, 5, 0.25);
    EXPECT_LT(length(world.position(vehicle.chassis()) - start), 0.3);
}

TEST(TrackedVehicles, ClimbASlopeAndHoldOnIt) {
    constexpr double slope = 0.5;  // 29°
    World3 world;
    add_ground(world, slope);
    TrackedVehicleDefinition design = vehicle_at({-height * std::sin(slope), height * std::cos(slope), 0});
    design.chassis.rotation = Rotation3::from_axis_angle({0, 0, 1}, slope);
    TrackedVehicle vehicle(world, design);
    drive(world, vehicle, {.throttle = 0.4}, 6);
    EXPECT_NEAR(vehicle.speed(world), 4.8, 0.4);
    drive(world, vehicle, {}, 3);
    const Vec3 stood = world.position(vehicle.chassis());
    drive(world, vehicle, {}, 5);
    EXPECT_LT(length(world.position(vehicle.chassis()) - stood), 0.02);
}

TEST(TrackedVehicles, CrossASillAndADitch) {
    World3 world;
    BodyDefinition3 ground;
    ground.type = BodyType::fixed;
    for (const auto& [from, to, top] :
         {std::array{-20.0, 15.0, 0.0}, std::array{15.0, 25.0, 0.35}, std::array{26.2, 60.0, 0.35}}) {
        ground.shapes.push_back({Box3{{to - from, 4, 20}}});
        ground.shapes.back().center = {0.5 * (from + to), top - 2, 0};
        ground.shapes.back().material.friction = 0.9;
    }
    world.add_body(ground);
    TrackedVehicle vehicle(world, vehicle_at({0, height, 0}));
    double least = 1;
    for (int i = 0; i < 60 * 16; ++i) {
        drive(world, vehicle, {.throttle = 0.25}, frame_time);
        least = std::min(least, upright(world, vehicle));
    }
    EXPECT_GT(world.position(vehicle.chassis()).x, 35);
    EXPECT_GT(least, 0.9);
    EXPECT_NEAR(world.position(vehicle.chassis()).y, height + 0.35, 0.02);
}

TEST(TrackedVehicles, HaveNoMoreForceThanTheySay) {
    constexpr double slope = 0.3;
    World3 world;
    add_ground(world, slope);
    TrackedVehicleDefinition design = vehicle_at({-height * std::sin(slope), height * std::cos(slope), 0});
    design.chassis.rotation = Rotation3::from_axis_angle({0, 0, 1}, slope);
    for (const double share : {0.9, 1.1}) {  // of what holds it on the slope
        design.max_force = 0.5 * share * (8000 + 12 * 150) * 9.81 * std::sin(slope);
        TrackedVehicle vehicle(world, design);
        drive(world, vehicle, {.throttle = 1}, 3);
        EXPECT_EQ(vehicle.speed(world) > 0, share > 1) << vehicle.speed(world);
        drive(world, vehicle, {}, 0.5);
        vehicle.remove(world);
    }
}

TEST(TrackedVehicles, RefuseWhatCannotBe) {
    World3 world;
    const auto refused = [&](auto change, const std::string& message) {
        TrackedVehicleDefinition definition = vehicle_at({});
        change(definition);
        try {
            TrackedVehicle(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
        EXPECT_EQ(world.counts().bodies, 0) << message;
    };
    refused([](auto& t) { t.wheels.resize(6); }, "wheels: there are none on the right");
    refused([](auto& t) { t.wheels.clear(); }, "wheels: there are none on the left");
    refused([](auto& t) { t.wheels[7].width = 0; }, "wheels[7].width: 0 is not positive");
    refused([](auto& t) { t.max_force = 0; }, "max_force: 0 is not positive");
    TrackedVehicle vehicle(world, vehicle_at({}));
    EXPECT_THROW(vehicle.drive(world, {.throttle = 2}, frame_time), Error);
    EXPECT_THROW(vehicle.drive(world, {}, 0), Error);
    vehicle.remove(world);
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom
