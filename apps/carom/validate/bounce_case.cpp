#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

constexpr double radius = 0.1, drop = 1;

/// A ball whose lowest point is let fall onto a level floor from 1 m. The threshold below which nothing
/// bounces is zero, so that small bounces count too.
template <int D>
class Bouncer {
  public:
    explicit Bouncer(double restitution) {
        WorldDefinition<D> definition;
        definition.restitution_threshold = 0;
        world_ = World<D>(definition);
        Material material;
        material.restitution = restitution;
        add_floor(world_, material);
        BodyDefinition<D> ball;
        ball.shapes.push_back({Ball{radius}});
        ball.shapes.back().material = material;
        ball.position = in_plane<D>(0, drop + radius);
        id_ = world_.add_body(ball);
    }

    void step(double h) { world_.step(h); }
    double time() const { return world_.time(); }
    double height() const { return world_.position(id_).y - radius; }
    double speed() const { return world_.velocity(id_).y; }
    /// The height at which the flight of the moment ends, or began.
    double apex() const { return height() + speed() * speed() / (2 * g); }
    /// When the flight of the moment began on the floor.
    double launch() const { return time() - (std::sqrt(2 * g * apex()) - speed()) / g; }

  private:
    World<D> world_;
    BodyId<D> id_{};
};

/// A flight between two bounces, as it is seen from the first sample that lies in it.
struct Flight {
    double height, launch;
};

/// The flights that are long enough for a sample to fall into each, and when the ball was first seen at rest.
struct Bounces {
    std::vector<Flight> flights;
    double rest = 0;
};

template <int D>
Bounces watch(double restitution, double end, double h) {
    Bouncer<D> ball(restitution);
    Bounces seen;
    const double fall = std::sqrt(2 * drop / g);
    double longest = 2 * fall * restitution, last = drop;
    while (ball.time() < end) {
        ball.step(h);
        if (seen.rest == 0 && ball.apex() < 1e-7) seen.rest = ball.time();
        // Each bounce takes (1 − e²) of the height: half of that tells a new flight from noise.
        const bool bounced = ball.apex() < 0.5 * (1 + restitution * restitution) * last;
        if (!bounced || longest < h) continue;
        last = ball.apex();
        longest *= restitution;
        seen.flights.push_back({last, ball.launch()});
    }
    return seen;
}

/// The limit of launch times tₙ that come closer in a geometric series, from the last three (Aitken).
double limit_of_launches(const std::vector<Flight>& flights) {
    const std::size_t n = flights.size();
    if (n < 3) return 0;
    const double a = flights[n - 3].launch, b = flights[n - 2].launch, c = flights[n - 1].launch;
    return c - (c - b) * (c - b) / ((c - b) - (b - a));
}

struct Known {
    double restitution, total_time;
};

template <int D>
void add_bounces(std::vector<Result>& results, const Known& known) {
    const double e = known.restitution;
    Bounces seen = watch<D>(e, known.total_time + 1, frame);
    const std::string what = fmt::format("{}D, e = {}: ", D, e);

    const std::size_t count = std::min<std::size_t>(seen.flights.size(), 10);
    double worst = 0, last = 1, true_height = drop;
    for (std::size_t n = 0; n < count; ++n) {
        true_height *= e * e;
        last = seen.flights[n].height;
        worst = std::max(worst, std::fabs(last / true_height - 1));
    }
    results.push_back({fmt::format("{}height of bounces 1 to {}, worst error (m)", what, count),
                       true_height,
                       last,
                       count > 2 ? worst : 1,
                       {1e-2, 1e-6}});
    results.push_back(relative(what + "limit of the times of the bounces (s)", known.total_time,
                               limit_of_launches(seen.flights), {1e-2, 1e-6}));
    results.push_back(absolute(what + "seen at rest, to a step (s)", known.total_time, seen.rest,
                               {frame + 1e-2 * known.total_time, frame}));
}

/// e = 1: the ball never tires, whatever the step.
template <int D>
void add_perpetual(std::vector<Result>& results) {
    for (const int rate : {30, 50, 60, 144, 240, 1000}) {
        Bouncer<D> ball(1);
        double worst = 0, last = 0;
        while (ball.time() < 100) {
            ball.step(1.0 / rate);
            last = ball.apex();
            worst = std::max(worst, std::fabs(last / drop - 1));
        }
        results.push_back({fmt::format("{}D, e = 1, h = 1/{}: energy / m g in 100 s, worst error", D, rate),
                           1,
                           last,
                           worst,
                           {1e-2, 1e-6}});
    }
}

}  // namespace

std::vector<Result> bouncing_ball() {
    constexpr Known all[] = {
        {0.5, 1.354570923}, {0.7, 2.558633966}, {0.8, 4.063712769}, {0.9, 8.578949179}, {0.95, 17.609421998}};
    std::vector<Result> results;
    for (const Known& known : all) {
        add_bounces<2>(results, known);
        add_bounces<3>(results, known);
    }
    add_perpetual<2>(results);
    add_perpetual<3>(results);
    return results;
}

}  // namespace carom::app
