#pragma once

#include <span>

#include "carom/forces.hpp"
#include "dynamics/solids.hpp"

namespace carom::detail {

/// The bodies, and what they may float in.
template <int D>
struct Floating {
    std::span<const BodyState<D>> states;
    std::span<const BodyMass<D>> masses;
    Solids<D> solids;
    Vec<D> gravity{};
    std::span<const Buoyancy<D>> waters;
};

/// Adds to `loads`, which hold all else, what the waters do to the dynamic bodies that are listed. With a
/// `step` it is what shall act through a step of that length: x += h v + ½ h² a, v += h a with the force of
/// the place half a step ahead is the position form of Verlet's method, which keeps the energy, and which two
/// periods of a bobbing body at 60 Hz show: with the force of h²/12 a further on the period is right to
/// fourth order (Takahashi, Imada 1984). With a step of 0 it is what acts at this moment.
template <int D>
void add_buoyancy(const Floating<D>& floating, std::span<const std::uint32_t> listed, double step,
                  std::span<Load<D>> loads);

/// Potential energy of the dynamic bodies in the waters, J: of what they displace, from the surface down.
template <int D>
double energy_in_water(const Floating<D>& floating);

}  // namespace carom::detail
