#include <fmt/format.h>

#include <string_view>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

/// |(x, v) − (cos 10, −sin 10)| after ten seconds of a mass of 1 kg on a spring of 1 N/m, let go at x = 1.
template <int D>
double error_of_oscillator(Integrator integrator, int steps) {
    WorldDefinition<D> definition;
    definition.gravity = {};
    definition.integrator = integrator;
    World<D> world(definition);
    BodyDefinition<D> bob;
    bob.mass = 1;
    bob.shapes.push_back({Ball{0.1}});
    bob.position = in_plane<D>(1, 0);
    Spring<D> spring;
    spring.b = world.add_body(bob);
    spring.stiffness = 1;
    spring.length = 0;
    world.add_force({spring});
    for (int i = 0; i < steps; ++i) world.step(10.0 / steps);
    return std::hypot(length(world.position(spring.b) - in_plane<D>(std::cos(10), 0)),
                      length(world.velocity(spring.b) - in_plane<D>(-std::sin(10), 0)));
}

struct Method {
    std::string_view name;
    Integrator integrator;
    double errors[4];  ///< that it makes by its nature with 500, 1000, 2000 and 4000 steps
};

template <int D>
void add_oscillator(std::vector<Result>& results, const Method& method) {
    for (int i = 0; i < 4; ++i) {
        const int steps = 500 << i;
        results.push_back(relative(fmt::format("{}D, {}, {} steps: error at 10 s", D, method.name, steps),
                                   method.errors[i], error_of_oscillator<D>(method.integrator, steps),
                                   {1e-2, 1e-3}));
    }
}

}  // namespace

std::vector<Result> oscillator() {
    constexpr Method methods[] = {
        {"semi-implicit Euler", Integrator::semi_implicit_euler, {5.535e-3, 2.743e-3, 1.366e-3, 6.815e-4}},
        {"Verlet", Integrator::verlet, {1.446e-4, 3.615e-5, 9.038e-6, 2.259e-6}}};
    std::vector<Result> results;
    for (const Method& method : methods) {
        add_oscillator<2>(results, method);
        add_oscillator<3>(results, method);
    }
    return results;
}

}  // namespace carom::app
