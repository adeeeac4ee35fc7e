#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

struct Stop {
    double distance;  ///< from the start, m
    double aside;     ///< distance from the line of the first velocity, m
};

/// A cube of 1 m slides at 5 m/s on a level floor until it stops. In space `direction` is the angle between
/// its way and its faces. A cube that is `upright` cannot turn: what is left then is friction alone, without
/// the rocking that brakes and stops make.
template <int D>
Stop slide(double friction, double direction, bool upright = false) {
    Material material;
    material.friction = friction;
    World<D> world;
    add_floor(world, material);
    BodyDefinition<D> cube;
    Vec<D> size{}, along{};
    for (int i = 0; i < D; ++i) size[i] = 1;
    along.x = std::cos(direction);
    if constexpr (D == 3) along.z = std::sin(direction);
    cube.shapes.push_back({Box<D>{size}});
    cube.shapes.back().material = material;
    cube.position = in_plane<D>(0, 0.5);
    cube.velocity = 5.0 * along;
    if (upright) cube.locks = {.rx = true, .ry = true, .rz = true};
    const BodyId<D> id = world.add_body(cube);
    const double stopping_time = 5 / (friction * g);
    run_until(world, stopping_time + 1);
    const Vec<D> way = world.position(id) - cube.position;
    const double ahead = dot(way, along);
    return {ahead, length(way - ahead * along - in_plane<D>(0, way.y))};
}

constexpr Bounds bounds{5e-3, 1e-4};

struct Known {
    double friction, distance;
};

void add_plane_slides(std::vector<Result>& results, const Known& known) {
    for (const int sign : {1, -1}) {
        const Stop stop = slide<2>(known.friction, sign > 0 ? 0 : pi);
        results.push_back(relative(fmt::format("2D, friction {}, {}: way (m)", known.friction,
                                               sign > 0 ? "to the right" : "to the left"),
                                   known.distance, stop.distance, bounds));
    }
}

/// Every 15°, all around.
void add_space_slides(std::vector<Result>& results, const Known& known, bool upright) {
    double worst = known.distance, least = 1e9, most = 0, aside = 0;
    for (int i = 0; i < 24; ++i) {
        const Stop stop = slide<3>(known.friction, 15 * i * degree, upright);
        if (std::fabs(stop.distance - known.distance) > std::fabs(worst - known.distance))
            worst = stop.distance;
        least = std::min(least, stop.distance);
        most = std::max(most, stop.distance);
        aside = std::max(aside, stop.aside);
    }
    const std::string what =
        fmt::format("3D, friction {}, {}every 15°: ", known.friction, upright ? "upright, " : "");
    results.push_back(relative(what + "way, worst (m)", known.distance, worst, bounds));
    results.push_back(
        absolute(what + "spread of the way, relative", 0, (most - least) / known.distance, {5e-3, 1e-6}));
    results.push_back(absolute(what + "way aside, relative", 0, aside / known.distance, {5e-3, 1e-6}));
}

}  // namespace

std::vector<Result> slide_to_rest() {
    constexpr Known all[] = {
        {0.1, 12.742100}, {0.2, 6.371050}, {0.3, 4.247367}, {0.5, 2.548420}, {0.8, 1.592762}};
    std::vector<Result> results;
    for (const Known& known : all) add_plane_slides(results, known);
    for (const Known& known : all) {
        add_space_slides(results, known, true);
        add_space_slides(results, known, false);
    }
    return results;
}

}  // namespace carom::app
