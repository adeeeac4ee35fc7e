#include "carom/parts/car.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"
#include "world/validate.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double per_minute = pi / 30;  // rad/s of 1/min
constexpr double air_density = 1.2;     // kg/m³
// The tread resists turning on the spot, so steering has to be stiff.
constexpr double steering_frequency = 30;  // Hz
constexpr double standing = 0.05;          // rad/s of wheels
constexpr double slow = 1;                 // m/s: below it the reverse gear goes in and out

void check(const Engine& engine, const Gearbox& gears) {
    if (engine.torque.size() < 2) throw Error("engine.torque: needs at least two points");
    for (std::size_t i = 0; i < engine.torque.size(); ++i) {
        const std::string name = component("engine.torque", static_cast<int>(i));
        require_positive(engine.torque[i][0], name);
        require_not_negative(engine.torque[i][1], name);
        if (i > 0 && !(engine.torque[i][0] > engine.torque[i - 1][0]))
            refuse(name, engine.torque[i][0], "is not above the speed before");
    }
    require_positive(engine.idle, "engine.idle");
    require_not_negative(engine.braking, "engine.braking");
    if (gears.ratios.empty()) throw Error("gearbox.ratios: there are none");
    for (std::size_t i = 0; i < gears.ratios.size(); ++i) {
        const std::string name = component("gearbox.ratios", static_cast<int>(i));
        require_positive(gears.ratios[i], name);
        if (i > 0 && gears.ratios[i] >= gears.ratios[i - 1])
            refuse(name, gears.ratios[i], "is not below the ratio before");
    }
    require_positive(gears.reverse, "gearbox.reverse");
    require_positive(gears.final_drive, "gearbox.final_drive");
    require_positive(gears.efficiency, "gearbox.efficiency");
    require_in(gears.efficiency, 0, 1, "gearbox.efficiency");
    require_positive(gears.shift_down, "gearbox.shift_down");
    if (!(gears.shift_up > gears.shift_down))
        refuse("gearbox.shift_up", gears.shift_up, "is not above shift_down");
    require_not_negative(gears.shift_time, "gearbox.shift_time");
}

template <int D>
void check(const CarDefinition<D>& car) {
    if (car.chassis.type != BodyType::dynamic) throw Error("chassis.type: is not dynamic");
    if (car.wheels.empty()) throw Error("wheels: there are none");
    for (std::size_t i = 0; i < car.wheels.size(); ++i) {
        const CarWheel<D>& w = car.wheels[i];
        within(component("wheels", static_cast<int>(i)) + ".", [&] {
            require_finite(w.position, "position");
            require_positive(w.radius, "radius");
            require_positive(w.width, "width");
            require_positive(w.mass, "mass");
            require_not_negative(w.friction, "friction");
            require_not_negative(w.brake_torque, "brake_torque");
            require_positive(w.frequency, "frequency");
            require_not_negative(w.damping_ratio, "damping_ratio");
            require_not_negative(w.travel_up, "travel_up");
            require_not_negative(w.travel_down, "travel_down");
        });
    }
    check(car.engine, car.gearbox);
    require_in(car.differential_lock, 0, 1, "differential_lock");
    require_in(car.max_steering, 0, 1.3, "max_steering");
    require_positive(car.steering_speed, "steering_speed");
    require_not_negative(car.drag_area, "drag_area");
}

void check(const CarControls& c) {
    require_in(c.throttle, 0, 1, "throttle");
    require_in(c.brake, 0, 1, "brake");
    require_in(c.handbrake, 0, 1, "handbrake");
    require_in(c.steering, -1, 1, "steering");
}

/// What share of the chassis each wheel carries: the shares are equal but for what the moments about the
/// centre of mass ask for, in each direction along the ground by itself, as for a car that is the same left
/// and right.
template <int D>
std::vector<double> shares(const CarDefinition<D>& car, const Vec<D>& center) {
    const double count = double(car.wheels.size());
    std::vector<double> result(car.wheels.size(), 1 / count);
    for (int axis = 0; axis < D; axis += 2) {
        double mean = 0, spread = 0;
        for (const CarWheel<D>& w : car.wheels) mean += w.position[axis] / count;
        for (const CarWheel<D>& w : car.wheels)
            spread += (w.position[axis] - mean) * (w.position[axis] - mean);
        if (spread == 0) continue;
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] += (center[axis] - mean) * (car.wheels[i].position[axis] - mean) / spread;
    }
    for (double& share : result) share = std::max(share, 0.05);
    return result;
}

template <int D>
Vec<D> unit(int axis) {
    Vec<D> e{};
    e[axis] = 1;
    return e;
}

}  // namespace

template <int D>
Car<D>::Car(World<D>& world, const CarDefinition<D>& definition) : definition_(definition) {
    check(definition);
    chassis_ = world.add_body(definition.chassis);
    try {
        const std::vector<double> carried = shares(definition, world.mass_properties(chassis_).center);
        for (std::size_t i = 0; i < definition.wheels.size(); ++i)
            add_wheel(world, definition.wheels[i], carried[i]);
    } catch (const Error&) {
        remove(world);
        throw;
    }
    motors_.assign(wheels_.size(), {0, 0});
    engine_speed_ = definition.engine.idle;
}

template <int D>
void Car<D>::add_wheel(World<D>& world, const CarWheel<D>& wheel, double carried) {
    const Transform<D> placed = world.transform(chassis_);
    BodyDefinition<D> body;
    body.position = apply(placed, wheel.position);
    body.rotation = placed.rotation;
    body.velocity = world.velocity_at(chassis_, body.position);
    body.mass = wheel.mass;
    ShapeDefinition<D>& tyre = body.shapes.emplace_back();
    tyre.material.friction = wheel.friction;
    tyre.filter = definition_.wheel_filter;
    if constexpr (D == 2) {
        tyre.geometry = Ball{wheel.radius};
    } else {
        tyre.geometry = Cylinder{wheel.radius, wheel.width};
        tyre.rotation = Rotation3::from_axis_angle({1, 0, 0}, 0.5 * pi);
    }
    wheels_.push_back(world.add_body(body));

    // A joint's spring is given as wheel and chassis swing at it; what is wanted is how the chassis swings on
    // a wheel that stands: stiffness (2π f)² m of the mass that it carries.
    const MassProperties<D> chassis = world.mass_properties(chassis_);
    const Vec<D> up = unit<D>(1);
    const Angular<D> lever = cross(wheel.position - chassis.center, up);
    const double swinging =
        1 / (1 / wheel.mass + 1 / chassis.mass + angular_dot(lever, inverse(chassis.inertia) * lever));
    const double mass = carried * chassis.mass, faster = std::sqrt(mass / swinging);
    const double rate = 2 * pi * wheel.frequency;
    WheelJoint<D> joint;
    joint.anchor = body.position;
    joint.axis = rotate(placed.rotation, up);
    joint.limits = JointLimits{-wheel.travel_down, wheel.travel_up};
    // At rest it carries its share of the weight, whatever gravity the world has.
    const double weight = std::max(0.0, -dot(joint.axis, world.definition().gravity));
    joint.spring = JointSpring{.frequency = wheel.frequency * faster,
                               .damping_ratio = wheel.damping_ratio * faster,
                               .rest = -weight / (rate * rate)};
    joint.motor = JointMotor{.speed = 0, .max = 0};
    if constexpr (D == 3) {
        joint.spin_axis = rotate(placed.rotation, Vec3{0, 0, 1});
        if (wheel.steered) {
            joint.steering = JointMotor{.target = 0, .frequency = steering_frequency};
            joint.steering_limits = JointLimits{-1.5, 1.5};
        }
    }
    JointDefinition<D> definition;
    definition.kind = joint;
    definition.a = chassis_;
    definition.b = wheels_.back();
    joints_.push_back(world.add_joint(definition));
}

template <int D>
void Car<D>::remove(World<D>& world) {
    for (const BodyId<D> wheel : wheels_) world.remove_body(wheel);
    world.remove_body(chassis_);
}

template <int D>
double Car<D>::speed(const World<D>& world) const {
    return dot(world.velocity(chassis_), rotate(world.rotation(chassis_), unit<D>(0)));
}

/// How fast a wheel turns against the chassis, rad/s; positive is forward.
template <int D>
double Car<D>::turning_of(const World<D>& world, std::size_t wheel) const {
    const Angular<D> turning = world.angular_velocity(wheels_[wheel]) - world.angular_velocity(chassis_);
    if constexpr (D == 2)
        return -turning;
    else
        return -dot(turning, rotate(world.rotation(wheels_[wheel]), Vec3{0, 0, 1}));
}

/// Turns of the engine for one of the driven wheels; negative in reverse.
template <int D>
double Car<D>::ratio() const {
    const Gearbox& box = definition_.gearbox;
    return box.final_drive * (gear_ < 0 ? -box.reverse : box.ratios[static_cast<std::size_t>(gear_ - 1)]);
}

template <int D>
void Car<D>::shift(const CarControls& controls, double speed, double dt) {
    const Gearbox& box = definition_.gearbox;
    shifting_ = std::max(0.0, shifting_ - dt);
    const int before = gear_;
    if (controls.reverse != (gear_ < 0)) {
        if (std::fabs(speed) < slow) gear_ = controls.reverse ? -1 : 1;
    } else if (gear_ > 0 && shifting_ == 0) {
        if (engine_speed_ > box.shift_up && gear_ < static_cast<int>(box.ratios.size())) ++gear_;
        if (engine_speed_ < box.shift_down && gear_ > 1) --gear_;
    }
    if (gear_ != before) shifting_ = box.shift_time;
}

template <int D>
double Car<D>::engine_torque(double throttle) const {
    if (shifting_ > 0) return 0;
    const auto& curve = definition_.engine.torque;
    const double most = curve.back()[0], at = std::clamp(engine_speed_, curve.front()[0], most);
    std::size_t i = 1;
    while (i + 1 < curve.size() && at > curve[i][0]) ++i;
    const double share = (at - curve[i - 1][0]) / (curve[i][0] - curve[i - 1][0]);
    const double full = curve[i - 1][1] + share * (curve[i][1] - curve[i - 1][1]);
    const double over_idle = std::max(0.0, engine_speed_ - definition_.engine.idle) / most;
    return throttle * full - (1 - throttle) * definition_.engine.braking * over_idle;
}

template <int D>
void Car<D>::drive(World<D>& world, const CarControls& controls, double dt) {
    check(controls);
    require_positive(dt, "dt");
    double mean = 0;
    int driven = 0;
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
        if (!definition_.wheels[i].driven) continue;
        mean += turning_of(world, i);
        ++driven;
    }
    if (driven > 0) mean /= driven;
    engine_speed_ = std::max(definition_.engine.idle, mean * ratio() / per_minute);
    shift(controls, speed(world), dt);

    const double axle =
        driven > 0 ? engine_torque(controls.throttle) * ratio() * definition_.gearbox.efficiency / driven : 0;
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
        const CarWheel<D>& wheel = definition_.wheels[i];
        double torque = 0;
        if (wheel.driven && (axle != 0 || std::fabs(mean) > standing)) {
            // A locked differential takes a quarter of the difference away in a step.
            const double inertia = 0.5 * wheel.mass * wheel.radius * wheel.radius;
            torque =
                axle + definition_.differential_lock * 0.25 * inertia / dt * (mean - turning_of(world, i));
        }
        const double brake = std::max(controls.brake, wheel.handbrake ? controls.handbrake : 0.0);
        set_motor(world, i, torque, brake * wheel.brake_torque);
    }
    if constexpr (D == 3) steer(world, controls.steering * definition_.max_steering, dt);

    const Vec<D> v = world.velocity(chassis_);
    if (definition_.drag_area > 0 && length(v) > 0.1)
        world.apply_force(chassis_, (-0.5 * air_density * definition_.drag_area * length(v)) * v);
}

/// A torque is a motor that reaches for the highest speed of the engine, or for standstill where it brakes.
template <int D>
void Car<D>::set_motor(World<D>& world, std::size_t wheel, double torque, double brake) {
    const double turning = turning_of(world, wheel);
    const bool brakes = torque == 0 || (turning != 0 && (torque < 0) != (turning < 0) && gear_ > 0);
    double speed = 0, most = std::fabs(torque) + brake;
    if (!brakes && std::fabs(torque) > brake) {
        const double highest = definition_.engine.torque.back()[0] * per_minute / std::fabs(ratio());
        speed = torque > 0 ? -highest : highest;
        most = std::fabs(torque) - brake;
    } else if (!brakes) {
        most = brake - std::fabs(torque);
    }
    if (motors_[wheel] == std::array{speed, most}) return;  // who parks may fall asleep
    motors_[wheel] = {speed, most};
    world.set_motor(joints_[wheel], JointMotor{.speed = speed, .max = most});
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
        for (std::size_t i = 0; i < wheels_.size(); ++i) {
            const CarWheel<D>& w = definition_.wheels[i];
            if (!w.steered) continue;
            // The centre lies (x − back) / slope to the left; on the right the way there is longer.
            const double base = w.position.x - back;
            const double angle =
                straight == 0 || base == 0 ? steering_ : atan2(slope * base, base + slope * w.position.z);
            world.set_steering(joints_[i], JointMotor{.target = angle, .frequency = steering_frequency});
        }
    }
}

template class Car<2>;
template class Car<3>;

}  // namespace carom
