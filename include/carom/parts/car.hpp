#pragma once

#include <span>
#include <vector>

#include "carom/parts/engine.hpp"
#include "carom/parts/wheels.hpp"

namespace carom {

/// A wheel of a car.
template <int D>
struct CarWheel : Wheel<D> {
    bool driven = false;     ///< by the engine
    bool steered = false;    ///< in space
    bool handbrake = false;  ///< the handbrake acts on it
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

/// A car on wheel joints (`RunningGear`).
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
    void remove(World<D>& world) { gear_.remove(world); }

    /// Its parts; wheels and joints in the order of the definition.
    BodyId<D> chassis() const { return gear_.chassis(); }
    std::span<const BodyId<D>> wheels() const { return gear_.wheels(); }
    std::span<const JointId<D>> joints() const { return gear_.joints(); }
    /// 1 is the lowest gear, −1 the reverse one.
    int gear() const { return drivetrain_.gear(); }
    /// Of the engine, 1/min.
    double engine_speed() const { return drivetrain_.engine_speed(); }
    /// Of the chassis forward, m/s.
    double speed(const World<D>& world) const { return gear_.speed(world); }

  private:
    void steer(World<D>& world, double wanted, double dt);

    CarDefinition<D> definition_;
    Drivetrain drivetrain_;
    RunningGear<D> gear_;
    double steering_ = 0;
};

using Car2 = Car<2>;
using Car3 = Car<3>;

}  // namespace carom
