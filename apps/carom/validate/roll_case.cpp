#include <fmt/format.h>

#include <string_view>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

constexpr double radius = 0.5, mass = 2;

/// A round body of 0.5 m radius and 2 kg.
template <int D>
struct Round {
    std::string_view name;
    double inertia;  ///< about its axis, as a share of m r²
};

/// Puts the body onto a floor that descends along x.
template <int D>
BodyId<D> add_round(World<D>& world, const Round<D>& round, double friction, double slope, double speed) {
    Material material;
    material.friction = friction;
    add_floor(world, material, slope);
    BodyDefinition<D> body;
    body.shapes.push_back({Ball{radius}});
    body.shapes.back().material = material;
    body.mass = mass;
    const double own = D == 2 ? 0.5 : 0.4, about_axis = round.inertia * mass * radius * radius;
    if (round.inertia != own) {
        if constexpr (D == 2) {
            body.inertia = about_axis;
        } else {  // flat, as hoops and disks are: half as much about a diameter
            body.inertia = Symmetric3<double>{0.5 * about_axis, 0.5 * about_axis, about_axis};
        }
    }
    body.position = rotate(turned<D>(-slope), in_plane<D>(0, radius));
    body.velocity = in_plane<D>(speed, 0);
    return world.add_body(body);
}

/// A body that slides at 3 m/s without spin, until it rolls and for ten seconds.
template <int D>
void add_slip_to_roll(std::vector<Result>& results, const Round<D>& round) {
    constexpr double v0 = 3, friction = 0.2;
    World<D> world;
    const BodyId<D> id = add_round(world, round, friction, 0, v0);
    const auto speed = [&] { return world.velocity(id).x; };
    const auto slip = [&] { return speed() + radius * spin_of(world.angular_velocity(id)); };

    // Slip falls at a steady rate: its line through the last two samples that slip ends where rolling begins.
    double time = 0, way = 0;
    for (double last = slip();; last = slip()) {
        const double last_speed = speed();
        world.step(frame);
        if (!(slip() >= 1e-3 * v0)) break;
        const double rate = (last - slip()) / frame, left = slip() / rate;
        const double deceleration = (last_speed - speed()) / frame;
        time = world.time() + left;
        way = world.position(id).x + speed() * left - 0.5 * deceleration * left * left;
    }

    const double k = round.inertia, v = v0 / (1 + k), t = (v0 - v) / (friction * g);
    const double d = (v0 * v0 - v * v) / (2 * friction * g);
    constexpr Bounds bounds{5e-3, 1e-5};
    const std::string what = fmt::format("{}D, {}: ", D, round.name);
    results.push_back(relative(what + "time until it rolls (s)", t, time, bounds));
    results.push_back(relative(what + "way until it rolls (m)", d, way, bounds));
    run_until(world, 1);
    results.push_back(relative(what + "speed at 1 s (m/s)", v, speed(), bounds));
    results.push_back(relative(what + "place at 1 s (m)", d + v * (1 - t), world.position(id).x, bounds));
    run_until(world, 10);
    results.push_back(relative(what + "speed at 10 s (m/s)", v, speed(), bounds));
    results.push_back(absolute(what + "slip at 10 s (m/s)", 0, slip(), bounds));
}

/// A body that rolls down a slope of 20° from rest.
template <int D>
void add_roll_down(std::vector<Result>& results, const Round<D>& round, double acceleration, double needed) {
    constexpr double slope = 20 * degree;
    constexpr Bounds bounds{5e-3, 1e-4};
    for (const double friction : {0.6, 1.01 * needed, 0.9 * needed}) {
        World<D> world;
        const BodyId<D> id = add_round(world, round, friction, slope, 0);
        const Vec<D> start = world.position(id), down = in_plane<D>(std::cos(slope), -std::sin(slope));
        run_until(world, 2);
        const bool slips = friction < needed;
        const double truth = slips ? g * (std::sin(slope) - friction * std::cos(slope)) : acceleration;
        const std::string what = fmt::format("{}D, {}, friction {:.4f}{}: acceleration from ", D, round.name,
                                             friction, slips ? " (slips)" : "");
        results.push_back(
            relative(what + "way at 2 s (m/s²)", truth, dot(world.position(id) - start, down) / 2, bounds));
        results.push_back(
            relative(what + "speed at 2 s (m/s²)", truth, dot(world.velocity(id), down) / 2, bounds));
    }
}

constexpr Round<2> disk_2{"disk", 0.5}, hoop_2{"hoop", 1};
constexpr Round<3> sphere_3{"sphere", 0.4}, disk_3{"disk", 0.5}, hoop_3{"hoop", 1};

}  // namespace

std::vector<Result> slip_to_roll() {
    std::vector<Result> results;
    add_slip_to_roll(results, disk_2);
    add_slip_to_roll(results, hoop_2);
    add_slip_to_roll(results, sphere_3);
    add_slip_to_roll(results, disk_3);
    add_slip_to_roll(results, hoop_3);
    return results;
}

std::vector<Result> roll_down() {
    const double hoop_needs = std::tan(20 * degree) / 2;
    std::vector<Result> results;
    add_roll_down(results, disk_2, 2.236811737, 0.121323411);
    add_roll_down(results, hoop_2, 1.677608803, hoop_needs);
    add_roll_down(results, sphere_3, 2.396584004, 0.103991496);
    add_roll_down(results, disk_3, 2.236811737, 0.121323411);
    add_roll_down(results, hoop_3, 1.677608803, hoop_needs);
    return results;
}

}  // namespace carom::app
