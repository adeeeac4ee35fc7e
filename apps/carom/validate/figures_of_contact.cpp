#include <fmt/format.h>

#include <cmath>

#include "validate/figure.hpp"
#include "validate/setup.hpp"

// Figures of contact, friction and impact.

namespace carom::app {
namespace {

Material rough(double friction) {
    Material material;
    material.friction = friction;
    return material;
}

}  // namespace

std::vector<Figure> incline_figures() {
    Figure figure{"A cube on a slope of 30°", "t (s)", "way (m)"};
    constexpr double slope = 30 * degree;
    for (const double friction : {0.0, 0.2, 0.4}) {
        const double a = g * (std::sin(slope) - friction * std::cos(slope));
        figure.series.push_back(
            reference(friction == 0 ? "½ a t²" : "", 0, 2, [&](double t) { return 0.5 * a * t * t; }));
        World3 world;
        add_floor(world, rough(friction), slope);
        BodyDefinition3 cube;
        cube.shapes.push_back({Box<3>{{1, 1, 1}}});
        cube.shapes.back().material = rough(friction);
        cube.rotation = turned<3>(-slope);
        cube.position = rotate(cube.rotation, {0, 0.5, 0});
        const BodyId3 id = world.add_body(cube);
        Series& series = figure.series.emplace_back(Series{fmt::format("μ = {}", friction)});
        for (int i = 0; i <= 120; ++i) {
            series.points.emplace_back(world.time(), length(world.position(id) - cube.position));
            world.step(frame);
        }
    }
    return {figure};
}

std::vector<Figure> slide_figures() {
    Figure figure{"A cube slides at 5 m/s until it stops", "t (s)", "speed (m/s)"};
    for (const double friction : {0.2, 0.5}) {
        figure.series.push_back(reference(friction == 0.2 ? "v − μ g t" : "", 0, 3,
                                          [&](double t) { return std::max(0.0, 5 - friction * g * t); }));
        World3 world;
        add_floor(world, rough(friction));
        BodyDefinition3 cube;
        cube.shapes.push_back({Box<3>{{1, 1, 1}}});
        cube.shapes.back().material = rough(friction);
        cube.position = {0, 0.5, 0};
        cube.velocity = {5, 0, 0};
        const BodyId3 id = world.add_body(cube);
        Series& series = figure.series.emplace_back(Series{fmt::format("μ = {}", friction)});
        for (int i = 0; i <= 180; ++i) {
            series.points.emplace_back(world.time(), world.velocity(id).x);
            world.step(frame);
        }
    }
    return {figure};
}

std::vector<Figure> roll_figures() {
    constexpr double radius = 0.5, friction = 0.2, start = 3;
    const double rolls_at = 2 * start / (7 * friction * g);
    Figure figure{"A ball slides without spin until it rolls, μ = 0.2", "t (s)", "speed (m/s)"};
    figure.series.push_back(reference("of the centre: v − μ g t, then 5/7 v", 0, 0.8, [&](double t) {
        return start - friction * g * std::min(t, rolls_at);
    }));
    figure.series.push_back(reference("of the surface: 5/2 μ g t, then the same", 0, 0.8,
                                      [&](double t) { return 2.5 * friction * g * std::min(t, rolls_at); }));
    World3 world;
    add_floor(world, rough(friction));
    BodyDefinition3 ball;
    ball.shapes.push_back({Ball{radius}});
    ball.shapes.back().material = rough(friction);
    ball.position = {0, radius, 0};
    ball.velocity = {start, 0, 0};
    const BodyId3 id = world.add_body(ball);
    Series centre{"v", Series::Style::dots}, surface{"−ω r", Series::Style::dots};
    for (int i = 0; i <= 48; ++i) {
        centre.points.emplace_back(world.time(), world.velocity(id).x);
        surface.points.emplace_back(world.time(), -radius * world.angular_velocity(id).z);
        world.step(frame);
    }
    figure.series.push_back(std::move(centre));
    figure.series.push_back(std::move(surface));
    return {figure};
}

std::vector<Figure> bounce_figures() {
    constexpr double e = 0.8, drop = 1, radius = 0.5;
    Figure figure{"A ball falls by 1 m, restitution 0.8, h = 1/60 s", "t (s)", "height (m)"};
    const double first = std::sqrt(2 * drop / g);
    figure.series.push_back(reference("exact", 0, 3.5, [&](double t) {
        if (t < first) return drop - 0.5 * g * t * t;
        double speed = e * g * first;
        for (t -= first; t > 2 * speed / g && speed > 1e-3; speed *= e) t -= 2 * speed / g;
        return std::max(0.0, speed * t - 0.5 * g * t * t);
    }));
    WorldDefinition3 definition;
    definition.restitution_threshold = 0;
    World3 world(definition);
    Material elastic;
    elastic.restitution = e;
    add_floor(world, elastic);
    BodyDefinition3 ball;
    ball.shapes.push_back({Ball{radius}});
    ball.shapes.back().material = elastic;
    ball.position = {0, radius + drop, 0};
    const BodyId3 id = world.add_body(ball);
    Series& series = figure.series.emplace_back(Series{"Carom", Series::Style::dots});
    for (int i = 0; i <= 210; ++i) {
        series.points.emplace_back(world.time(), world.position(id).y - radius);
        world.step(frame);
    }
    return {figure};
}

std::vector<Figure> cradle_figures() {
    Figure figure{"Two of five touching balls come in, in empty space", "t (s)", "x (m)"};
    WorldDefinition3 definition;
    definition.gravity = {};
    World3 world(definition);
    std::vector<BodyId3> balls;
    Material elastic;
    elastic.restitution = 1;
    elastic.friction = 0;
    for (int i = 0; i < 5; ++i) {
        BodyDefinition3 ball;
        ball.shapes.push_back({Ball{0.5}});
        ball.shapes.back().material = elastic;
        ball.position = {i < 2 ? i - 2.0 : double(i), 0, 0};
        if (i < 2) ball.velocity = {4, 0, 0};
        balls.push_back(world.add_body(ball));
    }
    for (int i = 0; i < 5; ++i) {
        // The two in front go on with what the two behind brought; the one between does not move.
        figure.series.push_back(reference(i == 0 ? "exact" : "", 0, 1, [&](double t) {
            const double start = i < 2 ? i - 2.0 : i, blow = 0.5;
            const double moves = i < 2 ? std::min(t, blow) : i > 2 ? std::max(0.0, t - blow) : 0;
            return start + 4 * moves;
        }));
        figure.series.push_back(Series{fmt::format("ball {}", i + 1), Series::Style::dots});
    }
    for (int step = 0; step <= 60; ++step) {
        for (std::size_t i = 0; i < 5; ++i)
            figure.series[2 * i + 1].points.emplace_back(world.time(), world.position(balls[i]).x);
        world.step(frame);
    }
    return {figure};
}

}  // namespace carom::app
