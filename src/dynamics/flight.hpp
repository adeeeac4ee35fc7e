#pragma once

#include <cstdint>
#include <span>

#include "carom/world.hpp"
#include "dynamics/body.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/solids.hpp"

namespace carom::detail {

/// All that pushes bodies: uniform gravity, the user's forces for this step, and the generators.
template <int D>
struct LoadModel {
    Vec<D> gravity{};
    std::span<const Load<D>> applied;       ///< by body index
    std::span<const std::uint32_t> bodies;  ///< those that matter in this step
    const Forces<D>& forces;
    Solids<D> solids{};  ///< needed where there is water

    /// Writes force and torque on the bodies at `time` into `loads`, by body index; those of water as they
    /// shall act through a step of the length given, or at this moment (see `add_buoyancy`).
    void sum(const BodyView<D>& view, double time, std::span<Load<D>> loads, double step = 0) const {
        begin(view.masses, 0, bodies.size(), loads);
        add(view, time, loads, step);
    }
    /// The two parts of `sum`: gravity and the user's forces, for a stretch of `bodies`; and all others.
    void begin(std::span<const BodyMass<D>> masses, std::size_t from, std::size_t to,
               std::span<Load<D>> loads) const;
    void add(const BodyView<D>& view, double time, std::span<Load<D>> loads, double step) const;
};

/// The bodies that nothing constrains in this step, and what moves them.
template <int D>
struct Flight {
    std::span<const std::uint32_t> bodies;  ///< indices of dynamic bodies
    std::span<BodyState<D>> states;         ///< of all bodies; those of `bodies` are moved on
    std::span<const BodyMass<D>> masses;
    std::span<Load<D>> loads;              ///< at the start of the step; overwritten by later stages
    std::span<const std::uint8_t> varies;  ///< whether a body's load depends on its motion
    const LoadModel<D>& model;
    double time;  ///< at the start; what acts then acts through the whole step
    double step;
};

/// Moves the bodies through the step by the integrator. Rotation in space keeps the angular momentum
/// whatever the integrator. The order in which the bodies are listed does not matter. Without a scheduler all
/// is done by this thread.
template <int D>
void fly(const Flight<D>& flight, Integrator integrator, Scheduler* scheduler = nullptr);

/// Angular velocity after `step` seconds of torque-free rotation.
template <int D>
Angular<D> coasting_spin(const BodyState<D>& state, const BodyMass<D>& mass, double step);

/// Exponential decay of velocity through a step: v(h) = factor · v + h · phi1 · a and
/// x(h) = x + h · phi1 · v + h² · phi2 · a solve v' = a − c v exactly for constant a.
struct Decay {
    double factor = 1, phi1 = 1, phi2 = 0.5;
    Decay(double damping, double step);
};

}  // namespace carom::detail
