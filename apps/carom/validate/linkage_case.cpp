#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// A crank drives a slider by a rod: a mechanism with a loop. In space its hinges hold more than is needed.

namespace carom::app {
namespace {

constexpr double crank = 1, rod = 3, omega = 4;

template <int D>
double inertia_of(const World<D>& world, BodyId<D> body) {
    if constexpr (D == 2)
        return world.mass_properties(body).inertia;
    else
        return world.mass_properties(body).inertia.zz;
}

template <int D>
struct Machine {
    World<D> world;
    BodyId<D> crank_body, rod_body, slider;

    Machine()
        : world(without_gravity()),
          // At the start all lie in a line, and the slider is at its far end, where it stands still.
          crank_body(add(0.5 * crank, crank, {0.5 * crank * omega, omega})),
          rod_body(add(crank + 0.5 * rod, rod, {0.5 * crank * omega, -crank * omega / rod})),
          slider(add(crank + rod, 0.4, {0, 0})) {
        hinge({}, crank_body, 0);
        hinge(crank_body, rod_body, crank);
        hinge(rod_body, slider, crank + rod);
        JointDefinition<D> rail;
        rail.b = slider;
        rail.kind = SliderJoint<D>{.anchor = in_plane<D>(crank + rod, 0)};
        world.add_joint(rail);
    }

    /// Angle of the crank, by its direction.
    double angle() const {
        const Vec<D> along = rotate(world.rotation(crank_body), in_plane<D>(1, 0));
        return std::atan2(along.y, along.x);
    }

  private:
    struct Motion {
        double up, spin;
    };
    static WorldDefinition<D> without_gravity() {
        WorldDefinition<D> definition;
        definition.gravity = {};
        definition.sleep = false;
        return definition;
    }
    BodyId<D> add(double x, double length, const Motion& motion) {
        BodyDefinition<D> body;
        Vec<D> size = in_plane<D>(length, 0.1);
        if constexpr (D == 3) size.z = 0.1;
        body.shapes.push_back({Box<D>{size}});
        body.shapes.back().filter.mask = 0;
        body.mass = 1;
        body.position = in_plane<D>(x, 0);
        body.velocity = in_plane<D>(0, motion.up);
        body.angular_velocity = spin<D>(motion.spin);
        return world.add_body(body);
    }
    void hinge(std::optional<BodyId<D>> a, BodyId<D> b, double x) {
        JointDefinition<D> joint;
        joint.a = a;
        joint.b = b;
        joint.kind = HingeJoint<D>{.anchor = in_plane<D>(x, 0)};
        world.add_joint(joint);
    }
};

/// Energy of the machine at the angle θ, its crank turning at 1 rad/s; doubled. Each body has 1 kg.
double reduced_inertia(double theta, double crank_inertia, double rod_inertia) {
    const double s = std::sin(theta), c = std::cos(theta);
    const double sin_rod = -crank * s / rod, cos_rod = std::sqrt(1 - sin_rod * sin_rod);
    const double rod_rate = -crank * c / (rod * cos_rod);
    const double slider = -crank * s - rod * sin_rod * rod_rate;
    const double x = -crank * s - 0.5 * rod * sin_rod * rod_rate, y = 0.5 * crank * c;
    return crank_inertia + 0.25 * crank * crank + x * x + y * y + rod_inertia * rod_rate * rod_rate +
           slider * slider;
}

template <int D>
void add_machine(std::vector<Result>& results) {
    Machine<D> machine;
    World<D>& world = machine.world;
    const double crank_inertia = inertia_of(world, machine.crank_body);
    const double rod_inertia = inertia_of(world, machine.rod_body);
    // The energy is kept: θ' = √(2 E / J(θ)), and a turn takes the integral of its inverse.
    const double energy = 0.5 * omega * omega * reduced_inertia(0, crank_inertia, rod_inertia);
    double turn = 0;
    constexpr int parts = 2000;
    for (int i = 0; i < parts; ++i)
        turn +=
            2 * pi / parts *
            std::sqrt(reduced_inertia(2 * pi * (i + 0.5) / parts, crank_inertia, rod_inertia) / (2 * energy));

    constexpr int turns = 10;
    const double start = world.energy().total();
    double followed = 0, before = machine.angle(), end = 0, apart = 0;
    for (int i = 0; i < 60 * 40 && followed < 2 * pi * turns; ++i) {
        world.step(frame);
        const double now = machine.angle(), way = std::remainder(now - before, 2 * pi);
        followed += way;
        before = now;
        if (followed >= 2 * pi * turns) end = world.time() - frame * (followed - 2 * pi * turns) / way;
        const double x = crank * std::cos(now) + std::sqrt(rod * rod - std::pow(crank * std::sin(now), 2));
        const Vec<D> off = world.position(machine.slider) - in_plane<D>(x, 0);
        // Not by a maximum, which passes over what is not a number.
        if (!(length(off) <= apart)) apart = length(off);
    }
    const std::string what = fmt::format("{}D, crank and slider: ", D);
    results.push_back(relative(what + "ten turns take (s)", turns * turn, end, {2e-2, 1e-3}));
    results.push_back(absolute(what + "slider off its place (m)", 0, apart, {1e-2, 1e-4}));
    results.push_back(
        relative(what + "energy after ten turns (J)", start, world.energy().total(), {2e-2, 1e-3}));
}

}  // namespace

std::vector<Result> crank_and_slider() {
    std::vector<Result> results;
    add_machine<2>(results);
    add_machine<3>(results);
    return results;
}

}  // namespace carom::app
