#include "dynamics/flight.hpp"
#include "solver/solver.hpp"

namespace carom::detail {

template <int D>
void Solver<D>::load_bodies(const SolverInput<D>& input) {
    const std::uint32_t slots = slots_.size();
    const std::size_t blocks = drives_.blocks_for(slots), lanes = blocks * drives_.width();
    drives_.resize(blocks);
    records_.resize(lanes * body_stride<D>);
    view_.records = records_.data();

    const auto is_locked = [](const Locks& locks) { return locks.x || locks.y || locks.z; };
    bool some_locked = false;
    const auto is_loaded = [&](std::uint32_t slot) {
        return slot != BodySlots::still && slot < slots && slots_.body(slot) != BodySlots::none &&
               touching_[slot] > 0;
    };
    for (std::uint32_t slot = 1; slot < slots; ++slot)
        some_locked |= is_loaded(slot) && is_locked(input.masses[slots_.body(slot)].locks);
    free_axes_.assign(some_locked ? lanes * 4 : 0, 1);
    view_.free_axes = some_locked ? free_axes_.data() : nullptr;

    for (std::uint32_t slot = 0; slot < lanes; ++slot) {
        if (is_loaded(slot)) {
            load_body(input, slot);
        } else {
            drives_.set(slot, {});
            write_record(view_, slot, Body<D, float>{});
        }
    }
}

/// The record is given no velocity yet: first it collects what the kept impulses make (see `begin_warm`).
template <int D>
void Solver<D>::load_body(const SolverInput<D>& input, std::uint32_t slot) {
    const std::uint32_t index = slots_.body(slot);
    const BodyState<D>& state = input.states[index];
    const BodyMass<D>& mass = input.masses[index];
    Body<D, float> body;
    Drive<D, float> drive;
    drive.start = narrow<float>(state.velocity);
    drive.start_spin = narrow<float>(state.angular_velocity);
    drive.lost = narrow<float>(state.velocity - narrow<double>(drive.start));
    drive.lost_spin = narrow<float>(Angular<D>(state.angular_velocity - narrow<double>(drive.start_spin)));
    if (mass.inverse_mass != 0) {
        const Inertia<D> inertia = world_inverse_inertia<D>(mass, state.rotation);
        body.inverse_mass = static_cast<float>(mass.inverse_mass);
        body.weight.inertia = narrow<float>(inertia);
        if (view_.free_axes) {
            Vec<D> ones;
            for (int i = 0; i < D; ++i) ones[i] = 1;
            const Vec<D> axes = free_components<D>(mass.locks, ones);
            for (int i = 0; i < D; ++i) free_axes_[slot * 4 + i] = static_cast<float>(axes[i]);
        }
        // The gyroscopic term: what the spin would do by itself through the step, spread evenly over it.
        const Angular<D> coasting = coasting_spin<D>(state, mass, input.step) - state.angular_velocity;
        drive.acceleration =
            narrow<float>(free_components<D>(mass.locks, input.loads[index].force * mass.inverse_mass));
        drive.spin_acceleration =
            narrow<float>(Angular<D>(inertia * input.loads[index].torque + coasting * (1 / input.step)));
        const double h = input.step / input.substeps;
        if (mass.linear_damping != 0)
            drive.damping = static_cast<float>(1 - Decay(mass.linear_damping, h).factor);
        if (mass.angular_damping != 0)
            drive.spin_damping = static_cast<float>(1 - Decay(mass.angular_damping, h).factor);
    }
    write_record(view_, slot, body);
    drives_.set(slot, drive);
}

template <int D>
void Solver<D>::prepare_contacts() {
    each_section([&](Section& s) {
        passes_of(s).prepare(s.contacts.span(), view_);
        s.waiting.clear();
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block)
            s.waiting.push_back(s.contacts.found(block));
        s.hit.clear();
    });
}

template <int D>
void Solver<D>::store_bodies(const SolverInput<D>& input) const {
    for (std::uint32_t slot = view_.first_movable; slot < slots_.size(); ++slot) {
        if (touching_[slot] == 0) continue;
        BodyState<D>& state = input.states[slots_.body(slot)];
        const Motion<D, float> m = gather<float>(view_, &slot).motion;
        const Drive<D, float> drive = drives_.get(slot);
        state.position += narrow<double>(m.moved);
        turn<D>(state, narrow<double>(m.turned));
        state.velocity = narrow<double>(m.v) + narrow<double>(drive.lost);
        state.angular_velocity = narrow<double>(m.w) + narrow<double>(drive.lost_spin);
    }
}

#define CAROM_INSTANTIATE(D)                                     \
    template void Solver<D>::load_bodies(const SolverInput<D>&); \
    template void Solver<D>::prepare_contacts();                 \
    template void Solver<D>::store_bodies(const SolverInput<D>&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
