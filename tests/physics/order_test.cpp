#include <gtest/gtest.h>

#include <cmath>

#include "carom/world.hpp"

// The order of each integrator: how the error falls from h to h/2 and h/4. The oscillator is looked at after
// 10 s, which is no multiple of its period: at whole periods semi-implicit Euler would seem second order.

namespace {

using namespace carom;

/// Error in place and velocity at 10 s of a mass of 1 kg on a spring of 1 N/m, let go at x = 1.
template <int D>
double error_of_oscillator(Integrator integrator, int steps) {
    WorldDefinition<D> definition;
    definition.gravity = {};
    definition.integrator = integrator;
    World<D> world(definition);
    BodyDefinition<D> bob;
    bob.mass = 1;
    bob.shapes.push_back({Ball{0.1}});
    bob.position.x = 1;
    Spring<D> spring;
    spring.b = world.add_body(bob);
    spring.stiffness = 1;
    spring.length = 0;
    world.add_force({spring});
    for (int i = 0; i < steps; ++i) world.step(10.0 / steps);
    return std::hypot(world.position(spring.b).x - std::cos(10), world.velocity(spring.b).x + std::sin(10));
}

template <int D>
void expect_order(Integrator integrator, double order) {
    const double errors[] = {error_of_oscillator<D>(integrator, 500),
                             error_of_oscillator<D>(integrator, 1000),
                             error_of_oscillator<D>(integrator, 2000)};
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.15);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), order, 0.15);
}

TEST(Order, SemiImplicitEulerIsFirst) {
    expect_order<2>(Integrator::semi_implicit_euler, 1);
    expect_order<3>(Integrator::semi_implicit_euler, 1);
}
TEST(Order, ExplicitEulerIsFirst) {
    expect_order<2>(Integrator::explicit_euler, 1);
    expect_order<3>(Integrator::explicit_euler, 1);
}
TEST(Order, VerletIsSecond) {
    expect_order<2>(Integrator::verlet, 2);
    expect_order<3>(Integrator::verlet, 2);
}
TEST(Order, Rk4IsFourth) {
    expect_order<2>(Integrator::rk4, 4);
    expect_order<3>(Integrator::rk4, 4);
}

}  // namespace
