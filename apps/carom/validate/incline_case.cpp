#include <fmt/format.h>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

/// A cube of 1 m at rest on a slope, and how far it has slid down.
template <int D>
class Slope {
  public:
    Slope(double angle, double friction) : down_(in_plane<D>(std::cos(angle), -std::sin(angle))) {
        Material material;
        material.friction = friction;
        WorldDefinition<D> definition;
        definition.sleep = false;
        world_ = World<D>(definition);
        add_floor(world_, material, angle);
        BodyDefinition<D> cube;
        Vec<D> size{};
        for (int i = 0; i < D; ++i) size[i] = 1;
        cube.shapes.push_back({Box<D>{size}});
        cube.shapes.back().material = material;
        cube.rotation = turned<D>(-angle);
        cube.position = rotate(cube.rotation, in_plane<D>(0, 0.5));
        start_ = cube.position;
        id_ = world_.add_body(cube);
    }

    void run(double seconds) { run_until(world_, world_.time() + seconds); }
    double distance() const { return dot(world_.position(id_) - start_, down_); }
    double speed() const { return dot(world_.velocity(id_), down_); }

  private:
    World<D> world_;
    BodyId<D> id_{};
    Vec<D> down_, start_{};
};

template <int D>
void add_slides(std::vector<Result>& results) {
    constexpr Bounds bounds{5e-3, 1e-4};
    constexpr double distances[6] = {9.81, 8.110858158, 6.411716316, 4.712574473, 3.013432631, 1.314290789};
    for (int i = 0; i < 6; ++i) {
        Slope<D> slope(30 * degree, 0.1 * i);
        slope.run(2);
        const std::string what = fmt::format("{}D, 30°, friction {:.1f}: ", D, 0.1 * i);
        results.push_back(relative(what + "distance at 2 s (m)", distances[i], slope.distance(), bounds));
        results.push_back(relative(what + "speed at 2 s (m/s)", distances[i], slope.speed(), bounds));
    }
}

/// A tenth of a degree decides whether the cube stays.
template <int D>
void add_sticking(std::vector<Result>& results) {
    constexpr double angle = 30 * degree, little = 0.1 * degree;
    Slope<D> holds(angle, std::tan(angle + little));
    double creep = 0;
    for (int second = 0; second < 60; ++second) {
        holds.run(1);
        creep = std::max(creep, std::fabs(holds.speed()));
    }
    const std::string under = fmt::format("{}D, 0.1° under the friction angle: ", D);
    constexpr Bounds bounds{1e-6};
    results.push_back(absolute(under + "mean creep in 60 s (m/s)", 0, holds.distance() / 60, bounds));
    results.push_back(absolute(under + "fastest in 60 s (m/s)", 0, creep, bounds));

    const double friction = std::tan(angle - little);
    Slope<D> slides(angle, friction);
    slides.run(2);
    const double truth = 2 * g * (std::sin(angle) - friction * std::cos(angle));
    results.push_back(relative(fmt::format("{}D, 0.1° over the friction angle: distance at 2 s (m)", D),
                               truth, slides.distance(), {5e-3, 1e-4}));
}

}  // namespace

std::vector<Result> incline() {
    std::vector<Result> results;
    add_slides<2>(results);
    add_slides<3>(results);
    add_sticking<2>(results);
    add_sticking<3>(results);
    return results;
}

}  // namespace carom::app
