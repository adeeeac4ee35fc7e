#include <fmt/format.h>

#include <array>
#include <cmath>

#include "validate/figure.hpp"
#include "validate/setup.hpp"

// Figures of one body in smooth motion.

namespace carom::app {

double measured_order(const Series& errors) {
    const auto& [h0, e0] = errors.points.front();
    const auto& [h1, e1] = errors.points.back();
    return std::log(e0 / e1) / std::log(h0 / h1);
}

namespace {

struct Method {
    const char* name;
    Integrator integrator;
};
constexpr Method methods[] = {{"semi-implicit Euler", Integrator::semi_implicit_euler},
                              {"Verlet", Integrator::verlet},
                              {"RK4", Integrator::rk4}};

/// A planet of the case, at one of the methods.
World2 orbit_of(Integrator integrator, BodyId2& planet) {
    WorldDefinition2 definition;
    definition.gravity = {};
    definition.integrator = integrator;
    World2 world(definition);
    world.add_force({PointGravity<2>{{}, 1}});
    BodyDefinition2 body;
    body.mass = 1;
    body.shapes.push_back({Ball{0.01}});
    body.position = {0.4, 0};
    body.velocity = {0, 2};
    planet = world.add_body(body);
    return world;
}

}  // namespace

std::vector<Figure> projectile_figures() {
    constexpr double h = 0.1;
    Figure figure{"A ball thrown at (10, 10) m/s, h = 1/10 s", "x (m)", "y (m)"};
    figure.series.push_back(
        reference("x = v t + ½ g t²", 0, 10, [](double x) { return x - 0.5 * g * x * x / 100; }));
    constexpr Method thrown[] = {{"default world", Integrator::semi_implicit_euler},
                                 {"explicit Euler", Integrator::explicit_euler}};
    for (const Method& method : thrown) {
        WorldDefinition2 definition;
        definition.integrator = method.integrator;
        World2 world(definition);
        BodyDefinition2 ball;
        ball.shapes.push_back({Ball{0.5}});
        ball.velocity = {10, 10};
        const BodyId2 id = world.add_body(ball);
        Series& series = figure.series.emplace_back(Series{method.name, Series::Style::dots});
        for (int i = 0; i <= 10; ++i) {
            series.points.emplace_back(world.position(id).x, world.position(id).y);
            world.step(h);
        }
    }
    return {figure};
}

std::vector<Figure> orbit_figures() {
    Figure energy{"Energy through 20 rounds, 200 steps a round", "rounds", "|ΔE/E|"};
    energy.log_y = true;
    Figure path{"Five rounds, 200 steps a round", "x (m)", "y (m)"};
    Series& ellipse = path.series.emplace_back(Series{"ellipse", Series::Style::reference});
    for (int i = 0; i <= 200; ++i) {
        const double e = 2 * pi * i / 200;
        ellipse.points.emplace_back(std::cos(e) - 0.6, 0.8 * std::sin(e));
    }
    for (const Method& method : methods) {
        BodyId2 planet;
        World2 world = orbit_of(method.integrator, planet);
        const double start = world.energy().total();
        Series& drift = energy.series.emplace_back(Series{method.name});
        Series way{method.name};
        for (int i = 1; i <= 20 * 200; ++i) {
            world.step(2 * pi / 200);
            if (i % 4 == 0)
                drift.points.emplace_back(i / 200.0,
                                          std::max(1e-9, std::fabs(world.energy().total() / start - 1)));
            if (i <= 5 * 200) way.points.emplace_back(world.position(planet).x, world.position(planet).y);
        }
        path.series.push_back(std::move(way));
    }
    return {energy, path};
}

std::vector<Figure> oscillator_figures() {
    Figure figure{"Error at 10 s against the step", "h (s)", "|Δ(x, v)|"};
    figure.log_x = figure.log_y = true;
    for (const Method& method : methods) {
        Series series{method.name};
        for (const int steps : {100, 250, 500, 1000, 2000, 4000}) {
            WorldDefinition2 definition;
            definition.gravity = {};
            definition.integrator = method.integrator;
            World2 world(definition);
            BodyDefinition2 bob;
            bob.mass = 1;
            bob.shapes.push_back({Ball{0.1}});
            bob.position = {1, 0};
            Spring<2> spring;
            spring.b = world.add_body(bob);
            spring.stiffness = 1;
            spring.length = 0;
            world.add_force({spring});
            for (int i = 0; i < steps; ++i) world.step(10.0 / steps);
            const Vec2 x = world.position(spring.b) - Vec2{std::cos(10), 0};
            const Vec2 v = world.velocity(spring.b) + Vec2{std::sin(10), 0};
            series.points.emplace_back(10.0 / steps, std::hypot(length(x), length(v)));
        }
        series.name += fmt::format(", order {:.2f}", measured_order(series));
        figure.series.push_back(std::move(series));
    }
    return {figure};
}

std::vector<Figure> racket_figures() {
    using Spin = std::array<double, 3>;
    constexpr double end = 45;
    Figure figure{"I = (1, 2, 3), ω = (0.01, 1, 0): spin about the middle axis", "t (s)", "ω₂ (rad/s)"};
    // Euler's equations by RK4 with steps of 1 ms.
    const auto rate = [](const Spin& w) {
        return Spin{(2.0 - 3) / 1 * w[1] * w[2], (3.0 - 1) / 2 * w[2] * w[0], (1.0 - 2) / 3 * w[0] * w[1]};
    };
    const auto plus = [](const Spin& w, double h, const Spin& k) {
        return Spin{w[0] + h * k[0], w[1] + h * k[1], w[2] + h * k[2]};
    };
    Series& truth = figure.series.emplace_back(Series{"Euler's equations", Series::Style::reference});
    Spin w{0.01, 1, 0};
    for (int i = 0; i <= 1000 * end; ++i) {
        if (i % 100 == 0) truth.points.emplace_back(i / 1000.0, w[1]);
        constexpr double h = 1e-3;
        const Spin a = rate(w), b = rate(plus(w, h / 2, a)), c = rate(plus(w, h / 2, b)),
                   d = rate(plus(w, h, c));
        for (std::size_t k = 0; k < 3; ++k) w[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    World3 world;
    world.set_gravity({});
    BodyDefinition3 body;
    body.mass = 1;
    body.inertia = Symmetric3<double>{1, 2, 3};
    body.shapes.push_back({Box<3>{{1, 1, 1}}});
    body.angular_velocity = {0.01, 1, 0};
    const BodyId3 id = world.add_body(body);
    Series& carom = figure.series.emplace_back(Series{"Carom, h = 1/60 s"});
    while (world.time() < end) {
        carom.points.emplace_back(world.time(), unrotate(world.rotation(id), world.angular_velocity(id)).y);
        world.step(frame);
    }
    return {figure};
}

}  // namespace carom::app
