#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Blocks that rock, and dominoes.

namespace carom::app {
namespace {

constexpr double width = 1, height = 4;

struct Rocking {
    double impact;     ///< time at which the block stands upright, s
    double amplitude;  ///< greatest tilt of the swing to the other side, rad
};

/// G. W. Housner (1963): a block of half diagonal R that rocks about a corner obeys 4/3 R θ'' = −g sin(α −
/// θ), and keeps 1 − 3/2 sin² α of its spin when the other corner comes down, which the angular momentum
/// about that corner says. Integrated here by small steps.
Rocking housner(double start) {
    const double alpha = std::atan(width / height), radius = 0.5 * std::hypot(width, height);
    const double rate = 0.75 * g / radius;
    constexpr double h = 1e-5;
    double theta = start, omega = 0, t = 0;
    while (theta > 0) {
        const double middle = theta + 0.5 * h * omega;
        omega -= h * rate * std::sin(alpha - middle);
        theta = middle + 0.5 * h * omega;
        t += h;
    }
    t -= theta / omega;
    const double kept = 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
    // ½ ω² = rate (cos(α − θ) − cos α) at the turning point.
    const double after = kept * omega;
    return {t, alpha - std::acos(std::cos(alpha) + 0.5 * after * after / rate)};
}

template <int D>
double tilt_of(const Rotation<D>& rotation) {
    const Vec<D> up = rotate(rotation, in_plane<D>(0, 1));
    return std::atan2(-up.x, up.y);
}

template <int D>
void add_rocking(std::vector<Result>& results) {
    const double alpha = std::atan(width / height), start = 0.5 * alpha;
    const Rocking truth = housner(start);
    Material rough;
    rough.friction = 1;
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    add_floor(world, rough);
    BodyDefinition<D> block;
    Vec<D> size = in_plane<D>(width, height);
    if constexpr (D == 3) size.z = 2;
    block.shapes.push_back({Box<D>{size}});
    block.shapes.back().material = rough;
    // Turned about its lower left corner, which stays at the origin.
    block.rotation = turned<D>(start);
    block.position = rotate(block.rotation, in_plane<D>(0.5 * width, 0.5 * height));
    const BodyId<D> id = world.add_body(block);
    const auto tilt = [&] { return tilt_of<D>(world.rotation(id)); };
    double impact = 0, before = tilt(), least = 0;
    for (int i = 0; i < 600; ++i) {
        world.step(frame / 4);
        const double now = tilt();
        if (impact == 0 && now < 0) impact = world.time() - frame / 4 * now / (now - before);
        least = std::min(least, now);
        before = now;
    }
    const std::string what = fmt::format("{}D, rocking block: ", D);
    results.push_back(relative(what + "stands upright at (s)", truth.impact, impact, {1e-2, 1e-3}));
    results.push_back(relative(what + "tilt on the other side (rad)", truth.amplitude, -least, {0.1, 1e-2}));
}

/// When the middle ten of twenty dominoes fall, one after the other.
template <int D>
double seconds_of_ten(int steps_a_second) {
    constexpr int count = 20, first = 5, last = 15;
    constexpr double thickness = 0.1, tall = 1, pitch = 0.5, fallen = 0.3;
    Material rough;
    rough.friction = 0.3;
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    add_floor(world, rough);
    std::vector<BodyId<D>> dominoes;
    for (int i = 0; i < count; ++i) {
        BodyDefinition<D> domino;
        Vec<D> size = in_plane<D>(thickness, tall);
        if constexpr (D == 3) size.z = 0.5;
        domino.shapes.push_back({Box<D>{size}});
        domino.shapes.back().material = rough;
        domino.position = in_plane<D>(pitch * i, 0.5 * tall);
        if (i == 0) {
            domino.angular_velocity = spin<D>(-2);
            domino.velocity = in_plane<D>(1, 0);
        }
        dominoes.push_back(world.add_body(domino));
    }
    double times[count] = {};
    for (int step = 0; step < 6 * steps_a_second; ++step) {
        world.step(1.0 / steps_a_second);
        for (int i = 0; i < count; ++i)
            if (times[i] == 0 && -tilt_of<D>(world.rotation(dominoes[static_cast<std::size_t>(i)])) > fallen)
                times[i] = world.time();
    }
    return times[last] > 0 ? times[last] - times[first] : -1;
}

template <int D>
void add_dominoes(std::vector<Result>& results) {
    const double truth = seconds_of_ten<D>(1920);
    for (const int steps : {60, 240})
        results.push_back(relative(fmt::format("{}D, ten dominoes, h = 1/{}: they take (s)", D, steps), truth,
                                   seconds_of_ten<D>(steps), {0.1, 1e-2}));
}

}  // namespace

std::vector<Result> rocking_blocks() {
    std::vector<Result> results;
    add_rocking<2>(results);
    add_rocking<3>(results);
    return results;
}

std::vector<Result> dominoes() {
    std::vector<Result> results;
    add_dominoes<2>(results);
    add_dominoes<3>(results);
    return results;
}

}  // namespace carom::app
