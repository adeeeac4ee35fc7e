#include "carom/parts/car.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::frame_time;
using test::vec;

template <class T>
class Cars : public testing::Test {};
TYPED_TEST_SUITE(Cars, test::BothDimensions);

/// Rear-wheel drive, 1.1 t.
template <int D>
CarDefinition<D> car_at(const Vec<D>& position, bool rear = true, bool front = false) {
    CarDefinition<D> car;
    car.chassis.position = position;
    car.chassis.mass = 1100;
    car.chassis.shapes.push_back({Box<D>{vec<D>(4, 0.5, 1.7)}});
    car.chassis.shapes.back().center = vec<D>(0, 0.25);
    car.chassis.center_of_mass = vec<D>(0.05, 0.1);
    for (const double x : {1.3, -1.3}) {
        for (const double z : {-0.75, 0.75}) {
            if (D == 2 && z > 0) continue;
            CarWheel<D> wheel;
            wheel.position = vec<D>(x, -0.15, z);
            wheel.steered = D == 3 && x > 0;
            wheel.driven = x > 0 ? front : rear;
            wheel.handbrake = x < 0;
            if (D == 2) wheel.mass = 40;
            car.wheels.push_back(wheel);
        }
    }
    return car;
}

template <int D>
void add_ground(World<D>& world, double friction = 0.9) {
    BodyDefinition<D> ground;
    ground.type = BodyType::fixed;
    ground.shapes.push_back({Plane<D>{vec<D>(0, 1), 0}});
    ground.shapes.back().material.friction = friction;
    world.add_body(ground);
}

template <int D>
void drive(World<D>& world, Car<D>& car, const CarControls& controls, double seconds) {
    for (int i = 0; i < seconds / frame_time; ++i) {
        car.drive(world, controls, frame_time);
        world.step(frame_time);
    }
}

TYPED_TEST(Cars, StandAtTheHeightAtWhichTheyWereBuiltAndFallAsleep) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_ground(world);
    Car<D> car(world, car_at<D>(vec<D>(0, 0.5)));
    drive(world, car, {.handbrake = 1}, 5);
    EXPECT_NEAR(world.position(car.chassis()).y, 0.5, 0.01);
    EXPECT_NEAR(world.position(car.chassis()).x, 0, 0.02);
    for (const JointId<D> joint : car.joints()) EXPECT_NEAR(world.coordinate(joint), 0, 0.01);
    EXPECT_FALSE(world.awake(car.chassis()));
    // Full throttle wakes it.
    drive(world, car, {.throttle = 1}, 1);
    EXPECT_GT(car.speed(world), 1);
}

TYPED_TEST(Cars, ShiftUpAsTheyAccelerateAndBrakeWithinTheLimitOfFriction) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_ground(world);
    Car<D> car(world, car_at<D>(vec<D>(0, 0.5)));
    drive(world, car, {}, 1);
    double before = 0;
    int highest = 1;
    for (int i = 0; i < 15; ++i) {
        drive(world, car, {.throttle = 1}, 1);
        EXPECT_GT(car.speed(world), before - 0.1) << i;
        before = car.speed(world);
        highest = std::max(highest, car.gear());
        EXPECT_LT(car.engine_speed(), 7200);
    }
    EXPECT_GT(before, 30);
    EXPECT_LT(before, 90);
    EXPECT_GE(highest, 3);
    const double start = world.position(car.chassis()).x;
    drive(world, car, {.brake = 1}, 12);
    EXPECT_NEAR(car.speed(world), 0, 0.05);
    const double way = world.position(car.chassis()).x - start;
    // v² / (2 μ g) with μ = √(1.3 · 0.9), less drag.
    const double limit = before * before / (2 * std::sqrt(1.3 * 0.9) * 9.81);
    EXPECT_GT(way, 0.8 * limit);
    EXPECT_LT(way, 1.6 * limit);
    // And backwards.
    drive(world, car, {.throttle = 0.5, .reverse = true}, 3);
    EXPECT_EQ(car.gear(), -1);
    EXPECT_LT(car.speed(world), -2);
}

TEST(CarsInSpace, TurnAboutOnePointAsTheirSteeringSays) {
    World3 world;
    add_ground(world);
    Car3 car(world, car_at<3>({0, 0.5, 0}));
    drive(world, car, {.throttle = 0.3}, 2);
    // Slowly, so that tyres hardly slip: the radius is that of the wheelbase and the angle.
    for (const double side : {1.0, -1.0}) {
        drive(world, car, {.brake = 1}, 2);
        drive(world, car, {.throttle = 0.15, .steering = 0.5 * side}, 2);
        double way = 0, turned = 0;
        for (int i = 0; i < 120; ++i) {
            drive(world, car, {.throttle = 0.1, .steering = 0.5 * side}, frame_time);
            way += car.speed(world) * frame_time;
            turned += world.angular_velocity(car.chassis()).y * frame_time;
        }
        EXPECT_GT(turned * side, 0.1);
        const double radius = std::fabs(way / turned);
        EXPECT_NEAR(radius, 2.6 / std::tan(0.3), 0.25 * 2.6 / std::tan(0.3));
    }
}

/// A course: hills, a jump, a banked half circle, and back. Everything is a height field; the jump is a ramp.
class Course {
  public:
    static constexpr double radius = 30, straight = 150;

    explicit Course(World3& world) {
        HeightField3 field;
        constexpr double spacing = 1;
        for (int row = 0; row <= 110; ++row) {
            field.heights.emplace_back();
            for (int column = 0; column <= 230; ++column)
                field.heights.back().push_back(height(-20 + column * spacing, -30 + row * spacing));
        }
        field.spacing = {spacing, spacing};
        BodyDefinition3 ground;
        ground.type = BodyType::fixed;
        ground.position = {-20, 0, -30};
        ground.shapes.push_back({field});
        ground.shapes.back().material.friction = 0.9;
        world.add_body(ground);
        BodyDefinition3 ramp;
        ramp.type = BodyType::fixed;
        ramp.shapes.push_back({Hull3{
            {{88, -0.2, -4}, {88, -0.2, 4}, {96, 1.1, -4}, {96, 1.1, 4}, {96, -0.2, -4}, {96, -0.2, 4}}}});
        ramp.shapes.back().material.friction = 0.9;
        world.add_body(ramp);
    }

    /// The way leads along x, around (straight, radius), and back.
    static Vec3 point(double way) {
        if (way < straight) return {way, 0, 0};
        const double angle = (way - straight) / radius;
        if (angle < 3.14159265)
            return {straight + radius * std::sin(angle), 0, radius * (1 - std::cos(angle))};
        return {straight - (way - straight - 3.14159265 * radius), 0, 2 * radius};
    }
    static double nearest(const Vec3& p, double from) {
        double best = from, least = 1e9;
        for (double way = from - 5; way < from + 15; way += 0.25) {
            const Vec3 d = p - point(way);
            if (d.x * d.x + d.z * d.z < least) {
                least = d.x * d.x + d.z * d.z;
                best = way;
            }
        }
        return best;
    }

  private:
    static double smooth(double t) {
        t = std::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    }
    static double height(double x, double z) {
        const double hills = smooth((x - 15) / 10) * smooth((80 - x) / 10) * (1 - smooth((z - 15) / 10));
        const double hill = hills * 0.8 * std::sin((x - 15) * 0.35);
        const double dx = x - straight, dz = z - radius, out = std::sqrt(dx * dx + dz * dz) - radius;
        const double bank = smooth(dx / 15) * 0.3 * std::clamp(out, -6.0, 8.0);
        return hill + bank;
    }
};

TEST(CarsInSpace, DriveTheCourseWithoutFlipping) {
    for (const bool front : {false, true}) {
        World3 world;
        const Course course(world);
        Car3 car(world, car_at<3>({0, 0.5, 0}, !front, front));
        double way = 0, upright = 1, highest = 0;
        for (int i = 0; i < 60 * 60 && way < Course::straight + 3.14159 * Course::radius + 60; ++i) {
            const Vec3 at = world.position(car.chassis());
            way = Course::nearest(at, way);
            // The driver looks ahead and turns towards what he sees.
            const double speed = car.speed(world), ahead = 5 + 0.35 * std::fabs(speed);
            const Vec3 aim =
                unrotate(world.rotation(car.chassis()), Course::point(way + ahead) + Vec3{0, at.y, 0} - at);
            const double angle = std::atan2(2 * 2.6 * -aim.z, aim.x * aim.x + aim.z * aim.z);
            CarControls controls;
            controls.steering = std::clamp(angle / 0.6, -1.0, 1.0);
            const double wanted = way < 70 ? 9 : way < 97 ? 14 : 13;  // hills, the jump, the turn
            controls.throttle = std::clamp(0.3 * (wanted - speed), 0.0, 1.0);
            controls.brake = std::clamp(0.1 * (speed - wanted - 1), 0.0, 0.5);
            drive(world, car, controls, frame_time);
            upright = std::min(upright, rotate(world.rotation(car.chassis()), Vec3{0, 1, 0}).y);
            if (way > 98.5 && way < 110) highest = std::max(highest, at.y);
            const Vec3 off = at - Course::point(way);
            ASSERT_LT(std::hypot(off.x, off.z), 5) << "at " << way << " m, front drive: " << front;
        }
        EXPECT_GT(way, Course::straight + 3.14159 * Course::radius + 59);
        EXPECT_GT(upright, 0.75);
        EXPECT_GT(highest, 1.0);  // in the air: the ramp ended at 96 m, and the ground beyond it is at 0
        for (const JointId3 joint : car.joints()) EXPECT_LT(world.linear_error(joint), 2e-3);
    }
}

TYPED_TEST(Cars, RefuseWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const auto refused = [&](auto change, const std::string& message) {
        CarDefinition<D> definition = car_at<D>({});
        change(definition);
        try {
            Car<D>(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
        EXPECT_EQ(world.counts().bodies, 0) << message;
    };
    refused([](auto& c) { c.wheels.clear(); }, "wheels: there are none");
    refused([](auto& c) { c.wheels[1].radius = 0; }, "wheels[1].radius: 0 is not positive");
    refused([](auto& c) { c.chassis.type = BodyType::fixed; }, "chassis.type: is not dynamic");
    refused([](auto& c) { c.engine.torque.clear(); }, "engine.torque: needs at least two points");
    refused([](auto& c) { c.engine.torque[1][0] = 0.5; },
            "engine.torque[1]: 0.5 is not above the speed before");
    refused([](auto& c) { c.gearbox.ratios.clear(); }, "gearbox.ratios: there are none");
    refused([](auto& c) { c.gearbox.ratios[1] = 9; }, "gearbox.ratios[1]: 9 is not below the ratio before");
    refused([](auto& c) { c.differential_lock = 2; }, "differential_lock: 2 is not between");
    Car<D> car(world, car_at<D>({}));
    EXPECT_THROW(car.drive(world, {.throttle = 2}, frame_time), Error);
    EXPECT_THROW(car.drive(world, {}, 0), Error);
    car.remove(world);
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom
