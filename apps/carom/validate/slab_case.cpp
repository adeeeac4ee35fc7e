#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// A heavy slab is pulled over a smooth floor, under balls that roll on it.

namespace carom::app {
namespace {

constexpr double radius = 0.5, ball_mass = 50, slab_mass = 1000, pull = 3000;
constexpr int side = 5;

/// Round bodies with the moment of inertia k m r² that are dragged along from below get the share k / (1 + k)
/// of the acceleration of what they roll on, so n of them weigh on it like n m k / (1 + k).
template <int D>
void add_pulled_slab(std::vector<Result>& results) {
    constexpr double k = D == 2 ? 0.5 : 0.4, share = k / (1 + k);
    constexpr int count = D == 2 ? side : side * side;
    const double acceleration = pull / (slab_mass + count * ball_mass * share);

    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    Material smooth, rough;
    smooth.friction = 0;
    add_floor(world, smooth);
    BodyDefinition<D> slab;
    Vec<D> size = in_plane<D>(14, 0.5);
    if constexpr (D == 3) size.z = 14;
    slab.shapes.push_back({Box<D>{size}});
    slab.shapes.back().material = rough;
    slab.mass = slab_mass;
    slab.position = in_plane<D>(0, 0.25);
    const BodyId<D> pulled = world.add_body(slab);
    std::vector<BodyId<D>> balls;
    for (int i = 0; i < count; ++i) {
        BodyDefinition<D> ball;
        ball.mass = ball_mass;
        ball.shapes.push_back({Ball{radius}});
        ball.shapes.back().material = rough;
        ball.position = in_plane<D>(1.5 * (i % side - 2), 0.5 + radius);
        if constexpr (D == 3) ball.position.z = 1.5 * (i / side - 2);
        balls.push_back(world.add_body(ball));
    }
    // One second to settle, one to pull.
    run_until(world, 1);
    for (int i = 0; i < 60; ++i) {
        world.apply_force(pulled, in_plane<D>(pull, 0));
        world.step(frame);
    }
    const double speed = world.velocity(pulled).x;
    double slowest = 1e9, fastest = -1e9, slip = 0;
    for (const BodyId<D> ball : balls) {
        const double its = world.velocity(ball).x;
        slowest = std::min(slowest, its);
        fastest = std::max(fastest, its);
        slip = std::max(slip, std::fabs(its + radius * spin_of(world.angular_velocity(ball)) - speed));
    }
    const std::string what = fmt::format("{}D, {} balls: ", D, count);
    const Bounds bounds{1e-2, 1e-3};
    results.push_back(relative(what + "speed of the slab (m/s)", acceleration, speed, bounds));
    results.push_back(relative(what + "of the slowest ball (m/s)", share * acceleration, slowest, bounds));
    results.push_back(relative(what + "of the fastest ball (m/s)", share * acceleration, fastest, bounds));
    results.push_back(absolute(what + "slip (m/s)", 0, slip, bounds));
}

}  // namespace

std::vector<Result> pulled_slab() {
    std::vector<Result> results;
    add_pulled_slab<2>(results);
    add_pulled_slab<3>(results);
    return results;
}

}  // namespace carom::app
