#include "carom/parts/car.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double standing = 0.05;  // rad/s of wheels

template <int D>
const CarDefinition<D>& checked(const CarDefinition<D>& car) {
    require_in(car.differential_lock, 0, 1, "differential_lock");
    require_in(car.max_steering, 0, 1.3, "max_steering");
    require_positive(car.steering_speed, "steering_speed");
    require_not_negative(car.drag_area, "drag_area");
    return car;
}

template <int D>
std::vector<WheelMount<D>> mounts(const CarDefinition<D>& car) {
    std::vector<WheelMount<D>> result;
    for (const CarWheel<D>& wheel : car.wheels) result.push_back({wheel, wheel.steered});
    return result;
}

void check(const CarControls& c) {
    require_in(c.throttle, 0, 1, "throttle");
    require_in(c.brake, 0, 1, "brake");
    require_in(c.handbrake, 0, 1, "handbrake");
    require_in(c.steering, -1, 1, "steering");
}

}  // namespace

template <int D>
Car<D>::Car(World<D>& world, const CarDefinition<D>& definition)
    : definition_(checked(definition)),
      drivetrain_(definition.engine, definition.gearbox),
      gear_(world, definition.chassis, mounts(definition), definition.wheel_filter) {}

template <int D>
void Car<D>::drive(World<D>& world, const CarControls& controls, double dt) {
    check(controls);
    require_positive(dt, "dt");
    const std::vector<CarWheel<D>>& wheels = definition_.wheels;
    double mean = 0;
    int driven = 0;
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        if (!wheels[i].driven) continue;
        mean += gear_.turning(world, i);
        ++driven;
    }
    if (driven > 0) mean /= driven;
    drivetrain_.update(mean, speed(world), controls.reverse, dt);

    const double axle = driven > 0 ? drivetrain_.torque(controls.throttle) / driven : 0;
    for (std::size_t i = 0; i < wheels.size(); ++i) {
        const CarWheel<D>& wheel = wheels[i];
        double torque = 0;
        if (wheel.driven && (axle != 0 || std::fabs(mean) > standing)) {
            // A locked differential takes a quarter of the difference away in a step.
            const double inertia = 0.5 * wheel.mass * wheel.radius * wheel.radius;
            torque =
                axle + definition_.differential_lock * 0.25 * inertia / dt * (mean - gear_.turning(world, i));
        }
        const double brake = std::max(controls.brake, wheel.handbrake ? controls.handbrake : 0.0);
        gear_.push(world, i, torque, brake * wheel.brake_torque, drivetrain_.fastest(), gear() < 0);
    }
    if constexpr (D == 3) steer(world, controls.steering * definition_.max_steering, dt);
    gear_.drag(world, definition_.drag_area);
}

/// All steered wheels turn about the point on the line of the others at which the one in the middle turns.
template <int D>
void Car<D>::steer(World<D>& world, double wanted, double dt) {
    if constexpr (D == 3) {
        const double most = definition_.steering_speed * dt;
        const double next = std::clamp(wanted, steering_ - most, steering_ + most);
        if (next == steering_) return;
        steering_ = next;
        double back = 0;
        int straight = 0;
        for (const CarWheel<D>& w : definition_.wheels) {
            if (w.steered) continue;
            back += w.position.x;
            ++straight;
        }
        if (straight > 0) back /= straight;
        const double slope = tan(steering_);
        for (std::size_t i = 0; i < definition_.wheels.size(); ++i) {
            const CarWheel<D>& w = definition_.wheels[i];
            if (!w.steered) continue;
            // The centre lies (x − back) / slope to the left; on the right the way there is longer.
            const double base = w.position.x - back;
            const double angle =
                straight == 0 || base == 0 ? steering_ : atan2(slope * base, base + slope * w.position.z);
            gear_.steer(world, i, angle);
        }
    }
}

template class Car<2>;
template class Car<3>;

}  // namespace carom
