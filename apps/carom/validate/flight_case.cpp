#include <fmt/format.h>

#include <string_view>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

struct Method {
    std::string_view name;
    Integrator integrator;
    double bound;  ///< of its error in height, as a share of g h t
    std::optional<double> gold;
};

/// How far from its true place (10 m, 5.095 m) a ball is a second after it was thrown from the origin.
template <int D>
Result throw_ball(const Method& method, int steps) {
    WorldDefinition<D> definition;
    definition.integrator = method.integrator;
    World<D> world(definition);
    BodyDefinition<D> ball;
    ball.shapes.push_back({Ball{0.5}});
    ball.velocity = in_plane<D>(10, 10);
    const BodyId<D> id = world.add_body(ball);
    for (int i = 0; i < steps; ++i) world.step(1.0 / steps);

    const Vec<D> truth = in_plane<D>(10, 10 - 0.5 * g), place = world.position(id);
    return {fmt::format("{}D, {}, h = 1/{}: height at 1 s (m)", D, method.name, steps),
            truth.y,
            place.y,
            length(place - truth),
            {method.bound * g / steps + 1e-6, method.gold}};
}

}  // namespace

std::vector<Result> projectile() {
    // By default a body that nothing constrains moves exactly; explicit Euler errs by + g h t / 2.
    constexpr double round_off = 1e-12;
    constexpr Method methods[] = {{"default world", Integrator::semi_implicit_euler, 0.5, round_off},
                                  {"explicit Euler", Integrator::explicit_euler, 0.5, {}},
                                  {"Verlet", Integrator::verlet, 0, round_off},
                                  {"RK4", Integrator::rk4, 0, round_off}};
    std::vector<Result> results;
    for (const Method& method : methods)
        for (const int steps : {60, 240}) {
            results.push_back(throw_ball<2>(method, steps));
            results.push_back(throw_ball<3>(method, steps));
        }
    return results;
}

}  // namespace carom::app
