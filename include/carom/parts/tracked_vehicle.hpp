#pragma once

#include <array>
#include <span>
#include <vector>

#include "carom/parts/wheels.hpp"

namespace carom {

/// A vehicle on two tracks, in space. A track is a row of wheels that turn at one speed.
struct TrackedVehicleDefinition {
    BodyDefinition<3> chassis{};  ///< dynamic; a low centre of mass lets it climb
    /// Those at z < 0 carry the left track, the others the right one; at least one of each. Wheels may
    /// overlap where the filter keeps them from touching each other: by a negative `group`.
    std::vector<Wheel<3>> wheels{};
    double max_speed = 12;    ///< m/s, positive
    double max_turn = 1;      ///< rad/s, positive
    double acceleration = 4;  ///< m/s², positive: of the tracks, also when they brake
    double max_force = 70e3;  ///< N, positive: of either track
    Filter wheel_filter{};
};

/// What the driver does.
struct TrackControls {
    double throttle = 0;  ///< −1 … 1, of the highest speed
    double steering = 0;  ///< −1 … 1, of the fastest turn, to the left; on the spot as well
};

/// A tracked vehicle on wheel joints (`RunningGear`), as a hydrostatic drive moves it: each track is driven
/// at a speed of its own, by limited force, and holds where it shall stand.
///
/// Tracks that turn slip sideways, so it turns by less than the difference of their speeds says; what is
/// missing of the turn that the driver wants is made up for, by at most twice that turn.
class TrackedVehicle {
  public:
    /// Adds the bodies and joints. Throws `Error` that names the field; the world is then as before.
    TrackedVehicle(World<3>& world, const TrackedVehicleDefinition& definition);

    /// Sets the motors for the next step, of `dt` seconds. To be followed by world.step(dt).
    void drive(World<3>& world, const TrackControls& controls, double dt);
    /// Removes its bodies, and with them the joints.
    void remove(World<3>& world) { gear_.remove(world); }

    /// Its parts; wheels and joints in the order of the definition.
    BodyId<3> chassis() const { return gear_.chassis(); }
    std::span<const BodyId<3>> wheels() const { return gear_.wheels(); }
    std::span<const JointId<3>> joints() const { return gear_.joints(); }
    /// Of the chassis forward, m/s.
    double speed(const World<3>& world) const { return gear_.speed(world); }
    /// Of the chassis to the left, rad/s.
    double turn(const World<3>& world) const;

  private:
    TrackedVehicleDefinition definition_;
    RunningGear<3> gear_;
    double gauge_ = 0;                          ///< from track to track, m
    double forward_ = 0, turn_ = 0, trim_ = 0;  ///< what the tracks shall do now; what slip takes of the turn
};

}  // namespace carom
