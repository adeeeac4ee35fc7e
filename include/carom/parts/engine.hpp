#pragma once

#include <array>
#include <vector>

namespace carom {

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

/// An engine, its gearbox, and in which gear they run.
class Drivetrain {
  public:
    /// Throws `Error` that names the field.
    Drivetrain(const Engine& engine, const Gearbox& gears);

    /// Follows the driven wheels, which turn at `axle` rad/s, and shifts; `speed` is that of the vehicle,
    /// m/s.
    void update(double axle, double speed, bool reverse, double dt);

    /// At the axle, N·m, all wheels together; negative where the engine brakes, and in reverse.
    double torque(double throttle) const;
    /// How fast wheels turn at the highest speed of the engine in this gear, rad/s, positive.
    double fastest() const;
    /// 1 is the lowest gear, −1 the reverse one.
    int gear() const { return gear_; }
    /// Of the engine, 1/min.
    double engine_speed() const { return engine_speed_; }

  private:
    double ratio() const;

    Engine engine_;
    Gearbox gears_;
    double engine_speed_ = 0, shifting_ = 0;
    int gear_ = 1;
};

}  // namespace carom
