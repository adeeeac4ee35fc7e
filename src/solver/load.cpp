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
    sums_begun_ = false;
    for (Section& s : sections_) {
        s.waiting.resize(s.contacts.blocks());
        s.hit.clear();
    }
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

template <int D>
void Solver<D>::load_bodies(const SolverInput<D>& input, const Crew& crew) {
    const Part part = crew.part(drives_.blocks_for(slots_.size()), 4);
    const auto width = static_cast<std::uint32_t>(drives_.width());
    for (auto slot = static_cast<std::uint32_t>(part.begin) * width; slot < part.end * width; ++slot) {
        if (is_loaded(slot)) {
            load_body(input, slot);
        } else {
            drives_.set(slot, {});
            write_record(view_, slot, Body<D, float>{});
        }
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
    write_record(view_, slot, body);
    drives_.set(slot, drive);
}

template <int D>
void Solver<D>::prepare_contacts(const Crew& crew) {
    each_share(crew, true,
               [&](const Passes<D>& passes, const BlockSpan<D>& span) { passes.prepare(span, view_); });
    if (crew.is_first()) {
        each_section([](Section& s) {
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

/// The solver has a body's inertia as it lay at the start of the step. Where the body is then turned far, by
/// other bodies and not as its spin would by itself, a spin about its thin axis becomes one about a thick
/// one, with many times the energy. So what is much more than it had before and after the impulses is taken
/// off.
void keep_energy(BodyState<3>& state, const BodyMass<3>& mass, const Vec3& turned, const Vec3& spin_before,
                 const Rotation3& rotation_before) {
    constexpr double far = 0.5, much = 1.05;  // rad
    if (mass.isotropic || !(dot(turned, turned) > far * far)) return;
    const double most = std::max(spin_energy(mass, rotation_before, spin_before),
                                 spin_energy(mass, rotation_before, state.angular_velocity));
    const double now = spin_energy(mass, state.rotation, state.angular_velocity);
    if (now > much * most) state.angular_velocity *= std::sqrt(most / now);
}

}  // namespace

template <int D>
void Solver<D>::store_bodies(const SolverInput<D>& input, const Crew& crew) const {
    const Part part = crew.part(slots_.size() - view_.first_movable, 64);
    for (std::size_t k = part.begin; k < part.end; ++k) {
        const auto slot = static_cast<std::uint32_t>(view_.first_movable + k);
        if (!is_loaded(slot)) continue;
        BodyState<D>& state = input.states[slots_.body(slot)];
        const Motion<D, float> m = gather<float>(view_, &slot).motion;
        const Drive<D, float> drive = drives_.get(slot);
        const BodyState<D> before = state;
        state.position += narrow<double>(m.moved);
        turn<D>(state, narrow<double>(m.turned));
        state.velocity = narrow<double>(m.v) + narrow<double>(drive.lost);
        state.angular_velocity = narrow<double>(m.w) + narrow<double>(drive.lost_spin);
        if constexpr (D == 3)
            keep_energy(state, input.masses[slots_.body(slot)], narrow<double>(m.turned),
                        before.angular_velocity, before.rotation);
    }
}

#define CAROM_INSTANTIATE(D)                                                  \
    template void Solver<D>::make_room();                                     \
    template void Solver<D>::set_free_axes(const SolverInput<D>&);            \
    template void Solver<D>::load_bodies(const SolverInput<D>&, const Crew&); \
    template void Solver<D>::prepare_contacts(const Crew&);                   \
    template void Solver<D>::store_bodies(const SolverInput<D>&, const Crew&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
