#include <algorithm>

#include "solver/solver.hpp"

/// Contacts that begin. They have no impulses to start from, and one pass over their rows leaves their points
/// unequal: a box that lands flat would tilt, and one put on a slope would slip before it holds. So the rows
/// of these contacts are solved, friction included, until their points agree.
namespace carom::detail {

/// A contact that takes more speed than this in a sub-step was hit, and does not just begin to carry.
constexpr float blow_speed = 0.25f;  // m/s

/// Finds the contacts that have begun to carry an impulse. Are there any?
template <int D>
bool Solver<D>::find_struck() {
    using Stage = typename Unsettled::Stage;
    bool some = false;
    for (Section& s : sections_) {
        s.struck.clear();
        const LaneStore<Rows>& rows = s.blocks.rows();
        for (Unsettled& contact : s.unsettled) {
            if (contact.stage == Stage::was_hit)
                contact.stage = Stage::ends;
            else if (carries_impulse(rows, contact.place))
                contact.stage = Stage::begins;
            else
                continue;
            s.struck.push_back(contact.place);
        }
        some |= !s.struck.empty();
    }
    return some;
}

/// Of the contacts that began in this sub-step, those that were hit are to be settled once more.
template <int D>
void Solver<D>::note_blows() {
    using Stage = typename Unsettled::Stage;
    for (Section& s : sections_) {
        std::erase_if(s.unsettled, [&](Unsettled& contact) {
            if (contact.stage == Stage::waits) return false;
            const bool hit =
                contact.stage == Stage::begins && speed_taken(s.blocks.rows(), contact.place) > blow_speed;
            contact.stage = Stage::was_hit;
            return !hit;
        });
    }
}

/// The impulse of a blow in the last sub-step is nothing for the next step to begin with.
template <int D>
void Solver<D>::forget_last_blows() {
    for (Section& s : sections_) {
        for (const Unsettled& contact : s.unsettled) {
            if (contact.stage != Unsettled::Stage::was_hit) continue;
            Rows rows = s.blocks.rows().get(contact.place);
            for (NormalRow<D, float>& p : rows.points) p.impulse = 0;
            rows.friction_impulse = {};
            rows.twist_impulse = 0;
            rows.rolling_impulse = {};
            s.blocks.rows().set(contact.place, rows);
        }
    }
}

/// Copies the struck contacts into blocks of their own, those of a colour side by side.
template <int D>
void Solver<D>::copy_struck(Section& s) {
    s.settling.clear(s.blocks.passes());
    s.sources.clear();
    for (std::size_t first = 0; first < s.struck.size();) {
        const auto colour_end =
            std::upper_bound(s.colour_starts.begin(), s.colour_starts.end(), s.struck[first]);
        std::size_t last = first + 1;
        while (s.settling.width() > 1 && last < s.struck.size() &&
               (colour_end == s.colour_starts.end() || s.struck[last] < *colour_end))
            ++last;
        s.settling.append(last - first);
        s.sources.insert(s.sources.end(), s.struck.begin() + first, s.struck.begin() + last);
        s.sources.resize(s.settling.places(), none);
        first = last;
    }
    for (std::size_t place = 0; place < s.sources.size(); ++place) {
        const std::uint32_t from = s.sources[place];
        std::uint8_t& traits = s.settling.traits(place / s.settling.width());
        if (from == none) {
            s.settling.rows().set(place, {});
            traits |= some_fixed;
            continue;
        }
        s.settling.rows().set(place, s.blocks.rows().get(from));
        s.settling.a(place) = s.blocks.a(from);
        s.settling.b(place) = s.blocks.b(from);
        traits |= s.blocks.traits(from / s.blocks.width());
    }
}

template <int D>
void Solver<D>::return_struck(Section& s) {
    for (std::size_t place = 0; place < s.sources.size(); ++place) {
        if (s.sources[place] != none) s.blocks.rows().set(s.sources[place], s.settling.rows().get(place));
    }
}

template <int D>
template <bool biased>
void Solver<D>::settle_struck() {
    constexpr int sweeps = 8;
    for (Section& s : sections_) copy_struck(s);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Section& s : sections_) {
            if (s.settling.empty()) continue;
            const Passes<D>& passes = s.settling.passes();
            (biased ? passes.solve_with_friction : passes.relax)(s.settling.span(), view_, sub_);
        }
    }
    for (Section& s : sections_) return_struck(s);
}

template <int D>
void Solver<D>::mark_struck_bodies() {
    for (const std::uint32_t slot : struck_slots_) is_struck_[slot] = 0;
    struck_slots_.clear();
    is_struck_.resize(std::max(is_struck_.size(), bodies_.size()), 0);
    const auto mark = [&](std::uint32_t slot) {
        if (slot < view_.first_movable || is_struck_[slot]) return;
        is_struck_[slot] = 1;
        struck_slots_.push_back(slot);
    };
    for (Section& s : sections_) {
        for (const std::uint32_t place : s.struck) {
            mark(s.blocks.a(place));
            mark(s.blocks.b(place));
        }
    }
}

/// The many small changes of settling are each rounded to the size of the velocity. So the velocities of
/// these bodies are made anew, in one sum, from the impulses that came out.
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
        for (std::uint32_t slot = 1; slot < bodies_.size(); ++slot) clear(slot);
        sums_begun_ = true;
    }
    sums.records = sums_.data();
    wanted_.clear();
    for (Section& s : sections_) {
        for (std::size_t block = 0; block < s.blocks.blocks(); ++block) {
            const BlockSpan<D> one = s.blocks.span(block, 1);
            bool wanted = false;
            for (std::size_t lane = 0; lane < s.blocks.width(); ++lane)
                wanted |= is_struck_[one.a[lane]] || is_struck_[one.b[lane]];
            if (!wanted) continue;
            s.blocks.passes().warm_start(one, sums);
            wanted_.push_back({one, s.blocks.width()});
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
    template void Solver<D>::note_blows();           \
    template void Solver<D>::forget_last_blows();    \
    template void Solver<D>::settle_struck<true>();  \
    template void Solver<D>::settle_struck<false>(); \
    template void Solver<D>::sum_struck();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
