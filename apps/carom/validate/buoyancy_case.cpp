#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Bodies that float in water whose surface is y = 0.

namespace carom::app {
namespace {

constexpr Bounds bounds{1e-2, 1e-4};

template <int D>
World<D> lake(double linear_drag, double quadratic_drag = 0) {
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    Buoyancy<D> water;
    water.linear_drag = linear_drag;
    water.quadratic_drag = quadratic_drag;
    world.add_force({water});
    return world;
}

template <int D>
Box<D> cube() {
    Box<D> box;
    for (int i = 0; i < D; ++i) box.size[i] = 1;
    return box;
}

template <int D>
BodyDefinition<D> body_of(const Geometry<D>& geometry, double relative_density) {
    BodyDefinition<D> body;
    body.shapes.push_back({geometry});
    body.shapes.back().material.density = 1000 * relative_density;
    return body;
}

/// A cube that cannot turn: how deep it comes to rest with drag, and how long it takes to bob without, on the
/// mean of ten periods.
template <int D>
void add_bobbing(std::vector<Result>& results, double draft) {
    BodyDefinition<D> body = body_of<D>(cube<D>(), draft);
    body.locks.rx = body.locks.ry = body.locks.rz = true;
    World<D> still = lake<D>(3);
    const BodyId<D> sinking = still.add_body(body);
    run_until(still, 20);
    const std::string what = fmt::format("{}D, relative density {:g}: ", D, draft);
    results.push_back(relative(what + "draft (m)", draft, 0.5 - still.position(sinking).y, bounds));

    body.position.y = 0.5 - draft + 0.1;
    World<D> world = lake<D>(0);
    const BodyId<D> bobbing = world.add_body(body);
    double first = 0, last = 0;
    for (int crossings = 0; crossings < 21;) {
        const double before = world.position(bobbing).y - (0.5 - draft);
        world.step(frame);
        const double now = world.position(bobbing).y - (0.5 - draft);
        if ((before < 0) == (now < 0)) continue;
        last = world.time() - frame * now / (now - before);
        if (crossings++ == 0) first = last;
    }
    results.push_back(
        relative(what + "period (s)", 2 * pi * std::sqrt(draft / g), (last - first) / 10, bounds));
}

/// A ball that sinks at the speed at which drag carries what the water does not.
template <int D>
void add_sinking(std::vector<Result>& results) {
    World<D> world = lake<D>(0, 0.5);
    BodyDefinition<D> body = body_of<D>(Ball{0.2}, 3);
    body.position.y = -1;
    const BodyId<D> ball = world.add_body(body);
    run_until(world, 10);
    // ½ c ρ A v² = 2 ρ V g.
    const double volume_by_section = D == 2 ? pi * 0.2 / 2 : 4 * 0.2 / 3;
    results.push_back(relative(fmt::format("{}D, sinking ball: speed (m/s)", D),
                               -std::sqrt(4 * volume_by_section * g / 0.5), world.velocity(ball).y, bounds));
}

/// What half sinks stands on an edge or a corner.
void add_way_up(std::vector<Result>& results) {
    constexpr Bounds degrees{1, 1e-3};
    World2 flat = lake<2>(1);
    BodyDefinition2 square = body_of<2>(cube<2>(), 0.5);
    square.rotation = turned<2>(0.05);
    const BodyId2 tile = flat.add_body(square);
    run_until(flat, 60);
    results.push_back(absolute("2D, square: turned to (deg)", 45, flat.angle(tile) / degree, degrees));

    World3 space = lake<3>(1);
    BodyDefinition3 prism = body_of<3>(Box3{{1, 1, 4}}, 0.5);
    prism.rotation = turned<3>(0.05);
    const BodyId3 log = space.add_body(prism);
    run_until(space, 60);
    const Vec3 side = rotate(space.rotation(log), Vec3{1, 0, 0});
    results.push_back(absolute("3D, long square prism: turned to (deg)", 45,
                               std::atan2(side.y, std::hypot(side.x, side.z)) / degree, degrees));

    World3 other = lake<3>(1);
    BodyDefinition3 crate = body_of<3>(cube<3>(), 0.5);
    crate.rotation = Rotation3::from_axis_angle({1, 0.3, 0.7}, 0.1);
    const BodyId3 box = other.add_body(crate);
    run_until(other, 60);
    double most = 0;
    for (const double x : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0})
            most = std::max(most, std::fabs(rotate(other.rotation(box), Vec3{x, 1, z}).y) / std::sqrt(3.0));
    results.push_back(absolute("3D, cube: its diagonal off the vertical (deg)", 0,
                               std::acos(std::min(1.0, most)) / degree, degrees));
}

/// Without drag a box that bobs and rolls, half of it over the water, keeps its energy.
template <int D>
void add_energy(std::vector<Result>& results) {
    World<D> world = lake<D>(0);
    Box<D> box = cube<D>();
    box.size.x = 2;
    BodyDefinition<D> body = body_of<D>(box, 0.5);
    body.rotation = turned<D>(0.4);
    if constexpr (D == 3) body.rotation = Rotation3::from_axis_angle({1, 0.3, 0.7}, 0.4);
    body.position.y = 0.2;
    const BodyId<D> id = world.add_body(body);
    const double start = world.energy().total(), scale = world.mass_properties(id).mass * g;
    double most = 0;
    while (world.time() < 60) {
        world.step(frame);
        most = std::max(most, (world.energy().total() - start) / scale);
    }
    results.push_back(absolute(fmt::format("{}D, rolling box: energy gained in 60 s (m g · 1 m)", D), 0, most,
                               {1e-2, 1e-3}));
}

}  // namespace

std::vector<Result> floating_bodies() {
    std::vector<Result> results;
    for (const double draft : {0.25, 0.5, 0.75}) {
        add_bobbing<2>(results, draft);
        add_bobbing<3>(results, draft);
    }
    add_sinking<2>(results);
    add_sinking<3>(results);
    add_way_up(results);
    add_energy<2>(results);
    add_energy<3>(results);
    return results;
}

}  // namespace carom::app
