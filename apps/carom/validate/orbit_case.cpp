#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

/// The largest share of energy and of angular momentum that an orbit gained or lost.
struct Drift {
    double energy = 0, momentum = 0;
};

/// A hundred rounds of an ellipse of eccentricity 0.6 and half axis 1 about a centre with GM = 1, from the
/// nearest point on; the period is 2π.
template <int D>
Drift orbit(Integrator integrator, int steps_a_round) {
    WorldDefinition<D> definition;
    definition.gravity = {};
    definition.integrator = integrator;
    World<D> world(definition);
    world.add_force({PointGravity<D>{{}, 1}});
    BodyDefinition<D> planet;
    planet.mass = 1;
    planet.shapes.push_back({Ball{0.01}});
    planet.position = in_plane<D>(0.4, 0);
    planet.velocity = in_plane<D>(0, 2);
    const BodyId<D> id = world.add_body(planet);

    const auto momentum = [&] { return spin_of(cross(world.position(id), world.velocity(id))); };
    const double energy = world.energy().total(), moment = momentum();
    Drift drift;
    for (int i = 0; i < 100 * steps_a_round; ++i) {
        world.step(2 * pi / steps_a_round);
        drift.energy = std::max(drift.energy, std::fabs(world.energy().total() / energy - 1));
        drift.momentum = std::max(drift.momentum, std::fabs(momentum() / moment - 1));
    }
    return drift;
}

/// Largest relative error of the energy that each method makes by its nature.
struct Method {
    std::string_view name;
    Integrator integrator;
    double energy_200, energy_1000;
    bool keeps_momentum;
};

template <int D>
void add_orbits(std::vector<Result>& results, const Method& method) {
    for (const int steps : {200, 1000}) {
        const Drift drift = orbit<D>(method.integrator, steps);
        const std::string what = fmt::format("{}D, {}, {} steps a round", D, method.name, steps);
        results.push_back(relative(what + ": max |ΔE/E|",
                                   steps == 200 ? method.energy_200 : method.energy_1000, drift.energy,
                                   {1e-2, 1e-3}));
        if (method.keeps_momentum)
            results.push_back(absolute(what + ": max |ΔL/L|", 0, drift.momentum, {1e-12, 1e-13}));
    }
}

}  // namespace

std::vector<Result> kepler_orbit() {
    // The table of the methods' errors, by an independent program; its digits agree with the published ones.
    constexpr Method methods[] = {
        {"explicit Euler", Integrator::explicit_euler, 1.09967, 0.993283, false},
        {"semi-implicit Euler", Integrator::semi_implicit_euler, 0.106886, 0.0178422, true},
        {"Verlet", Integrator::verlet, 7.35200e-3, 2.92583e-4, true},
        {"RK4", Integrator::rk4, 6.71457e-4, 2.22029e-7, false}};
    std::vector<Result> results;
    for (const Method& method : methods) {
        add_orbits<2>(results, method);
        add_orbits<3>(results, method);
    }
    return results;
}

}  // namespace carom::app
