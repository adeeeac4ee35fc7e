#pragma once

#include <array>
#include <span>
#include <vector>

#include "carom/world.hpp"

namespace carom {

/// A wheel of a vehicle. In the frame of the chassis x points forward, y up, and in space z to the right.
template <int D>
struct Wheel {
    Vec<D> position{};      ///< of the hub under the weight of the vehicle, in the frame of the chassis, m
    double radius = 0.35;   ///< m, positive
    double width = 0.22;    ///< in space, m, positive
    double mass = 20;       ///< kg, positive
    double friction = 1.3;  ///< of the tyre, not negative
    double brake_torque = 2000;  ///< N·m at full brake, not negative
    double frequency =
        1.6;  ///< Hz, positive: with which the part of the chassis that it carries swings on it
    double damping_ratio = 0.5;  ///< the same, not negative
    double travel_up = 0.15;     ///< m, not negative: how far it gives way
    double travel_down = 0.2;    ///< m, not negative: how far it hangs when it carries nothing
};

/// How a wheel is held.
template <int D>
struct WheelMount {
    Wheel<D> wheel{};
    bool steered = false;  ///< in space
    double rake = 0;       ///< rad, −1 … 1: how far its suspension leans back
};

/// What vehicles have in common: a chassis on wheel joints. Each wheel is a body of its own, that touches the
/// ground, and grips it by friction.
template <int D>
class RunningGear {
  public:
    /// Adds the bodies and joints. Throws `Error` that names the field; the world is then as before.
    RunningGear(World<D>& world, const BodyDefinition<D>& chassis, std::vector<WheelMount<D>> mounts,
                const Filter& wheel_filter);
    /// Removes the bodies, and with them the joints.
    void remove(World<D>& world);

    /// The body that all wheels hang on.
    BodyId<D> chassis() const { return chassis_; }
    /// The bodies of the wheels, in the order of their mounts.
    std::span<const BodyId<D>> wheels() const { return wheels_; }
    /// Their wheel joints, in the same order.
    std::span<const JointId<D>> joints() const { return joints_; }

    /// Of the chassis forward, m/s.
    double speed(const World<D>& world) const;
    /// How fast a wheel turns against the chassis, rad/s; positive is forward.
    double turning(const World<D>& world, std::size_t wheel) const;
    /// The wheel reaches for this speed, rad/s, by at most this torque, N·m. Who is told the same again may
    /// fall asleep.
    void set_motor(World<D>& world, std::size_t wheel, double speed, double most);
    /// Gives a wheel a torque forward (N·m), with which it turns at `fastest` rad/s at most, and a brake.
    void push(World<D>& world, std::size_t wheel, double torque, double brake, double fastest, bool reverse);
    /// Turns a wheel to the left, rad.
    void steer(World<D>& world, std::size_t wheel, double angle) requires(D == 3);
    /// The air's, by drag coefficient times area, m² (m in the plane).
    void drag(World<D>& world, double area) const;

  private:
    void add(World<D>& world, const WheelMount<D>& mount, const Filter& filter, double carried);

    BodyId<D> chassis_{};
    std::vector<BodyId<D>> wheels_;
    std::vector<JointId<D>> joints_;
    std::vector<std::array<double, 2>> motors_;  ///< speed and torque that were set last
    std::vector<double> angles_;                 ///< of steering that were set last
};

}  // namespace carom
