#include <fmt/format.h>

#include <array>
#include <cmath>

#include "validate/figure.hpp"
#include "validate/setup.hpp"

// Figures of joints, springs and water.

namespace carom::app {
namespace {

/// A step of the classical Runge–Kutta method.
template <std::size_t N, class Rate>
std::array<double, N> rk4(const std::array<double, N>& y, double h, const Rate& rate) {
    const auto plus = [&](double s, const std::array<double, N>& k) {
        std::array<double, N> sum = y;
        for (std::size_t i = 0; i < N; ++i) sum[i] += s * k[i];
        return sum;
    };
    const auto a = rate(y), b = rate(plus(h / 2, a)), c = rate(plus(h / 2, b)), d = rate(plus(h, c));
    std::array<double, N> next = y;
    for (std::size_t i = 0; i < N; ++i) next[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    return next;
}

BodyId2 add_bob(World2& world, const Vec2& position, std::optional<BodyId2> pivot) {
    BodyDefinition2 bob;
    bob.mass = 1;
    bob.position = position;
    bob.shapes.push_back({Ball{0.05}});
    const BodyId2 id = world.add_body(bob);
    DistanceJoint<2> rod;
    if (!pivot) rod.anchor_a = Vec2{};
    JointDefinition2 joint;
    joint.kind = rod;
    joint.a = pivot;
    joint.b = id;
    world.add_joint(joint);
    return id;
}

template <int D>
World<D> weightless() {
    WorldDefinition<D> definition;
    definition.gravity = {};
    return World<D>(definition);
}

template <int D>
World<D> restless(int substeps) {
    WorldDefinition<D> definition;
    definition.substeps = substeps;
    definition.sleep = false;
    return World<D>(definition);
}

}  // namespace

std::vector<Figure> pendulum_figures() {
    Figure angle{"A pendulum of 1 m, let go at 90°, h = 1/60 s", "t (s)", "angle (rad)"};
    Figure error{"The same: error of the angle after 2 s against the sub-step", "h (s)", "rad"};
    error.log_x = error.log_y = true;
    const auto rate = [](const std::array<double, 2>& y) {
        return std::array<double, 2>{y[1], -g * std::sin(y[0])};
    };
    constexpr int fine_steps = 1000;  // a second
    std::array<double, 2> truth{pi / 2, 0};
    Series& exact = angle.series.emplace_back(Series{"RK4, h = 1 ms", Series::Style::reference});
    double after_two = 0;
    for (int i = 0; i <= 10 * fine_steps; ++i) {
        if (i % 20 == 0) exact.points.emplace_back(double(i) / fine_steps, truth[0]);
        if (i == 2 * fine_steps) after_two = truth[0];
        truth = rk4(truth, 1.0 / fine_steps, rate);
    }
    Series errors{""};
    for (const int substeps : {4, 8, 16, 32}) {
        World2 world = restless<2>(substeps);
        const BodyId2 bob = add_bob(world, {1, 0}, {});
        const auto now = [&] { return std::atan2(world.position(bob).x, -world.position(bob).y); };
        Series series{"Carom, 4 sub-steps", Series::Style::dots};
        for (int i = 0; i <= 600; ++i) {
            if (i % 3 == 0) series.points.emplace_back(world.time(), now());
            if (i == 120) errors.points.emplace_back(frame / substeps, std::fabs(now() - after_two));
            world.step(frame);
        }
        if (substeps == 4) angle.series.push_back(std::move(series));
    }
    errors.name = fmt::format("Carom, order {:.2f}", measured_order(errors));
    error.series.push_back(std::move(errors));
    return {angle, error};
}

std::vector<Figure> double_pendulum_figures() {
    Figure figure{"A double pendulum, both at 90° at the start: the lower angle", "t (s)", "angle (rad)"};
    // Equal masses and rods of 1 m, by Lagrange's equations.
    const auto rate = [](const std::array<double, 4>& y) {
        const double c = std::cos(y[0] - y[1]), s = std::sin(y[0] - y[1]);
        const double p = -s * y[3] * y[3] - 2 * g * std::sin(y[0]), q = s * y[2] * y[2] - g * std::sin(y[1]);
        const double det = 2 - c * c;
        return std::array<double, 4>{y[2], y[3], (p - c * q) / det, (2 * q - c * p) / det};
    };
    std::array<double, 4> truth{pi / 2, pi / 2, 0, 0};
    Series& exact = figure.series.emplace_back(Series{"RK4, h = 0.2 ms", Series::Style::reference});
    for (int i = 0; i <= 5 * 5000; ++i) {
        if (i % 100 == 0) exact.points.emplace_back(i / 5000.0, std::remainder(truth[1], 2 * pi));
        truth = rk4(truth, 1.0 / 5000, rate);
    }
    for (const int substeps : {4, 16}) {
        World2 world = restless<2>(substeps);
        const BodyId2 upper = add_bob(world, {1, 0}, {}), lower = add_bob(world, {2, 0}, upper);
        Series& series = figure.series.emplace_back(Series{fmt::format("Carom, {} sub-steps", substeps)});
        for (int i = 0; i <= 300; ++i) {
            const Vec2 rod = world.position(lower) - world.position(upper);
            series.points.emplace_back(world.time(), std::atan2(rod.x, -rod.y));
            world.step(frame);
        }
    }
    return {figure};
}

std::vector<Figure> machine_figures() {
    constexpr double omega = 10;
    Figure figure{"1 kg on a spring of 100 N/m and a damper", "t (s)", "x (m)"};
    for (const double ratio : {0.05, 0.2, 0.5}) {
        const double damped = omega * std::sqrt(1 - ratio * ratio);
        figure.series.push_back(reference(ratio == 0.05 ? "exact" : "", 0, 1.5, [&](double t) {
            return std::exp(-ratio * omega * t) *
                   (std::cos(damped * t) + ratio * omega / damped * std::sin(damped * t));
        }));
        World2 world = weightless<2>();
        BodyDefinition2 body;
        body.mass = 1;
        body.position = {1, 0};
        body.shapes.push_back({Ball{0.1}});
        JointDefinition2 joint;
        joint.b = world.add_body(body);
        const JointSpring spring{.frequency = omega / (2 * pi), .damping_ratio = ratio, .rest = -1};
        joint.kind = SliderJoint<2>{.anchor = {1, 0}, .spring = spring};
        world.add_joint(joint);
        Series& series =
            figure.series.emplace_back(Series{fmt::format("damping ratio {}", ratio), Series::Style::dots});
        for (int i = 0; i <= 90; ++i) {
            series.points.emplace_back(world.time(), world.position(joint.b).x);
            world.step(frame);
        }
    }
    return {figure};
}

std::vector<Figure> buoyancy_figures() {
    constexpr double draft = 0.5, start = 0.1;
    Figure figure{"A cube of relative density 0.5 bobs", "t (s)", "height above rest (m)"};
    figure.series.push_back(reference("cos √(g/draft) t", 0, 6,
                                      [&](double t) { return start * std::cos(std::sqrt(g / draft) * t); }));
    World3 world = restless<3>(4);
    world.add_force({Buoyancy<3>{}});
    BodyDefinition3 cube;
    cube.shapes.push_back({Box<3>{{1, 1, 1}}});
    cube.shapes.back().material.density = 1000 * draft;
    cube.locks.rx = cube.locks.ry = cube.locks.rz = true;
    cube.position.y = 0.5 - draft + start;
    const BodyId3 id = world.add_body(cube);
    Series& series = figure.series.emplace_back(Series{"Carom", Series::Style::dots});
    for (int i = 0; i <= 360; ++i) {
        if (i % 3 == 0) series.points.emplace_back(world.time(), world.position(id).y - (0.5 - draft));
        world.step(frame);
    }
    return {figure};
}

}  // namespace carom::app
