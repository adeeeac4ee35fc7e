#include <fmt/format.h>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

constexpr double thickness = 0.02, inertia = 1.0 / 12;

/// What a thin rod of 1 m and 1 kg does when its end strikes.
struct Blow {
    double impulse;  ///< N s
    double speed;    ///< of the centre, upwards, m/s
    double spin;     ///< rad/s
};

/// A thin rod of 1 m and 1 kg that strikes something smooth with its right end.
template <int D>
class Rod {
  public:
    /// `angle` to the horizontal; `height` of the lowest point.
    Rod(double angle, double restitution, double height, bool weightless) {
        WorldDefinition<D> definition;
        definition.restitution_threshold = 0;
        if (weightless) definition.gravity = {};
        world_ = World<D>(definition);
        Material smooth;
        smooth.friction = 0;
        smooth.restitution = restitution;
        if (angle > 0) {
            add_floor(world_, smooth);
        } else {  // a floor would meet the whole rod: a fixed ball under the end
            BodyDefinition<D> stud;
            stud.type = BodyType::fixed;
            stud.position = in_plane<D>(0.5, -0.1);
            stud.shapes.push_back({Ball{0.1}});
            stud.shapes.back().material = smooth;
            world_.add_body(stud);
        }
        BodyDefinition<D> rod;
        rod.shapes.push_back({Capsule<D>{in_plane<D>(-0.5, 0), in_plane<D>(0.5, 0), thickness}});
        rod.shapes.back().material = smooth;
        rod.mass = 1;
        if constexpr (D == 2) {
            rod.inertia = inertia;
        } else {
            rod.inertia = Symmetric3<double>{0.5 * thickness * thickness, inertia, inertia};
        }
        rod.rotation = turned<D>(-angle);
        rod.position = in_plane<D>(0, height + thickness + 0.5 * std::sin(angle));
        id_ = world_.add_body(rod);
    }

    World<D>& world() { return world_; }
    void throw_down(double speed) { world_.set_velocity(id_, in_plane<D>(0, -speed)); }
    double speed() const { return world_.velocity(id_).y; }
    double spin() const { return spin_of(world_.angular_velocity(id_)); }
    double kinetic_energy() const { return world_.energy(id_).kinetic; }

  private:
    World<D> world_;
    BodyId<D> id_{};
};

/// The known blow at the end of a fall of 1 m for e = 0; e = 1 doubles the impulse.
struct Known {
    double degrees, impulse, speed, spin;
};

void add_blow(std::vector<Result>& results, const std::string& what, double e, const Known& known,
              const Blow& blow) {
    constexpr Bounds bounds{1e-2, 1e-4};
    const double fall_speed = std::sqrt(2 * g);
    results.push_back(relative(what + "impulse (N s)", (1 + e) * known.impulse, blow.impulse, bounds));
    results.push_back(relative(what + "speed of the centre (m/s)", (1 + e) * known.impulse - fall_speed,
                               blow.speed, bounds));
    results.push_back(relative(what + "spin (rad/s)", (1 + e) * known.spin, blow.spin, bounds));
}

/// Thrown down in empty space at the speed of a fall of 1 m: after the blow nothing changes any more.
template <int D>
void add_throw(std::vector<Result>& results, double e, const Known& known) {
    Rod<D> rod(known.degrees * degree, e, 0.1, true);
    const double before = std::sqrt(2 * g);
    rod.throw_down(before);
    const double energy = rod.kinetic_energy();
    run_until(rod.world(), 0.1 / before + 2 * frame);
    const std::string what = fmt::format("{}D, {:g}°, e = {:g}, thrown: ", D, known.degrees, e);
    add_blow(results, what, e, known, {rod.speed() + before, rod.speed(), rod.spin()});
    if (e == 1) {
        results.push_back(
            relative(what + "energy / energy before", 1, rod.kinetic_energy() / energy, {1e-2, 1e-6}));
    }
}

/// Dropped from 1 m. After the blow the rod is in flight (its end swings up), so that what gravity did since
/// the moment of the blow is known.
template <int D>
void add_drop(std::vector<Result>& results, double e, const Known& known) {
    Rod<D> rod(known.degrees * degree, e, 1, false);
    const double fall = std::sqrt(2 / g);
    run_until(rod.world(), std::ceil(fall / frame + 1) * frame);
    const double speed = rod.speed() + g * (rod.world().time() - fall);
    add_blow(results, fmt::format("{}D, {:g}°, e = {:g}, dropped: ", D, known.degrees, e), e, known,
             {speed + g * fall, speed, rod.spin()});
}

template <int D>
void add_rods(std::vector<Result>& results) {
    constexpr Known all[] = {{0, 1.107361730, -3.322085, 6.644170},
                             {30, 1.362906744, -3.066540, 7.081871},
                             {60, 2.531112525, -1.898334, 7.593338}};
    for (const double e : {0.0, 1.0}) {
        for (const Known& known : all) add_throw<D>(results, e, known);
        for (const Known& known : all) {
            if (known.degrees > 0) add_drop<D>(results, e, known);
        }
    }
}

}  // namespace

std::vector<Result> rod_strikes() {
    std::vector<Result> results;
    add_rods<2>(results);
    add_rods<3>(results);
    return results;
}

}  // namespace carom::app
