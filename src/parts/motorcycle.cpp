#include "carom/parts/motorcycle.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double lean_frequency = 2;  // Hz, with which the lean is held; critically damped
constexpr double in_reserve = 0.75;   // of the force that would lift a wheel
constexpr double light = 0.6;         // share of its way down at which a wheel carries little
constexpr double fallen = 0.3;        // rad beyond the greatest lean: the rider lets go
constexpr double rolling = 0.93;      // of the speed of the ground: a wheel that turns slower slides
constexpr double standing = 0.2;      // m/s

const MotorcycleDefinition& checked(const MotorcycleDefinition& m) {
    require_in(m.rake, 0, 1, "rake");
    require_in(m.max_lean, 0, 1.3, "max_lean");
    require_positive(m.lean_speed, "lean_speed");
    require_not_negative(m.lean_torque, "lean_torque");
    require_in(m.max_steering, 0, 1.2, "max_steering");
    require_not_negative(m.drag_area, "drag_area");
    if (!(m.front.position.x > m.rear.position.x))
        refuse("front.position.x", m.front.position.x, "is not in front of the rear wheel");
    return m;
}

void check(const MotorcycleControls& c) {
    require_in(c.throttle, 0, 1, "throttle");
    require_in(c.brake, 0, 1, "brake");
    require_in(c.steering, -1, 1, "steering");
}

double gravity_of(const World3& world) { return length(world.definition().gravity); }

}  // namespace

Motorcycle::Motorcycle(World3& world, const MotorcycleDefinition& definition)
    : definition_(checked(definition)),
      drivetrain_(definition.engine, definition.gearbox),
      gear_(world, definition.chassis, {{definition.front, true, definition.rake}, {definition.rear}},
            definition.wheel_filter) {
    const Wheel<3>&front = definition.front, &rear = definition.rear;
    const MassProperties<3> chassis = world.mass_properties(gear_.chassis());
    mass_ = chassis.mass + front.mass + rear.mass;
    base_ = front.position.x - rear.position.x;
    height_ = chassis.center.y - rear.position.y + rear.radius;
    // The other wheel leaves the ground where force · height = weight · way.
    const double weight = in_reserve * mass_ * gravity_of(world) / height_;
    most_drive_ = weight * std::max(0.0, chassis.center.x - rear.position.x);
    most_brake_ = weight * std::max(0.0, front.position.x - chassis.center.x);
}

double Motorcycle::lean(const World3& world) const {
    const double g = gravity_of(world);
    if (g == 0) return 0;
    const Vec3 up = (-1 / g) * world.definition().gravity;
    const Rotation3 turned = world.rotation(chassis());
    return atan2(dot(rotate(turned, Vec3{0, 0, 1}), up), dot(rotate(turned, Vec3{0, 1, 0}), up));
}

void Motorcycle::drive(World3& world, const MotorcycleControls& controls, double dt) {
    check(controls);
    require_positive(dt, "dt");
    const double turning = gear_.turning(world, 1), v = speed(world);
    drivetrain_.update(turning, v, false, dt);
    const Wheel<3>&front = definition_.front, &rear = definition_.rear;
    const double force = front.brake_torque / front.radius + rear.brake_torque / rear.radius;
    const double brake = grip(world, 1) * std::min(controls.brake, most_brake_ / std::max(force, 1.0));
    const auto slides = [&](std::size_t i, const Wheel<3>& wheel) {
        return v > 1 && gear_.turning(world, i) * wheel.radius < rolling * v;
    };
    double torque =
        grip(world, 0) * std::min(drivetrain_.torque(controls.throttle), most_drive_ * rear.radius);
    if (brake > 0) torque = std::max(torque, 0.0);  // the clutch is drawn
    gear_.push(world, 0, 0, slides(0, front) ? 0 : brake * front.brake_torque, drivetrain_.fastest(), false);
    gear_.push(world, 1, torque, slides(1, rear) ? 0 : brake * rear.brake_torque, drivetrain_.fastest(),
               false);

    // The tightest curve is that of the steering, or that of the greatest lean.
    double wish = controls.steering * tan(definition_.max_steering) / base_;
    const double g = gravity_of(world);
    if (v * v * std::fabs(wish) > g * tan(definition_.max_lean))
        wish = std::copysign(g * tan(definition_.max_lean) / (v * v), wish);
    balance(world, g > 0 ? atan2(v * v * wish, g) : 0, dt);
    steer(world, curvature(world, wish));
    gear_.drag(world, definition_.drag_area);
}

/// 1 where the suspension of a wheel carries, 0 where it hangs as far down as it goes.
double Motorcycle::grip(const World3& world, std::size_t wheel) const {
    const double down = (wheel == 0 ? definition_.front : definition_.rear).travel_down;
    if (down == 0) return 1;
    return std::clamp((1 + world.coordinate(joints()[wheel]) / down) / (1 - light), 0.0, 1.0);
}

/// Draws the lean towards that of the curve as a critically damped spring does, about the line on which the
/// wheels stand.
void Motorcycle::balance(World3& world, double wanted_lean, double dt) {
    const double most = definition_.lean_speed * dt;
    leaning_ = std::clamp(wanted_lean, leaning_ - most, leaning_ + most);
    const Vec3 forward = rotate(world.rotation(chassis()), Vec3{1, 0, 0});
    // Impulses make the chassis tremble about that line within a step; how it really leans tells its speed.
    const double now = lean(world), off = leaning_ - now, rate = (now - leaned_) / dt;
    leaned_ = now;
    // Who stands on the flat of the tyres needs no hand, and may fall asleep.
    if (std::fabs(now) > definition_.max_lean + fallen) return;
    const double flat = 0.5 * std::min(definition_.front.width, definition_.rear.width) / height_;
    if (leaning_ == 0 && std::fabs(speed(world)) < standing && std::fabs(now) < 0.5 * flat) return;
    const double w = 2 * pi * lean_frequency;
    const double inertia = world.mass_properties(chassis()).inertia.xx + mass_ * height_ * height_;
    const double torque =
        std::clamp(inertia * (w * w * off - 2 * w * rate), -definition_.lean_torque, definition_.lean_torque);
    world.apply_torque(chassis(), -torque * forward);
}

/// The curve to steer now: the wanted one, as far as the lean as it is balances it but for half of the
/// torque.
double Motorcycle::curvature(const World3& world, double wanted) const {
    const double v = speed(world), slack = 0.5 * definition_.lean_torque / (mass_ * height_);
    const double balanced = gravity_of(world) * tan(std::clamp(lean(world), -1.3, 1.3));
    if (std::fabs(v * v * wanted - balanced) <= slack) return wanted;
    return std::clamp(v * v * wanted, balanced - slack, balanced + slack) / std::max(v * v, 1.0);
}

/// Turned by δ about an axis that leans back by r, on a motorcycle that leans by φ, the wheel's track makes
/// an angle α with that of the rear one for which tan α (cos φ − sin r tan δ sin φ) = cos r tan δ.
void Motorcycle::steer(World3& world, double curvature) {
    const double track = curvature * base_, leaning = std::clamp(lean(world), -1.3, 1.3);
    const double angle =
        atan2(track * cos(leaning), cos(definition_.rake) + track * sin(definition_.rake) * sin(leaning));
    gear_.steer(world, 0, std::clamp(angle, -definition_.max_steering, definition_.max_steering));
}

}  // namespace carom
