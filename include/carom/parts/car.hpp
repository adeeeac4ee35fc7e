#pragma once

#include <array>
#include <span>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// A wheel of a car. In the frame of the chassis x points forward, y up, and in space z to the right.
template <int D>
struct CarWheel {
    Vec<D> position{};           ///< of the hub under the weight of the car, in the frame of the chassis, m
    double radius = 0.35;        ///< m, positive
    double width = 0.22;         ///< in space, m, positive
    double mass = 20;            ///< kg, positive
    double friction = 1.3;       ///< of the tyre, not negative
    bool driven = false;         ///< by the engine
    bool steered = false;        ///< in space
    bool handbrake = false;      ///< the handbrake acts on it
    double brake_torque = 2000;  ///< N·m at full brake, not negative
    double frequency =
        1.6;  ///< Hz, positive: with which the part of the chassis that it carries swings on it
    double damping_ratio = 0.5;  ///< the same, not negative
    double travel_up = 0.15;     ///< m, not negative: how far it gives way
    double travel_down = 0.2;    ///< m, not negative: how far it hangs when it carries nothing
};

/// An engine: its torque at full throttle by its speed, and what it brakes without.
struct Engine {
    /// Pairs of speed (1/min, growing) and torque (N·m, not negative); between them straight lines.
    std::vector<std::array<double, 2>> torque{{800, 120}, {2500, 200}, {4500, 220}, {6000, 180}, {6800, 0}};
    double idle = 800;    ///< 1/min, positive
    double braking = 40;  ///< N·m without throttle at the highest speed, less below; not negative
};

/// A gearbox that shifts by itself.
struct Gearbox {
    std::vector<double> ratios{3.6, 2.1, 1.45, 1.1, 0.9};  ///< engine to axle turns, positive, falling
    double reverse = 3.4;                                  ///< positive
    double final_drive = 3.7;                              ///< positive; multiplies them all
    double efficiency = 0.9;                               ///< 0 … 1, not 0
    double shift_up = 5500;                                ///< 1/min
    double shift_down = 2200;                              ///< 1/min, less than shift_up
    double shift_time = 0.25;                              ///< s without torque, not negative
};

/// A car: a chassis, its wheels, and what drives them.
template <int D>
struct CarDefinition {
    BodyDefinition<D> chassis{};  ///< dynamic; a low centre of mass keeps it on its wheels
    std::vector<CarWheel<D>> wheels{};
    Engine engine{};
    Gearbox gearbox{};
    /// How strongly driven wheels are kept at one speed: 0 is an open differential, which gives each the same
    /// torque, 1 a locked one.
    double differential_lock = 0.2;
    double max_steering = 0.6;    ///< rad, 0 … 1.3: in the middle between the steered wheels
    double steering_speed = 2.5;  ///< rad/s, positive
    double drag_area = 0.7;       ///< drag coefficient times area, m² (m in the plane), not negative
    Filter wheel_filter{};
};

/// What the driver does.
struct CarControls {
    double throttle = 0;   ///< 0 … 1
    double brake = 0;      ///< 0 … 1
    double handbrake = 0;  ///< 0 … 1
    double steering = 0;   ///< −1 … 1, to the left; in space
    bool reverse = false;  ///< engages the reverse gear, once the car is slow
};

/// A car on wheel joints: each wheel is a body of its own, that touches the ground, and grips it by friction.
///
/// The torque of the engine goes through gear and differential to the motors of the driven wheels, which
/// cannot turn faster than the engine lets them. Steered wheels turn about one point (Ackermann).
template <int D>
class Car {
  public:
    /// Adds the bodies and joints. Throws `Error` that names the field; the world is then as before.
    Car(World<D>& world, const CarDefinition<D>& definition);

    /// Sets motors and steering for the next step, of `dt` seconds. To be followed by world.step(dt).
    void drive(World<D>& world, const CarControls& controls, double dt);
    /// Removes its bodies, and with them the joints.
    void remove(World<D>& world);

    /// Its parts; wheels and joints in the order of the definition.
    BodyId<D> chassis() const { return chassis_; }
    std::span<const BodyId<D>> wheels() const { return wheels_; }
    std::span<const JointId<D>> joints() const { return joints_; }
    /// 1 is the lowest gear, −1 the reverse one.
    int gear() const { return gear_; }
    /// Of the engine, 1/min.
    double engine_speed() const { return engine_speed_; }
    /// Of the chassis forward, m/s.
    double speed(const World<D>& world) const;

  private:
    void add_wheel(World<D>& world, const CarWheel<D>& wheel, double carried);
    double turning_of(const World<D>& world, std::size_t wheel) const;
    double ratio() const;
    void shift(const CarControls& controls, double speed, double dt);
    double engine_torque(double throttle) const;
    void set_motor(World<D>& world, std::size_t wheel, double torque, double brake);
    void steer(World<D>& world, double wanted, double dt);

    CarDefinition<D> definition_;
    BodyId<D> chassis_{};
    std::vector<BodyId<D>> wheels_;
    std::vector<JointId<D>> joints_;
    std::vector<std::array<double, 2>> motors_;  ///< speed and torque that were set last
    double engine_speed_ = 0, steering_ = 0, shifting_ = 0;
    int gear_ = 1;
};

using Car2 = Car<2>;
using Car3 = Car<3>;

}  // namespace carom
