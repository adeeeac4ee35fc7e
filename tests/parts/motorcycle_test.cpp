#include "carom/parts/motorcycle.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::frame_time;

constexpr double g = 9.81;

/// 230 kg with its rider.
MotorcycleDefinition motorcycle_at(const Vec3& position) {
    MotorcycleDefinition m;
    m.chassis.position = position;
    m.chassis.mass = 230;
    m.chassis.shapes.push_back({Box3{{1.2, 0.4, 0.3}}});
    m.chassis.shapes.push_back({Box3{{0.3, 0.7, 0.4}}});
    m.chassis.shapes.back().center = {-0.1, 0.5, 0};
    m.chassis.center_of_mass = {0, 0.05, 0};
    return m;
}

void add_ground(World3& world, double slope = 0) {
    BodyDefinition3 ground;
    ground.type = BodyType::fixed;
    ground.shapes.push_back({Plane<3>{{-std::sin(slope), std::cos(slope), 0}, 0}});
    ground.shapes.back().material.friction = 0.9;
    world.add_body(ground);
}

void drive(World3& world, Motorcycle& motorcycle, const MotorcycleControls& controls, double seconds) {
    for (int i = 0; i < seconds / frame_time; ++i) {
        motorcycle.drive(world, controls, frame_time);
        world.step(frame_time);
    }
}

/// Throttle that keeps a speed.
MotorcycleControls at_speed(const World3& world, const Motorcycle& m, double speed, double steering) {
    const double off = speed - m.speed(world);
    return {.throttle = std::clamp(0.15 + 0.3 * off, 0.0, 1.0),
            .brake = std::clamp(-0.1 * (off + 0.5), 0.0, 1.0),
            .steering = steering};
}

void hold_speed(World3& world, Motorcycle& m, double speed, double steering, double seconds) {
    for (int i = 0; i < seconds / frame_time; ++i)
        drive(world, m, at_speed(world, m, speed, steering), frame_time);
}

TEST(Motorcycles, StandAndFallAsleep) {
    World3 world;
    add_ground(world);
    Motorcycle m(world, motorcycle_at({0, 0.55, 0}));
    drive(world, m, {.brake = 1}, 5);
    EXPECT_NEAR(world.position(m.chassis()).y, 0.55, 0.01);
    EXPECT_NEAR(m.lean(world), 0, 2e-3);
    EXPECT_FALSE(world.awake(m.chassis()));
}

/// Fast wheels ask for small sub-steps.
TEST(Motorcycles, GoStraightAtFullThrottleAndStopWithBothWheelsOnTheGround) {
    for (const auto& [substeps, seconds] : {std::pair{4, 4.0}, std::pair{16, 6.0}}) {
        SCOPED_TRACE(substeps);
        WorldDefinition3 definition;
        definition.substeps = substeps;
        World3 world(definition);
        add_ground(world);
        Motorcycle m(world, motorcycle_at({0, 0.55, 0}));
        const auto pitch = [&] { return rotate(world.rotation(m.chassis()), Vec3{1, 0, 0}).y; };
        double most = 0, least = 0, lean = 0;
        for (int i = 0; i < seconds * 60; ++i) {
            drive(world, m, {.throttle = 1}, frame_time);
            most = std::max(most, pitch());
            lean = std::max(lean, std::fabs(m.lean(world)));
        }
        EXPECT_GT(m.speed(world), 6.3 * seconds);
        EXPECT_GT(m.gear(), 1);
        const double from = m.speed(world), start = world.position(m.chassis()).x;
        for (int i = 0; i < 2 * seconds * 60; ++i) {
            drive(world, m, {.brake = 1}, frame_time);
            least = std::min(least, pitch());
            lean = std::max(lean, std::fabs(m.lean(world)));
        }
        EXPECT_LT(m.speed(world), 0.1);
        const double slowing = from * from / (2 * (world.position(m.chassis()).x - start));
        EXPECT_GT(slowing, 6);
        EXPECT_LT(slowing, 12);
        EXPECT_LT(most, 0.2);  // no wheel leaves the ground for long
        EXPECT_GT(least, -0.2);
        EXPECT_LT(lean, 0.05);
    }
}

TEST(Motorcycles, LeanIntoCurvesAsMuchAsTheyAskFor) {
    for (const double side : {1.0, -1.0}) {
        for (const double speed : {4.0, 9.0, 16.0}) {
            World3 world;
            add_ground(world);
            const MotorcycleDefinition design = motorcycle_at({0, 0.55, 0});
            Motorcycle m(world, design);
            hold_speed(world, m, speed, 0, 6);
            // The lean of 30° makes the curve, or the tightest that there is where that is too slow.
            const double base = design.front.position.x - design.rear.position.x;
            const double tightest = std::tan(design.max_steering) / base;
            const double wanted = std::min(0.4 * tightest, std::tan(0.5) * g / (speed * speed));
            const double steering = side * wanted / tightest;
            hold_speed(world, m, speed, steering, 3);
            double way = 0, turned = 0, lean = 0;
            const int steps = 180;
            for (int i = 0; i < steps; ++i) {
                hold_speed(world, m, speed, steering, frame_time);
                way += m.speed(world) * frame_time;
                turned += world.angular_velocity(m.chassis()).y * frame_time;
                lean += m.lean(world) / steps;
            }
            SCOPED_TRACE(speed * side);
            const double curvature = turned / way;
            EXPECT_NEAR(side * curvature, wanted, 0.12 * wanted);
            const double v = way / (steps * frame_time);
            EXPECT_NEAR(side * lean, std::atan(v * v * std::fabs(curvature) / g), 0.06);
            for (const JointId3 joint : m.joints()) EXPECT_LT(world.linear_error(joint), 2e-3);
        }
    }
}

TEST(Motorcycles, LeanNoFurtherThanTheyMay) {
    World3 world;
    add_ground(world);
    MotorcycleDefinition design = motorcycle_at({0, 0.55, 0});
    design.max_lean = 0.6;
    Motorcycle m(world, design);
    hold_speed(world, m, 18, 0, 8);
    double most = 0, at = 0;
    for (int i = 0; i < 8 * 60; ++i) {
        const double side = i / 120 % 2 == 0 ? 1 : -1;  // from side to side
        hold_speed(world, m, 18, side, frame_time);
        most = std::max(most, std::fabs(m.lean(world)));
        at = std::max(at, std::fabs(world.angular_velocity(m.chassis()).y));
    }
    EXPECT_GT(most, 0.55);
    EXPECT_LT(most, 0.7);
    EXPECT_GT(at, 0.25);
}

TEST(Motorcycles, ClimbASlope) {
    constexpr double slope = 0.35;  // 20°
    World3 world;
    add_ground(world, slope);
    MotorcycleDefinition design = motorcycle_at({-0.55 * std::sin(slope), 0.55 * std::cos(slope), 0});
    design.chassis.rotation = Rotation3::from_axis_angle({0, 0, 1}, slope);
    Motorcycle m(world, design);
    hold_speed(world, m, 8, 0, 5);
    hold_speed(world, m, 8, 0.1, 2);
    EXPECT_GT(world.position(m.chassis()).y, 8);
    EXPECT_GT(m.speed(world), 6);
    EXPECT_LT(std::fabs(m.lean(world)), 0.7);
}

TEST(Motorcycles, StayUpAfterABlowAndFallWhenItIsTooHard) {
    for (const auto& [blow, falls] : {std::pair{80.0, false}, std::pair{1500.0, true}}) {
        for (const double speed : {0.0, 10.0}) {
            World3 world;
            add_ground(world);
            Motorcycle m(world, motorcycle_at({0, 0.55, 0}));
            hold_speed(world, m, speed, 0, 5);
            world.apply_impulse(m.chassis(), Vec3{0, 0, blow}, world.position(m.chassis()) + Vec3{0, 0.5, 0});
            double most = 0;
            for (int i = 0; i < 300; ++i) {
                hold_speed(world, m, speed, 0, frame_time);
                most = std::max(most, std::fabs(m.lean(world)));
            }
            SCOPED_TRACE(blow + speed);
            if (falls) {
                EXPECT_GT(std::fabs(m.lean(world)), 0.9);
            } else {
                EXPECT_GT(most, 0.01);
                EXPECT_LT(most, 0.5);
                EXPECT_LT(std::fabs(m.lean(world)), 0.03);
            }
        }
    }
}

TEST(Motorcycles, RefuseWhatCannotBe) {
    World3 world;
    const auto refused = [&](auto change, const std::string& message) {
        MotorcycleDefinition definition = motorcycle_at({});
        change(definition);
        try {
            Motorcycle(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
        EXPECT_EQ(world.counts().bodies, 0) << message;
    };
    refused([](auto& m) { m.front.position.x = -2; },
            "front.position.x: -2 is not in front of the rear wheel");
    refused([](auto& m) { m.rear.radius = 0; }, "wheels[1].radius: 0 is not positive");
    refused([](auto& m) { m.max_lean = 2; }, "max_lean: 2 is not between");
    refused([](auto& m) { m.lean_torque = -1; }, "lean_torque: -1 is negative");
    refused([](auto& m) { m.gearbox.ratios.clear(); }, "gearbox.ratios: there are none");
    Motorcycle m(world, motorcycle_at({}));
    EXPECT_THROW(m.drive(world, {.steering = 2}, frame_time), Error);
    EXPECT_THROW(m.drive(world, {}, 0), Error);
    m.remove(world);
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom
