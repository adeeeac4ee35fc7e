#include "carom/parts/tracked_vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double ahead = 0.25;    // s of acceleration by which what is wanted leads what the tracks do
constexpr double correction = 3;  // 1/s: how fast the turn that slip took is made up for

const TrackedVehicleDefinition& checked(const TrackedVehicleDefinition& t) {
    require_positive(t.max_speed, "max_speed");
    require_positive(t.max_turn, "max_turn");
    require_positive(t.acceleration, "acceleration");
    require_positive(t.max_force, "max_force");
    const auto left = [](const Wheel<3>& w) { return w.position.z < 0; };
    const auto count = std::count_if(t.wheels.begin(), t.wheels.end(), left);
    if (count == 0) throw Error("wheels: there are none on the left");
    if (count == std::ssize(t.wheels)) throw Error("wheels: there are none on the right");
    return t;
}

std::vector<WheelMount<3>> mounts(const TrackedVehicleDefinition& t) {
    std::vector<WheelMount<3>> result;
    for (const Wheel<3>& wheel : t.wheels) result.push_back({wheel});
    return result;
}

double towards(double from, double to, double most) { return std::clamp(to, from - most, from + most); }

}  // namespace

TrackedVehicle::TrackedVehicle(World3& world, const TrackedVehicleDefinition& definition)
    : definition_(checked(definition)),
      gear_(world, definition.chassis, mounts(definition), definition.wheel_filter) {
    double sum[2] = {}, count[2] = {};
    for (const Wheel<3>& wheel : definition.wheels) {
        const int side = wheel.position.z < 0 ? 0 : 1;
        sum[side] += wheel.position.z;
        ++count[side];
    }
    gauge_ = sum[1] / count[1] - sum[0] / count[0];
}

double TrackedVehicle::turn(const World3& world) const {
    const Rotation3 turned = world.rotation(chassis());
    return dot(world.angular_velocity(chassis()), rotate(turned, Vec3{0, 1, 0}));
}

void TrackedVehicle::drive(World3& world, const TrackControls& controls, double dt) {
    require_in(controls.throttle, -1, 1, "throttle");
    require_in(controls.steering, -1, 1, "steering");
    require_positive(dt, "dt");
    const TrackedVehicleDefinition& t = definition_;
    const double count = double(t.wheels.size());
    double mean = 0;
    for (std::size_t i = 0; i < t.wheels.size(); ++i)
        mean += gear_.turning(world, i) * t.wheels[i].radius / count;
    forward_ = towards(mean, forward_, ahead * t.acceleration);
    forward_ = towards(forward_, controls.throttle * t.max_speed, t.acceleration * dt);
    turn_ = towards(turn_, controls.steering * t.max_turn, 2 * t.acceleration / gauge_ * dt);
    const double most_trim = 2 * std::fabs(turn_);
    trim_ = std::clamp(trim_ + correction * dt * (turn_ - turn(world)), -most_trim, most_trim);

    for (std::size_t i = 0; i < t.wheels.size(); ++i) {
        const Wheel<3>& wheel = t.wheels[i];
        const double outwards = 0.5 * gauge_ * (turn_ + trim_);
        const double track = forward_ + (wheel.position.z < 0 ? -outwards : outwards);
        gear_.set_motor(world, i, track / wheel.radius, 2 * t.max_force * wheel.radius / count);
    }
}

}  // namespace carom
