#include <fmt/format.h>

#include "carom/world.hpp"
#include "validate/cases.hpp"

namespace carom::app {
namespace {

constexpr double g = 9.81;

/// Height after a second of a ball thrown up at 10 m/s from the origin.
template <int D>
double height_of_throw(Integrator integrator, int steps) {
    WorldDefinition<D> definition;
    definition.integrator = integrator;
    World<D> world(definition);
    BodyDefinition<D> ball;
    ball.shapes.push_back({Ball{0.5}});
    ball.velocity.x = 10;
    ball.velocity.y = 10;
    const BodyId<D> id = world.add_body(ball);
    for (int i = 0; i < steps; ++i) world.step(1.0 / steps);
    return world.position(id).y;
}

}  // namespace

std::vector<Result> projectile() {
    struct Method {
        std::string_view name;
        Integrator integrator;
        double first_order;  ///< of the method's own error, as a share of g h t
    };
    // By default a body that nothing constrains moves exactly; the others err as the books say.
    constexpr Method methods[] = {{"default", Integrator::semi_implicit_euler, 0.5},
                                  {"explicit Euler", Integrator::explicit_euler, 0.5},
                                  {"Verlet", Integrator::verlet, 0},
                                  {"RK4", Integrator::rk4, 0}};
    constexpr double reference = 10 - g / 2;
    std::vector<Result> results;
    for (const Method& method : methods)
        for (const int steps : {60, 240}) {
            const Bounds bounds{method.first_order * g / steps + 1e-6, 1e-12};
            const auto add = [&](int dimension, double height) {
                results.push_back(
                    absolute(fmt::format("height at 1 s, {}, h = 1/{}, {}D", method.name, steps, dimension),
                             reference, height, bounds));
            };
            add(2, height_of_throw<2>(method.integrator, steps));
            add(3, height_of_throw<3>(method.integrator, steps));
        }
    return results;
}

}  // namespace carom::app
