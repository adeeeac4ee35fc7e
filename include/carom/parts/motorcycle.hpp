#pragma once

#include <span>

#include "carom/parts/engine.hpp"
#include "carom/parts/wheels.hpp"

namespace carom {

/// A motorcycle in space: a chassis (the rider included), a raked fork, two wheels in line.
struct MotorcycleDefinition {
    BodyDefinition<3> chassis{};  ///< dynamic
    /// In front of and behind the centre of mass, at z = 0. Narrow tyres roll on their edges as it leans.
    Wheel<3> front{.position = {0.75, -0.25, 0},
                   .radius = 0.3,
                   .width = 0.06,
                   .mass = 12,
                   .brake_torque = 450,
                   .frequency = 2,
                   .damping_ratio = 0.6,
                   .travel_up = 0.12,
                   .travel_down = 0.1};
    Wheel<3> rear{.position = {-0.65, -0.25, 0},
                  .radius = 0.3,
                  .width = 0.06,
                  .mass = 14,
                  .brake_torque = 80,
                  .frequency = 2,
                  .damping_ratio = 0.6,
                  .travel_up = 0.12,
                  .travel_down = 0.1};
    double rake = 0.4;  ///< rad, 0 … 1: how far the fork leans back
    Engine engine{
        .torque = {{1000, 50}, {4000, 75}, {8000, 90}, {10500, 75}, {11500, 0}}, .idle = 1000, .braking = 10};
    Gearbox gearbox{.ratios = {2.7, 1.9, 1.5, 1.25, 1.1, 1.0},
                    .final_drive = 4.6,
                    .shift_up = 9500,
                    .shift_down = 4000,
                    .shift_time = 0.1};
    double max_lean = 0.8;      ///< rad, 0 … 1.3: it goes no curve that asks for more
    double lean_speed = 2;      ///< rad/s, positive: how fast it changes sides
    double lean_torque = 600;   ///< N·m, not negative: the most that holds it against falling
    double max_steering = 0.6;  ///< rad, 0 … 1.2
    double drag_area = 0.4;     ///< drag coefficient times area, m², not negative
    Filter wheel_filter{};
};

/// What the rider does.
struct MotorcycleControls {
    double throttle = 0;  ///< 0 … 1
    double brake = 0;     ///< 0 … 1, of both wheels
    double steering = 0;  ///< −1 … 1: the curvature of the way, to the left
};

/// A motorcycle on wheel joints (`RunningGear`) that leans into its curves by itself.
///
/// The curve that the rider wants says how far to lean: tan(lean) = v² · curvature / g, `max_lean` at most.
/// A torque about the line from wheel to wheel draws it there: it stands for what riders do with their
/// weight, and is no more than `lean_torque`. The front wheel is steered into the curve for which the
/// motorcycle leans as it *is*; what that leaves to the torque is half of its most. So it leans first and
/// turns then, and steers into a fall when it is struck. Where it leans by 0.3 rad more than `max_lean` the
/// rider lets go, and it falls.
///
/// Throttle and brakes are cut back so that the other wheel stays on the ground, and brakes do not lock.
/// Fast narrow wheels ask for small sub-steps: at 60 Hz, 4 are enough up to 30 m/s, 16 up to 45 m/s.
class Motorcycle {
  public:
    /// Adds the bodies and joints. Throws `Error` that names the field; the world is then as before.
    Motorcycle(World<3>& world, const MotorcycleDefinition& definition);

    /// Sets motors, steering and balance for the next step, of `dt` seconds. To be followed by
    /// world.step(dt).
    void drive(World<3>& world, const MotorcycleControls& controls, double dt);
    /// Removes its bodies, and with them the joints.
    void remove(World<3>& world) { gear_.remove(world); }

    /// Its parts; the front wheel comes first.
    BodyId<3> chassis() const { return gear_.chassis(); }
    std::span<const BodyId<3>> wheels() const { return gear_.wheels(); }
    std::span<const JointId<3>> joints() const { return gear_.joints(); }
    /// 1 is the lowest.
    int gear() const { return drivetrain_.gear(); }
    /// Of the engine, 1/min.
    double engine_speed() const { return drivetrain_.engine_speed(); }
    /// Of the chassis forward, m/s.
    double speed(const World<3>& world) const { return gear_.speed(world); }
    /// How far it leans to the left, rad.
    double lean(const World<3>& world) const;

  private:
    double grip(const World<3>& world, std::size_t wheel) const;
    void balance(World<3>& world, double wanted_lean, double dt);
    double curvature(const World<3>& world, double wanted) const;
    void steer(World<3>& world, double curvature);

    MotorcycleDefinition definition_;
    Drivetrain drivetrain_;
    RunningGear<3> gear_;
    double mass_ = 0;                         ///< of all
    double height_ = 0;                       ///< of the chassis' centre of mass over the ground
    double base_ = 0;                         ///< from wheel to wheel
    double most_drive_ = 0, most_brake_ = 0;  ///< N, that leave either wheel its part of the weight
    double leaning_ = 0;                      ///< where the lean shall be now
    double leaned_ = 0;                       ///< where it was a step ago
};

}  // namespace carom
