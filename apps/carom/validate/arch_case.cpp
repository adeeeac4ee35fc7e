#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// A semicircular arch of stones without mortar. It stands as long as a line of thrust fits into it: down to a
// thickness of 0.1075 of its mean radius (M. Milankovitch 1907).

namespace carom::app {
namespace {

constexpr double radius = 5;
constexpr int stones = 16;

/// Which corner of a stone lies where: in 3D stones are 1 m deep.
template <int D>
Hull<D> stone(double from, double to, double thickness) {
    Hull<D> hull;
    for (const double angle : {from, to})
        for (const double r : {radius - 0.5 * thickness, radius + 0.5 * thickness}) {
            const Vec<D> corner = in_plane<D>(r * std::cos(angle), r * std::sin(angle));
            if constexpr (D == 2) {
                hull.points.push_back(corner);
            } else {
                hull.points.push_back(corner + Vec3{0, 0, 0.5});
                hull.points.push_back(corner - Vec3{0, 0, 0.5});
            }
        }
    return hull;
}

/// How far the top of the arch has come down after five and after ten seconds, as a share of the radius.
struct Sinking {
    double settled, later;
};

template <int D>
Sinking sinks_by(double thickness) {
    Material rough;
    rough.friction = 0.8;
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    add_floor(world, rough);
    BodyId<D> top{};
    for (int i = 0; i < stones; ++i) {
        BodyDefinition<D> body;
        body.shapes.push_back({stone<D>(pi * i / stones, pi * (i + 1) / stones, thickness)});
        body.shapes.back().material = rough;
        const BodyId<D> id = world.add_body(body);
        if (i == stones / 2) top = id;
    }
    const double start = world.center_of_mass(top).y;
    const auto sunk = [&] { return (start - world.center_of_mass(top).y) / radius; };
    run_until(world, 5);
    const double settled = sunk();
    run_until(world, 10);
    return {settled, sunk()};
}

template <int D>
void add_arch(std::vector<Result>& results) {
    const std::string what = fmt::format("{}D, thickness ", D);
    for (const double share : {0.2, 0.14}) {
        const Sinking stands = sinks_by<D>(share * radius);
        results.push_back(absolute(fmt::format("{}{} of the radius: settles by, of the radius", what, share),
                                   0, stands.settled, {1e-2, 1e-3}));
        results.push_back(absolute(fmt::format("{}{} of the radius: and in 5 s more", what, share), 0,
                                   stands.later - stands.settled, {1e-3, 1e-5}));
    }
    results.push_back(absolute(what + "0.08 of the radius: falls (1: yes)", 1,
                               sinks_by<D>(0.08 * radius).later > 0.5 ? 1 : 0, {0, 0}));
}

}  // namespace

std::vector<Result> masonry_arch() {
    std::vector<Result> results;
    add_arch<2>(results);
    add_arch<3>(results);
    return results;
}

}  // namespace carom::app
