#include "carom/parts/wheels.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"
#include "world/validate.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double air_density = 1.2;  // kg/m³
// The tread resists turning on the spot, so steering has to be stiff.
constexpr double steering_frequency = 30;  // Hz

template <int D>
void check(const Wheel<D>& w) {
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
}

/// What share of the chassis each wheel carries: the shares are equal but for what the moments about the
/// centre of mass ask for, in each direction along the ground by itself, as for a vehicle that is the same
/// left and right.
template <int D>
std::vector<double> shares(const std::vector<WheelMount<D>>& mounts, const Vec<D>& center) {
    const double count = double(mounts.size());
    std::vector<double> result(mounts.size(), 1 / count);
    for (int axis = 0; axis < D; axis += 2) {
        double mean = 0, spread = 0;
        for (const WheelMount<D>& m : mounts) mean += m.wheel.position[axis] / count;
        for (const WheelMount<D>& m : mounts)
            spread += (m.wheel.position[axis] - mean) * (m.wheel.position[axis] - mean);
        if (spread == 0) continue;
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] += (center[axis] - mean) * (mounts[i].wheel.position[axis] - mean) / spread;
    }
    for (double& share : result) share = std::max(share, 0.2 / count);
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
RunningGear<D>::RunningGear(World<D>& world, const BodyDefinition<D>& chassis,
                            std::vector<WheelMount<D>> mounts, const Filter& wheel_filter) {
    if (chassis.type != BodyType::dynamic) throw Error("chassis.type: is not dynamic");
    if (mounts.empty()) throw Error("wheels: there are none");
    for (std::size_t i = 0; i < mounts.size(); ++i) {
        within(component("wheels", static_cast<int>(i)) + ".", [&] {
            check(mounts[i].wheel);
            require_in(mounts[i].rake, -1, 1, "rake");
        });
    }
    chassis_ = world.add_body(chassis);
    try {
        const std::vector<double> carried = shares(mounts, world.mass_properties(chassis_).center);
        for (std::size_t i = 0; i < mounts.size(); ++i) add(world, mounts[i], wheel_filter, carried[i]);
    } catch (const Error&) {
        remove(world);
        throw;
    }
    motors_.assign(wheels_.size(), {0, 0});
    angles_.assign(wheels_.size(), 0);
}

template <int D>
void RunningGear<D>::add(World<D>& world, const WheelMount<D>& mount, const Filter& filter, double carried) {
    const Wheel<D>& wheel = mount.wheel;
    const Transform<D> placed = world.transform(chassis_);
    BodyDefinition<D> body;
    body.position = apply(placed, wheel.position);
    body.rotation = placed.rotation;
    body.velocity = world.velocity_at(chassis_, body.position);
    body.mass = wheel.mass;
    ShapeDefinition<D>& tyre = body.shapes.emplace_back();
    tyre.material.friction = wheel.friction;
    tyre.filter = filter;
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
    Vec<D> up = unit<D>(1);
    if (mount.rake != 0) {
        up.x = -sin(mount.rake);
        up.y = cos(mount.rake);
    }
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
        if (mount.steered) {
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
void RunningGear<D>::remove(World<D>& world) {
    for (const BodyId<D> wheel : wheels_) world.remove_body(wheel);
    world.remove_body(chassis_);
}

template <int D>
double RunningGear<D>::speed(const World<D>& world) const {
    return dot(world.velocity(chassis_), rotate(world.rotation(chassis_), unit<D>(0)));
}

template <int D>
double RunningGear<D>::turning(const World<D>& world, std::size_t wheel) const {
    const Angular<D> turning = world.angular_velocity(wheels_[wheel]) - world.angular_velocity(chassis_);
    if constexpr (D == 2)
        return -turning;
    else
        return -dot(turning, rotate(world.rotation(wheels_[wheel]), Vec3{0, 0, 1}));
}

template <int D>
void RunningGear<D>::set_motor(World<D>& world, std::size_t wheel, double speed, double most) {
    if (motors_[wheel] == std::array{speed, most}) return;
    motors_[wheel] = {speed, most};
    world.set_motor(joints_[wheel], JointMotor{.speed = -speed, .max = most});
}

/// A torque is a motor that reaches for the highest speed of the engine, or for standstill where it brakes.
template <int D>
void RunningGear<D>::push(World<D>& world, std::size_t wheel, double torque, double brake, double fastest,
                          bool reverse) {
    const double now = turning(world, wheel);
    const bool brakes = torque == 0 || (now != 0 && (torque < 0) != (now < 0) && !reverse);
    if (brakes)
        set_motor(world, wheel, 0, std::fabs(torque) + brake);
    else if (std::fabs(torque) > brake)
        set_motor(world, wheel, torque > 0 ? fastest : -fastest, std::fabs(torque) - brake);
    else
        set_motor(world, wheel, 0, brake - std::fabs(torque));
}

template <int D>
void RunningGear<D>::steer(World<D>& world, std::size_t wheel, double angle) requires(D == 3) {
    if (angles_[wheel] == angle) return;
    angles_[wheel] = angle;
    world.set_steering(joints_[wheel], JointMotor{.target = angle, .frequency = steering_frequency});
}

template <int D>
void RunningGear<D>::drag(World<D>& world, double area) const {
    const Vec<D> v = world.velocity(chassis_);
    if (area > 0 && length(v) > 0.1) world.apply_force(chassis_, (-0.5 * air_density * area * length(v)) * v);
}

template class RunningGear<2>;
template class RunningGear<3>;

}  // namespace carom
