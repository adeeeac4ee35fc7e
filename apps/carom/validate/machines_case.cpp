#include <fmt/format.h>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Simple machines.

namespace carom::app {
namespace {

constexpr Bounds bounds{1e-2, 1e-4};

template <int D>
BodyId<D> add_body(World<D>& world, double mass, const Vec<D>& position, const Geometry<D>& shape) {
    BodyDefinition<D> body;
    body.mass = mass;
    body.position = position;
    body.shapes.push_back({shape});
    return world.add_body(body);
}

template <int D>
JointId<D> add_joint(World<D>& world, const decltype(JointDefinition<D>::kind)& kind, std::optional<BodyId<D>> a,
                     BodyId<D> b) {
    JointDefinition<D> joint;
    joint.kind = kind;
    joint.a = a;
    joint.b = b;
    return world.add_joint(joint);
}

template <int D>
double inertia_of(const World<D>& world, BodyId<D> body) {
    if constexpr (D == 2)
        return world.mass_properties(body).inertia;
    else
        return world.mass_properties(body).inertia.zz;
}

template <int D>
void add_atwood(std::vector<Result>& results) {
    World<D> world;
    const BodyId<D> heavy = add_body<D>(world, 2, in_plane<D>(-1, 0), Ball{0.1});
    const BodyId<D> light = add_body<D>(world, 1, in_plane<D>(1, 0), Ball{0.1});
    const JointId<D> rope = add_joint<D>(
        world, PulleyJoint<D>{.ground_a = in_plane<D>(-1, 5), .ground_b = in_plane<D>(1, 5)}, heavy, light);
    run_until(world, 1);
    const std::string what = fmt::format("{}D, Atwood: ", D);
    results.push_back(relative(what + "acceleration (m/s²)", 3.27, -world.velocity(heavy).y, bounds));
    results.push_back(relative(what + "tension (N)", 13.08, length(world.joint_force(rope)), bounds));
}

template <int D>
void add_gear(std::vector<Result>& results, double ratio) {
    World<D> world;
    const BodyId<D> one = add_body<D>(world, 1, {}, Ball{0.5});
    const BodyId<D> two = add_body<D>(world, 3, in_plane<D>(2, 0), Ball{0.3});
    const JointId<D> a = add_joint<D>(world, HingeJoint<D>{}, {}, one);
    const JointId<D> b = add_joint<D>(world, HingeJoint<D>{.anchor = in_plane<D>(2, 0)}, {}, two);
    JointDefinition<D> gear;
    gear.kind = GearJoint<D>{.joint_a = a, .joint_b = b, .ratio = ratio};
    world.add_joint(gear);
    for (int i = 0; i < 60; ++i) {
        world.apply_torque(one, spin<D>(1));
        world.step(frame);
    }
    const std::string what = fmt::format("{}D, gear of {:g}: ", D, ratio);
    const double speed = world.coordinate_speed(a);
    results.push_back(relative(what + "acceleration (rad/s²)",
                               1 / (inertia_of(world, one) + ratio * ratio * inertia_of(world, two)), speed, bounds));
    results.push_back(relative(what + "speed of the other wheel / speed", -ratio, world.coordinate_speed(b) / speed, bounds));
}

template <int D>
void add_spring(std::vector<Result>& results) {
    constexpr std::pair<double, double> known[] = {
        {0, -0.839071529}, {0.05, -0.529208819}, {0.2, -0.136092048}, {0.5, -0.002170117}, {1, 0.000499399}};
    for (const auto& [damping_ratio, reference] : known) {
        WorldDefinition<D> definition;
        definition.gravity = {};
        World<D> world(definition);
        const BodyId<D> mass = add_body<D>(world, 1, in_plane<D>(1, 0), Ball{0.1});
        const JointSpring spring{.frequency = 10 / (2 * pi), .damping_ratio = damping_ratio, .rest = -1};
        add_joint<D>(world, SliderJoint<D>{.anchor = in_plane<D>(1, 0), .spring = spring}, {}, mass);
        run_until(world, 1);
        results.push_back(absolute(fmt::format("{}D, spring, damping ratio {:g}: place at 1 s (m)", D, damping_ratio),
                                   reference, world.position(mass).x, bounds));
    }
}

/// Falls from nearly upright, until its end is at the height of the hinge.
template <int D>
void add_falling_rod(std::vector<Result>& results) {
    World<D> world;
    BodyDefinition<D> rod;
    rod.mass = 1;
    if constexpr (D == 2) {
        rod.inertia = 1.0 / 12;
    } else {
        rod.inertia = Symmetric3<double>{1.0 / 12, 0.001, 1.0 / 12};
    }
    constexpr double tilt = 1e-3;
    rod.rotation = turned<D>(-tilt);
    rod.position = in_plane<D>(0.5 * std::sin(tilt), 0.5 * std::cos(tilt));
    rod.shapes.push_back({Capsule<D>{in_plane<D>(0, -0.48), in_plane<D>(0, 0.48), 0.02}});
    const BodyId<D> body = world.add_body(rod);
    const JointId<D> hinge = add_joint<D>(world, HingeJoint<D>{}, {}, body);
    double before = 0, speed_before = 0;
    while (world.coordinate(hinge) > tilt - pi / 2) {
        before = world.coordinate(hinge);
        speed_before = world.coordinate_speed(hinge);
        world.step(frame);
    }
    const double now = world.coordinate(hinge), speed = world.coordinate_speed(hinge);
    // The square of the speed grows evenly enough within a step.
    const double share = (tilt - pi / 2 - before) / (now - before);
    const double squared = speed_before * speed_before + share * (speed * speed - speed_before * speed_before);
    results.push_back(relative(fmt::format("{}D, hinged rod: speed of its end at the ground (m/s)", D),
                               std::sqrt(3 * g), std::sqrt(squared), bounds));
}

template <int D>
void add_machines(std::vector<Result>& results) {
    add_atwood<D>(results);
    add_gear<D>(results, 0.5);
    add_gear<D>(results, 3);
    add_spring<D>(results);
    add_falling_rod<D>(results);
}

}  // namespace

std::vector<Result> simple_machines() {
    std::vector<Result> results;
    add_machines<2>(results);
    add_machines<3>(results);
    return results;
}

}  // namespace carom::app
