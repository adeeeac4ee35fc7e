#include "dynamics/buoyancy.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/submerged.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// Where a body is: its centre of mass and how it is turned.
template <int D>
struct Place {
    Vec<D> position;
    Rotation<D> rotation;
};

/// The part of a body that is in a water: its volume, and its centre from the centre of mass.
template <int D>
struct Wetted {
    double volume = 0;
    Vec<D> arm{};
};

template <int D>
Wetted<D> wetted(const Floating<D>& floating, std::uint32_t body, const Place<D>& place,
                 const Buoyancy<D>& water) {
    const BodyMass<D>& mass = floating.masses[body];
    const double height = dot(water.up, place.position) - water.surface;
    Wetted<D> sum;
    if (height >= mass.radius) return sum;
    const Vec<D> up = unrotate(place.rotation, water.up);
    const double surface = dot(up, mass.center) - height;
    floating.solids.each(body, [&](const Shape<D>& shape) {
        const Submerged<D> part = submerged(shape, up, surface);
        sum.volume += part.volume;
        sum.arm += part.volume * (part.center - mass.center);
    });
    if (sum.volume > 0) sum.arm = rotate(place.rotation, sum.arm / sum.volume);
    return sum;
}

/// Weight of a unit volume of the water, against `up`.
template <int D>
double weight_of(const Buoyancy<D>& water, const Vec<D>& gravity) {
    return -water.density * dot(water.up, gravity);
}

/// What the waters lift a body by at a place, after `visit(water, wetted part)`; nothing where it is dry.
template <int D, class Visit>
std::optional<Load<D>> lift(const Floating<D>& floating, std::uint32_t body, const Place<D>& place,
                            const Visit& visit) {
    std::optional<Load<D>> load;
    for (const Buoyancy<D>& water : floating.waters) {
        const Wetted<D> part = wetted(floating, body, place, water);
        if (part.volume == 0) continue;
        if (!load) load.emplace();
        visit(water, part);
        const Vec<D> force = (part.volume * weight_of(water, floating.gravity)) * water.up;
        load->force += force;
        load->torque += cross(part.arm, force);
    }
    return load;
}

/// The share of a ball's cross-section that part of its volume has.
template <int D>
double cross_section_of(double volume, double whole_section) {
    if (!(whole_section > 0)) return 0;
    if constexpr (D == 2) {
        return 4 * volume / (pi * whole_section);  // 2r of πr²
    } else {
        return 0.75 * volume / std::sqrt(whole_section / pi);  // πr² of 4/3 πr³
    }
}

/// What a water does against the motion of a body. First its turning is slowed, and then, with the spin that
/// is left, the middle of the wetted part: each takes energy, so both do.
template <int D>
void add_drag(const Buoyancy<D>& water, const Wetted<D>& part, const BodyState<D>& state,
              const BodyMass<D>& mass, const Rotation<D>& rotation, double step, Load<D>& load) {
    if (water.linear_drag == 0 && water.quadratic_drag == 0) return;
    Angular<D> w = state.angular_velocity;
    const Angular<D> momentum = rotate_angular(rotation, mass.inertia * rotate_angular(inverse(rotation), w));
    const Vec<D> in_water = state.velocity - water.flow;
    const Vec<D> before = in_water + cross(w, part.arm);
    const double speed = std::sqrt(dot(before, before) + angular_dot(w, momentum) * mass.inverse_mass);
    const double strength = water.linear_drag * water.density * part.volume +
                            0.5 * water.quadratic_drag * water.density *
                                cross_section_of<D>(part.volume, mass.cross_section) * speed;

    double rate = strength * mass.inverse_mass;
    if (step > 0) rate = std::min(rate, 1 / step);
    load.torque -= momentum * rate;
    w = w - w * (rate * step);

    const Vec<D> u = in_water + cross(w, part.arm);
    const double square = dot(u, u);
    if (square == 0) return;
    const Angular<D> lever = cross(part.arm, u);
    const double inverse_mass =
        mass.inverse_mass + angular_dot(lever, world_inverse_inertia<D>(mass, rotation) * lever) / square;
    const double push = step > 0 ? std::min(strength, 1 / (step * inverse_mass)) : strength;
    load.force -= push * u;
    load.torque -= cross(part.arm, push * u);
}

}  // namespace

template <int D>
void add_buoyancy(const Floating<D>& floating, std::span<const std::uint32_t> listed, double step,
                  std::span<Load<D>> loads) {
    for (const std::uint32_t i : listed) {
        const BodyState<D>& state = floating.states[i];
        const BodyMass<D>& mass = floating.masses[i];
        if (mass.inverse_mass == 0) continue;
        Place<D> place{state.position + 0.5 * step * state.velocity,
                       exp_rotation<D>(state.angular_velocity * (0.5 * step)) * state.rotation};
        if (step > 0) {
            const auto first = lift(floating, i, place, [](const Buoyancy<D>&, const Wetted<D>&) {});
            if (!first) continue;
            const Vec<D> pull =
                free_components<D>(mass.locks, (loads[i].force + first->force) * mass.inverse_mass);
            const Angular<D> turn =
                world_inverse_inertia<D>(mass, place.rotation) * (loads[i].torque + first->torque);
            place.position += (step * step / 12) * pull;
            place.rotation = exp_rotation<D>(turn * (step * step / 12)) * place.rotation;
        }
        Load<D> drag;
        const auto load = lift(floating, i, place, [&](const Buoyancy<D>& water, const Wetted<D>& part) {
            add_drag(water, part, state, mass, place.rotation, step, drag);
        });
        if (!load) continue;
        loads[i].force += load->force + drag.force;
        loads[i].torque += load->torque + drag.torque;
    }
}

template <int D>
double energy_in_water(const Floating<D>& floating) {
    double sum = 0;
    for (std::uint32_t i = 0; i < floating.states.size(); ++i) {
        if (floating.masses[i].inverse_mass == 0) continue;
        const Place<D> place{floating.states[i].position, floating.states[i].rotation};
        for (const Buoyancy<D>& water : floating.waters) {
            const Wetted<D> part = wetted(floating, i, place, water);
            const double depth = water.surface - dot(water.up, place.position + part.arm);
            sum += part.volume * weight_of(water, floating.gravity) * depth;
        }
    }
    return sum;
}

template void add_buoyancy(const Floating<2>&, std::span<const std::uint32_t>, double, std::span<Load<2>>);
template void add_buoyancy(const Floating<3>&, std::span<const std::uint32_t>, double, std::span<Load<3>>);
template double energy_in_water(const Floating<2>&);
template double energy_in_water(const Floating<3>&);

}  // namespace carom::detail
