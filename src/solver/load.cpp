#include <algorithm>
#include <cmath>

#include "dynamics/flight.hpp"
#include "solver/solver.hpp"

namespace carom::detail {

template <int D>
void Solver<D>::make_room() {
    const std::size_t blocks = drives_.blocks_for(slots_.size());
    drives_.resize(blocks);
    records_.resize(blocks * drives_.width() * body_stride<D>);
    view_.records = records_.data();
    source_.resize(blocks * drives_.width());
    present_.resize(blocks * drives_.width());
    groups_known_ = false;
    list_used();
    each_used([](Section& s) {
        s.waiting.resize(s.contacts.blocks());
        s.has_struck.resize(s.contacts.blocks());
        s.groups.resize(s.contacts.blocks());
        s.hit.clear();
    });
}

template <int D>
void Solver<D>::set_free_axes(const SolverInput<D>& input) {
    view_.free_axes = nullptr;
    if (!input.some_locked) return;
    free_axes_.assign(drives_.blocks_for(slots_.size()) * drives_.width() * 4, 1);
    view_.free_axes = free_axes_.data();
    Vec<D> ones;
    for (int i = 0; i < D; ++i) ones[i] = 1;
    for (std::uint32_t slot = 1; slot < slots_.size(); ++slot) {
        if (!is_loaded(slot)) continue;
        const Vec<D> axes = free_components<D>(input.masses[slots_.body(slot)].locks, ones);
        for (int i = 0; i < D; ++i) free_axes_[slot * 4 + i] = static_cast<float>(axes[i]);
    }
}

/// A worker's share of the slots, in whole blocks.
template <int D>
Part Solver<D>::share_of_blocks(const Crew& crew) const {
    return crew.part(drives_.blocks_for(slots_.size()), 4);
}

template <int D>
BodySource<D> Solver<D>::source(const SolverInput<D>& input) {
    return {input.states.data(), input.masses.data(), input.loads.data(), source_.data(), present_.data()};
}

template <int D>
void Solver<D>::load_bodies(const SolverInput<D>& input, const Crew& crew) {
    const Part part = share_of_blocks(crew);
    const auto width = static_cast<std::uint32_t>(drives_.width());
    const auto first = static_cast<std::uint32_t>(part.begin) * width,
               end = static_cast<std::uint32_t>(part.end) * width;
    for (std::uint32_t slot = first; slot < end; ++slot) {
        const bool loaded = is_loaded(slot);
        source_[slot] = loaded ? slots_.body(slot) : 0;
        present_[slot] = loaded && BodySource<D>::is_plain(input.masses[source_[slot]]) ? 1.0f : 0.0f;
    }
    if (part.size() > 0) passes_->load({view_, drives_.data(), part}, source(input));
    for (std::uint32_t slot = first; slot < end; ++slot) {
        if (present_[slot] == 0 && is_loaded(slot)) load_body(input, slot);
    }
    crew.meet();
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
    write_record(view_, &slot, body);
    drives_.set(slot, drive);
}

namespace {

/// Within a step the solver takes the inertia as it was at the start. What it changed of a spin beside the
/// coasting is an angular impulse, then: the momentum after the step is that of the start and this impulse,
/// and says the spin that belongs to the new place. Without that, tops that touch something fall over at a
/// rate that is of first order in the step. `after` has the new place, and the spin that the solver left.
/// Bodies that hardly turn within a step are left alone.
void keep_momentum(const BodyState<3>& before, const BodyMass<3>& mass, double step, BodyState<3>& after) {
    constexpr double least_turn = 0.02;  // rad in the step
    const Locks& locks = mass.locks;
    if (locks.rx || locks.ry || locks.rz) return;
    if (dot(before.angular_velocity, before.angular_velocity) * step * step < least_turn * least_turn) return;
    const Vec3 coasting = coasting_spin<3>(before, mass, step) - before.angular_velocity;
    const Vec3 in_body = unrotate(before.rotation, after.angular_velocity - coasting);
    const Vec3 momentum = rotate(before.rotation, mass.inertia * in_body);
    after.angular_velocity =
        rotate(after.rotation, mass.inverse_inertia * unrotate(after.rotation, momentum));
}

}  // namespace

template <int D>
void Solver<D>::prepare_contacts(const Crew& crew) {
    each_share(crew, true,
               [&](const Passes<D>& passes, const BlockSpan<D>& span) { passes.prepare(span, view_); });
    if (crew.is_first()) {
        each_used([](Section& s) {
            for (std::size_t block = 0; block < s.contacts.blocks(); ++block)
                s.waiting[block] = s.contacts.found(block);
        });
    }
}

namespace {

/// Energy of a spin, but for a factor of two.
double spin_energy(const BodyMass<3>& mass, const Rotation3& rotation, const Vec3& spin) {
    const Vec3 local = unrotate(rotation, spin);
    return dot(local, mass.inertia * local);
}

/// The solver has a body's inertia as it lay at the start of the step. Where the body is then turned by other
/// bodies, and not as its spin would by itself, momentum about a thick axis becomes momentum about a thin
/// one, with many times the energy. So what is more than it had before and after the impulses is taken off.
void keep_energy(const BodyState<3>& before, const BodyMass<3>& mass, const Vec3& solved,
                 BodyState<3>& after) {
    const double most = std::max(spin_energy(mass, before.rotation, before.angular_velocity),
                                 spin_energy(mass, before.rotation, solved));
    const double now = spin_energy(mass, after.rotation, after.angular_velocity);
    if (now > most) after.angular_velocity *= std::sqrt(most / now);
}

/// What the solver left of a spin becomes that of the body at its new place.
void settle_spin(const BodyState<3>& before, const BodyMass<3>& mass, double step, BodyState<3>& after) {
    const Vec3 solved = after.angular_velocity;
    keep_momentum(before, mass, step, after);
    keep_energy(before, mass, solved, after);
}
void settle_spin(const BodyState<2>&, const BodyMass<2>&, double, BodyState<2>&) {}

}  // namespace

template <int D>
void Solver<D>::store_bodies(const SolverInput<D>& input, const Crew& crew) {
    const Part part = share_of_blocks(crew);
    if (part.size() > 0) passes_->store({view_, drives_.data(), part}, source(input));
    const std::size_t end = std::min<std::size_t>(part.end * drives_.width(), slots_.size());
    for (std::size_t k = std::max<std::size_t>(part.begin * drives_.width(), view_.first_movable); k < end;
         ++k) {
        const auto slot = static_cast<std::uint32_t>(k);
        if (present_[slot] == 0 && is_loaded(slot)) store_body(input, slot);
    }
}

template <int D>
void Solver<D>::store_body(const SolverInput<D>& input, std::uint32_t slot) const {
    const std::uint32_t index = slots_.body(slot);
    BodyState<D>& state = input.states[index];
    const BodyMass<D>& mass = input.masses[index];
    const Motion<D, float> m = gather<float>(view_, &slot).motion;
    const Drive<D, float> drive = drives_.get(slot);
    const BodyState<D> before = state;
    state.position += narrow<double>(m.moved);
    turn<D>(state, narrow<double>(m.turned));
    state.velocity = narrow<double>(m.v) + narrow<double>(drive.lost);
    state.angular_velocity = narrow<double>(m.w) + narrow<double>(drive.lost_spin);
    if (mass.isotropic || mass.inverse_mass == 0) return;
    settle_spin(before, mass, input.step, state);
}

#define CAROM_INSTANTIATE(D)                                                  \
    template void Solver<D>::make_room();                                     \
    template void Solver<D>::set_free_axes(const SolverInput<D>&);            \
    template void Solver<D>::load_bodies(const SolverInput<D>&, const Crew&); \
    template void Solver<D>::prepare_contacts(const Crew&);                   \
    template void Solver<D>::store_bodies(const SolverInput<D>&, const Crew&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
