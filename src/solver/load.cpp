#include <algorithm>

#include "dynamics/flight.hpp"
#include "solver/solver.hpp"

namespace carom::detail {

/// Slots for the bodies that move: first those that only the user moves, then those that contacts push.
template <int D>
void Solver<D>::find_slots(const SolverInput<D>& input) {
    slot_of_.assign(input.states.size(), 0);
    bodies_.assign(1, 0);
    const auto take = [&](std::uint32_t body, bool dynamic) {
        if (!input.moving[body] || slot_of_[body] != 0 || (input.types[body] == BodyType::dynamic) != dynamic)
            return;
        slot_of_[body] = static_cast<std::uint32_t>(bodies_.size());
        bodies_.push_back(body);
    };
    for (const bool dynamic : {false, true}) {
        for (const std::uint32_t i : input.active) {
            take(input.contacts[i].body_a, dynamic);
            take(input.contacts[i].body_b, dynamic);
        }
        for (const std::uint32_t i : input.active_joints) {
            if (input.joints[i].body_a != no_body) take(input.joints[i].body_a, dynamic);
            take(input.joints[i].body_b, dynamic);
        }
        if (!dynamic) view_.first_movable = static_cast<std::uint32_t>(bodies_.size());
    }
    pairs_.clear();
    for (const std::uint32_t i : input.active) {
        const std::uint32_t a = input.contacts[i].body_a, b = input.contacts[i].body_b;
        pairs_.push_back({slot_of_[a], slot_of_[b], pair_key(a, b)});
    }
}

template <int D>
void Solver<D>::gather_bodies(const SolverInput<D>& input) {
    find_slots(input);
    drives_.set_width(passes_->width);
    const std::size_t blocks = drives_.blocks_for(bodies_.size());
    const std::size_t slots = blocks * drives_.width();
    drives_.resize(blocks);
    records_.assign(slots * body_stride<D>, 0);
    view_.records = records_.data();

    const auto is_locked = [&](std::uint32_t body) {
        const Locks& locks = input.masses[body].locks;
        return locks.x || locks.y || locks.z;
    };
    const bool some_locked = std::any_of(bodies_.begin() + 1, bodies_.end(), is_locked);
    free_axes_.assign(some_locked ? slots * 4 : 0, 1);
    view_.free_axes = some_locked ? free_axes_.data() : nullptr;

    for (std::size_t slot = 0; slot < slots; ++slot) {
        if (slot == 0 || slot >= bodies_.size()) {
            drives_.set(slot, {});
        } else {
            load_body(input, static_cast<std::uint32_t>(slot));
        }
    }
}

/// The record is given no velocity yet: first it collects what the kept impulses make (see `begin_warm`).
template <int D>
void Solver<D>::load_body(const SolverInput<D>& input, std::uint32_t slot) {
    const std::uint32_t index = bodies_[slot];
    const BodyState<D>& state = input.states[index];
    const BodyMass<D>& mass = input.masses[index];
    Drive<D, float> drive;
    drive.start = narrow<float>(state.velocity);
    drive.start_spin = narrow<float>(state.angular_velocity);
    drive.lost = narrow<float>(state.velocity - narrow<double>(drive.start));
    drive.lost_spin = narrow<float>(Angular<D>(state.angular_velocity - narrow<double>(drive.start_spin)));
    if (mass.inverse_mass != 0) {
        Body<D, float> body;
        const Inertia<D> inertia = world_inverse_inertia<D>(mass, state.rotation);
        body.inverse_mass = static_cast<float>(mass.inverse_mass);
        body.weight.inertia = narrow<float>(inertia);
        write_record(view_, slot, body);
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
    drives_.set(slot, drive);
}

template <int D>
void Solver<D>::prepare_joints(const SolverInput<D>& input) {
    joints_.prepare({input.joints, input.active_joints, input.states, input.masses, slot_of_, view_,
                     bodies_.size(), input.step / input.substeps});
}

template <int D>
void Solver<D>::deal_contacts(const SolverInput<D>& input) {
    colours_.deal(pairs_, view_.first_movable, bodies_.size());
    Section &wide = sections_[0], &single = sections_[1];
    for (Section& s : sections_) {
        s.blocks.clear(&s == &wide ? *passes_ : passes_of_width<D>(1));
        s.colour_starts.clear();
        s.unsettled.clear();
    }
    impacts_.clear();

    std::array<std::size_t, Colours::count> next{};
    for (int colour = 0; colour < Colours::count; ++colour) {
        if (colours_.size(colour) == 0) continue;
        next[colour] = wide.blocks.append(colours_.size(colour));
        wide.colour_starts.push_back(static_cast<std::uint32_t>(next[colour]));
    }
    single.blocks.append(colours_.size(Colours::overflow));
    for (Section& s : sections_) s.contacts.assign(s.blocks.places(), none);

    std::size_t next_single = 0;
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
        const int colour = colours_[i];
        Section& s = colour == Colours::overflow ? single : wide;
        const std::size_t place = colour == Colours::overflow ? next_single++ : next[colour]++;
        s.contacts[place] = i;
        s.blocks.a(place) = pairs_[i].a;
        s.blocks.b(place) = pairs_[i].b;
    }
    for (Section& s : sections_) fill_section(input, s);
}

template <int D>
void Solver<D>::fill_section(const SolverInput<D>& input, Section& section) {
    for (std::size_t block = 0; block < section.blocks.blocks(); ++block) fill_block(input, section, block);
}

template <int D>
void Solver<D>::fill_block(const SolverInput<D>& input, Section& section, std::size_t block) {
    constexpr std::size_t ahead = 32;  // how many contacts before its turn a record is called for
    ContactBlocks<D>& blocks = section.blocks;
    const std::size_t begin = block * blocks.width();
    std::array<std::uint32_t, Passes<D>::most_lanes> index;
    std::array<float, Passes<D>::most_lanes> count;
    std::uint8_t traits = 0;
    for (std::size_t lane = 0; lane < blocks.width(); ++lane) {
        const std::size_t place = begin + lane;
        prefetch_record(input, section, place + ahead);
        const std::uint32_t contact = section.contacts[place];
        index[lane] = contact == none ? index[0] : input.active[contact];
        const ContactRecord<D>& record = input.contacts[index[lane]];
        count[lane] = contact == none ? 0 : static_cast<float>(record.count);
        const bool fixed = blocks.a(place) < view_.first_movable || blocks.b(place) < view_.first_movable;
        traits |= (fixed ? some_fixed : 0) | (record.rolling > 0 ? some_rolling : 0) |
                  (record.roundness_a != 0 || record.roundness_b != 0 ? some_round : 0);
        if (record.restitution != 0 && contact != none) note_impacts(section, place, record);
    }
    blocks.traits(block) = traits;
    blocks.passes().load(blocks.span(block, 1), {input.contacts.data(), index.data(), count.data()}, view_);
    for (std::size_t lane = 0; lane < blocks.width(); ++lane) {
        if (count[lane] > 0 && !carries_impulse(blocks.rows(), begin + lane))
            section.unsettled.push_back({static_cast<std::uint32_t>(begin + lane)});
    }
}

template <int D>
void Solver<D>::prefetch_record(const SolverInput<D>& input, const Section& section, std::size_t place) {
    if (place >= section.contacts.size() || section.contacts[place] == none) return;
    const char* record =
        reinterpret_cast<const char*>(&input.contacts[input.active[section.contacts[place]]]);
    for (std::size_t line = 0; line < sizeof(ContactRecord<D>); line += 64) __builtin_prefetch(record + line);
}

/// Does any point of the contact push?
template <int D>
bool Solver<D>::carries_impulse(const LaneStore<Rows>& rows, std::size_t place) {
    const Rows model;
    return std::any_of(model.points.begin(), model.points.end(), [&](const NormalRow<D, float>& p) {
        return rows.at(place, field_of(model, p.impulse)) > 0;
    });
}

/// The most that the impulse of any point changes its own speed, m/s.
template <int D>
float Solver<D>::speed_taken(const LaneStore<Rows>& rows, std::size_t place) {
    const Rows model;
    float most = 0;
    for (const NormalRow<D, float>& p : model.points) {
        const float impulse = rows.at(place, field_of(model, p.impulse));
        if (impulse > 0) most = std::max(most, impulse / rows.at(place, field_of(model, p.mass)));
    }
    return most;
}

template <int D>
void Solver<D>::note_impacts(const Section& section, std::size_t place, const ContactRecord<D>& record) {
    const auto number = static_cast<std::uint32_t>(&section - sections_.data());
    for (int k = 0; k < record.count; ++k)
        impacts_.push_back({number, static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(k),
                            record.restitution, 0, 0});
}

template <int D>
void Solver<D>::store_contact(const Section& section, std::size_t place, ContactRecord<D>& record) const {
    const LaneStore<Rows>& rows = section.blocks.rows();
    Rows r;
    const auto read = [&](float& member) { member = rows.at(place, field_of(r, member)); };
    for (int i = 0; i < D; ++i) {
        read(r.normal[i]);
        read(r.tangent[i]);
    }
    for (int k = 0; k < record.count; ++k) {
        read(r.points[k].impulse);
        read(r.points[k].total_impulse);
        record.points[k].impulse = r.points[k].impulse;
        record.points[k].total_impulse = r.points[k].total_impulse;
    }
    for (int k = 0; k < D - 1; ++k) {
        read(r.friction_impulse[k]);
        read(r.total_friction[k]);
    }
    record.friction_impulse = along_tangents(r, r.friction_impulse);
    record.total_friction = along_tangents(r, r.total_friction);
    if constexpr (D == 3) {
        read(r.twist_impulse);
        record.twist_impulse = r.twist_impulse;
    }
    if (record.rolling > 0) {
        if constexpr (D == 2) {
            read(r.rolling_impulse);
        } else {
            for (int i = 0; i < 3; ++i) read(r.rolling_impulse[i]);
        }
        record.spin_impulse = r.rolling_impulse;
    }
}

template <int D>
void Solver<D>::store(const SolverInput<D>& input) {
    constexpr std::size_t ahead = 32;
    for (const Section& section : sections_) {
        for (std::size_t place = 0; place < section.contacts.size(); ++place) {
            const std::uint32_t contact = section.contacts[place];
            prefetch_record(input, section, place + ahead);
            if (contact != none) store_contact(section, place, input.contacts[input.active[contact]]);
        }
    }
    joints_.store(input.joints);
    for (std::uint32_t slot = view_.first_movable; slot < bodies_.size(); ++slot) {
        BodyState<D>& state = input.states[bodies_[slot]];
        const Motion<D, float> m = gather<float>(view_, &slot).motion;
        const Drive<D, float> drive = drives_.get(slot);
        state.position += narrow<double>(m.moved);
        turn<D>(state, narrow<double>(m.turned));
        state.velocity = narrow<double>(m.v) + narrow<double>(drive.lost);
        state.angular_velocity = narrow<double>(m.w) + narrow<double>(drive.lost_spin);
    }
}

#define CAROM_INSTANTIATE(D)                                                       \
    template void Solver<D>::gather_bodies(const SolverInput<D>&);                 \
    template void Solver<D>::prepare_joints(const SolverInput<D>&);                \
    template bool Solver<D>::carries_impulse(const LaneStore<Rows>&, std::size_t); \
    template float Solver<D>::speed_taken(const LaneStore<Rows>&, std::size_t);    \
    template void Solver<D>::deal_contacts(const SolverInput<D>&);                 \
    template void Solver<D>::store(const SolverInput<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
