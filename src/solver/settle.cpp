#include <algorithm>

#include "solver/solver.hpp"

/// Contacts that begin. They have no impulses to start from, and one pass over their rows leaves their points
/// unequal: a box that lands flat would tilt, and one put on a slope would slip before it holds. So the rows
/// of these contacts are solved, friction included, until their points agree.
namespace carom::detail {

/// A contact that takes more speed than this in a sub-step was hit, and does not just begin to carry.
constexpr float blow_speed = 0.25f;  // m/s

/// Finds the contacts to be settled: those that carry their first impulse, and those that were hit in the
/// sub-step before. Are there any?
template <int D>
bool Solver<D>::find_struck() {
    bool some = false;
    for (Section& s : sections_) {
        s.struck.clear();
        s.begun.clear();
        if (s.contacts.empty()) continue;
        s.struck.swap(s.hit);
        each_bit(
            s, [&](std::size_t block) { return s.waiting[block] & s.contacts.found(block); },
            [&](std::uint32_t index) { s.begun.push_back(index); });
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block)
            s.waiting[block] &= ~s.contacts.found(block);
        s.struck.insert(s.struck.end(), s.begun.begin(), s.begun.end());
        some |= !s.struck.empty();
    }
    return some;
}

/// The most that the impulse of any point changes its own speed, m/s.
template <int D>
float Solver<D>::speed_taken(const LaneStore<Rows>& rows, std::size_t index) {
    const Rows model;
    float most = 0;
    for (const NormalRow<D, float>& p : model.points) {
        const float impulse = rows.at(index, field_of(model, p.impulse));
        if (impulse > 0) most = std::max(most, impulse / rows.at(index, field_of(model, p.mass)));
    }
    return most;
}

/// Of the contacts that began in this sub-step, those that were hit are to be settled once more.
template <int D>
void Solver<D>::note_blows() {
    for (Section& s : sections_) {
        for (const std::uint32_t index : s.begun) {
            if (speed_taken(s.contacts.rows(), index) > blow_speed) s.hit.push_back(index);
        }
    }
}

/// The impulse of a blow in the last sub-step is nothing for the next step to begin with.
template <int D>
void Solver<D>::forget_last_blows() {
    for (Section& s : sections_) {
        for (const std::uint32_t index : s.hit) {
            Rows rows = s.contacts.rows().get(index);
            for (NormalRow<D, float>& p : rows.points) p.impulse = 0;
            rows.friction_impulse = {};
            rows.twist_impulse = 0;
            rows.rolling_impulse = {};
            s.contacts.rows().set(index, rows);
        }
    }
}

template <int D>
void Solver<D>::copy_struck(Section& s) {
    s.settling.clear(s.contacts.passes());
    if (s.struck.empty()) return;
    s.settling.append(s.struck.size());
    for (std::size_t place = 0; place < s.settling.places(); ++place) {
        std::uint8_t& traits = s.settling.traits(place / s.settling.width());
        if (place >= s.struck.size()) {
            s.settling.rows().set(place, {});
            traits |= some_fixed;
            continue;
        }
        const std::uint32_t from = s.struck[place];
        s.settling.rows().set(place, s.contacts.rows().get(from));
        s.settling.a(place) = s.contacts.a(from);
        s.settling.b(place) = s.contacts.b(from);
        traits |= s.contacts.traits(from / s.contacts.width());
    }
}

template <int D>
void Solver<D>::return_struck(Section& s) {
    for (std::size_t place = 0; place < s.struck.size(); ++place)
        s.contacts.rows().set(s.struck[place], s.settling.rows().get(place));
}

template <int D>
template <bool biased>
void Solver<D>::settle_struck() {
    constexpr int sweeps = 8;
    for (Section& s : sections_) copy_struck(s);
    if (some_joints_struck_) joints_.begin_settling();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        if (some_joints_struck_) joints_.settle(view_, biased);
        for (Section& s : sections_) {
            if (s.settling.empty()) continue;
            const Passes<D>& passes = s.settling.passes();
            (biased ? passes.solve_with_friction : passes.relax)(s.settling.span(), view_, sub_);
        }
    }
    for (Section& s : sections_) return_struck(s);
    if (some_joints_struck_) joints_.end_settling();
}

/// The joints near bodies that were struck. Are there any?
template <int D>
bool Solver<D>::pick_struck_joints() {
    struck_jointed_.clear();
    for (Section& s : sections_) {
        for (const std::uint32_t place : s.struck) {
            for (const std::uint32_t slot : {s.contacts.a(place), s.contacts.b(place)}) {
                if (slot >= view_.first_movable && jointed_[slot]) struck_jointed_.push_back(slot);
            }
        }
    }
    std::ranges::sort(struck_jointed_);
    const auto doubles = std::ranges::unique(struck_jointed_);
    struck_jointed_.erase(doubles.begin(), doubles.end());
    return !struck_jointed_.empty() && joints_.pick_near(struck_jointed_);
}

template <int D>
void Solver<D>::mark_struck_bodies() {
    for (const std::uint32_t slot : struck_slots_) is_struck_[slot] = 0;
    struck_slots_.clear();
    is_struck_.resize(std::max<std::size_t>(is_struck_.size(), slots_.size()), 0);
    const auto mark = [&](std::uint32_t slot) {
        if (slot < view_.first_movable || is_struck_[slot] || jointed_[slot]) return;
        is_struck_[slot] = 1;
        struck_slots_.push_back(slot);
    };
    for (Section& s : sections_) {
        for (const std::uint32_t place : s.struck) {
            mark(s.contacts.a(place));
            mark(s.contacts.b(place));
        }
    }
}

/// The many small changes of settling are each rounded to the size of the velocity. So the velocities of
/// these bodies are made anew, in one sum, from the impulses that came out. Those on joints stay as they are:
/// what joints do is not in the sum.
template <int D>
void Solver<D>::sum_struck() {
    mark_struck_bodies();
    RecordView<D> sums = view_;
    const auto clear = [&](std::uint32_t slot) {
        Body<D, float> body = gather<float>(sums, &slot);
        body.motion = {};
        scatter_velocity(sums, &slot, body, false);
    };
    if (!sums_begun_) {
        sums_ = records_;
        sums.records = sums_.data();
        for (std::uint32_t slot = 1; slot < slots_.size(); ++slot) clear(slot);
        sums_begun_ = true;
    }
    sums.records = sums_.data();
    wanted_.clear();
    for (Section& s : sections_) {
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block) {
            const BlockSpan<D> one = s.contacts.span(block, 1);
            bool wanted = false;
            for (std::size_t lane = 0; lane < s.contacts.width(); ++lane)
                wanted |= is_struck_[one.a[lane]] || is_struck_[one.b[lane]];
            if (!wanted) continue;
            passes_of(s).warm_start(one, sums);
            wanted_.push_back({one, s.contacts.width()});
        }
    }
    for (const std::uint32_t slot : struck_slots_) {
        Drive<D, float> drive = drives_.get(slot);
        Body<D, float> body = gather<float>(view_, &slot);
        const Motion<D, float> sum = gather<float>(sums, &slot).motion;
        drive.lost = drive.lost_before;
        drive.lost_spin = drive.lost_spin_before;
        push_velocity(body.motion, drive, sum.v, sum.w, h_);
        drives_.set(slot, drive);
        scatter_velocity(view_, &slot, body, false);
    }
    for (const auto& [block, width] : wanted_) {
        for (std::size_t lane = 0; lane < width; ++lane) {
            clear(block.a[lane]);
            clear(block.b[lane]);
        }
    }
}

#define CAROM_INSTANTIATE(D)                         \
    template bool Solver<D>::find_struck();          \
    template bool Solver<D>::pick_struck_joints();   \
    template void Solver<D>::note_blows();           \
    template void Solver<D>::forget_last_blows();    \
    template void Solver<D>::settle_struck<true>();  \
    template void Solver<D>::settle_struck<false>(); \
    template void Solver<D>::sum_struck();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
