#include <algorithm>

#include "solver/solver.hpp"

/// Contacts that begin. They have no impulses to start from, and one pass over their rows leaves their points
/// unequal: a box that lands flat would tilt, and one put on a slope would slip before it holds. So the rows
/// of these contacts are solved, friction included, until their points agree.
namespace carom::detail {

/// A contact that takes more speed than this in a sub-step was hit, and does not just begin to carry.
constexpr float blow_speed = 0.25f;  // m/s

/// Finds the contacts to be settled: those that carry their first impulse, and those that were hit in the
/// sub-step before.
template <int D>
void Solver<D>::find_struck() {
    constexpr std::size_t worth_all_workers = 512;
    std::size_t count = 0;
    each_used([&](Section& s) {
        s.struck.clear();
        s.begun.clear();
        s.struck.swap(s.hit);
        each_bit(
            s, [&](std::size_t block) { return s.waiting[block] & s.contacts.found(block); },
            [&](std::uint32_t index) { s.begun.push_back(index); });
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block)
            s.waiting[block] &= ~s.contacts.found(block);
        s.struck.insert(s.struck.end(), s.begun.begin(), s.begun.end());
        count += s.struck.size();
        s.settling.clear(s.contacts.passes());
        if (!s.struck.empty()) s.settling.append(s.struck.size());
    });
    some_struck_ = count > 0;
    many_struck_ = count >= worth_all_workers;
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
    each_used([&](Section& s) {
        for (const std::uint32_t index : s.begun) {
            if (speed_taken(s.contacts.rows(), index) > blow_speed) s.hit.push_back(index);
        }
    });
}

/// The impulse of a blow in the last sub-step is nothing for the next step to begin with.
template <int D>
void Solver<D>::forget_last_blows() {
    each_used([&](Section& s) {
        for (const std::uint32_t index : s.hit) {
            Rows rows = s.contacts.rows().get(index);
            for (NormalRow<D, float>& p : rows.points) p.impulse = 0;
            rows.friction_impulse = {};
            if constexpr (D == 3) rows.twist_impulse = 0;
            rows.rolling_impulse = {};
            s.contacts.rows().set(index, rows);
        }
    });
}

template <int D>
void Solver<D>::copy_struck(Section& s, const Part& places) {
    const std::size_t width = s.settling.width();
    for (std::size_t place = places.begin; place < places.end; ++place) {
        std::uint8_t& traits = s.settling.traits(place / width);
        if (place % width == 0) traits = 0;
        if (place >= s.struck.size()) {
            s.settling.rows().set(place, {});
            s.settling.a(place) = s.settling.b(place) = s.settling.nobody;
            traits |= some_fixed;
            continue;
        }
        const std::uint32_t from = s.struck[place];
        s.settling.rows().set(place, s.contacts.rows().get(from));
        s.settling.a(place) = record_of<D>(s.contacts.a(from));
        s.settling.b(place) = record_of<D>(s.contacts.b(from));
        traits |= s.contacts.traits(from / s.contacts.width());
    }
}

template <int D>
void Solver<D>::return_struck(Section& s, const Part& places) {
    static constexpr Rows model{};
    const auto give_back = [&](std::size_t place, const float& member) {
        const std::size_t field = field_of(model, member);
        s.contacts.rows().at(s.struck[place], field) = s.settling.rows().at(place, field);
    };
    for (std::size_t place = places.begin; place < std::min(places.end, s.struck.size()); ++place) {
        for (const NormalRow<D, float>& p : model.points) give_back(place, p.impulse);
        for (const float& impulse : model.friction_impulse) give_back(place, impulse);
        if constexpr (D == 3) give_back(place, model.twist_impulse);
        if (!(s.settling.traits(place / s.settling.width()) & some_rolling)) continue;
        if constexpr (D == 2) {
            give_back(place, model.rolling_impulse);
        } else {
            for (int k = 0; k < 3; ++k) give_back(place, model.rolling_impulse[k]);
        }
    }
}

/// `visit(section, blocks)` for a share of the copies; those of the overflow are for the first worker alone.
/// Where bodies are written, the workers wait for one another after each colour.
template <int D>
template <class Visit>
void Solver<D>::each_settling(const Crew& crew, bool writes_bodies, Visit&& visit) {
    each_used([&](Section& s) {
        if (s.settling.empty()) return;
        const bool one_by_one = &s == &sections_[Colours::overflow];
        const Part blocks =
            one_by_one ? Part{0, crew.is_first() ? s.settling.blocks() : 0} : crew.part(s.settling.blocks());
        if (blocks.size() > 0) visit(s, blocks);
        if (writes_bodies) crew.meet();
    });
}

template <int D>
template <bool biased>
void Solver<D>::settle_struck(const Crew& crew) {
    constexpr int sweeps = 8;
    const auto places = [](const Section& s, const Part& blocks) {
        return Part{blocks.begin * s.settling.width(), blocks.end * s.settling.width()};
    };
    each_settling(crew, false, [&](Section& s, const Part& blocks) { copy_struck(s, places(s, blocks)); });
    if (crew.is_first() && some_joints_struck_) joints_.begin_settling();
    crew.meet();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        if (some_joints_struck_) crew.alone([&] { joints_.settle(view_, biased); });
        each_settling(crew, true, [&](Section& s, const Part& blocks) {
            const Passes<D>& passes = s.settling.passes();
            const BlockSpan<D> span = s.settling.span(blocks.begin, blocks.size());
            (biased ? passes.solve_with_friction : passes.relax)(span, view_, sub_);
        });
    }
    each_settling(crew, false, [&](Section& s, const Part& blocks) { return_struck(s, places(s, blocks)); });
    if (crew.is_first() && some_joints_struck_) joints_.end_settling();
    crew.meet();
}

template <int D>
template <bool biased>
void Solver<D>::settle(const Crew& crew) {
    if (many_struck_) return settle_struck<biased>(crew);
    crew.alone([&] {
        if (some_struck_) settle_struck<biased>(Crew());
    });
}

/// The joints near bodies that were struck. Are there any?
template <int D>
bool Solver<D>::pick_struck_joints() {
    struck_jointed_.clear();
    each_used([&](Section& s) {
        for (const std::uint32_t place : s.struck) {
            for (const std::uint32_t slot : {s.contacts.a(place), s.contacts.b(place)}) {
                if (slot >= view_.first_movable && jointed_[slot]) struck_jointed_.push_back(slot);
            }
        }
    });
    std::ranges::sort(struck_jointed_);
    const auto doubles = std::ranges::unique(struck_jointed_);
    struck_jointed_.erase(doubles.begin(), doubles.end());
    return !struck_jointed_.empty() && joints_.pick_near(struck_jointed_);
}

template <int D>
void Solver<D>::mark_struck_bodies() {
    for (const std::uint32_t slot : struck_slots_) is_struck_[slot] = 0;
    struck_slots_.clear();
    struck_groups_ = 0;
    is_struck_.resize(std::max<std::size_t>(is_struck_.size(), slots_.size()), 0);
    const auto mark = [&](std::uint32_t slot) {
        if (slot < view_.first_movable || is_struck_[slot] || jointed_[slot]) return;
        is_struck_[slot] = 1;
        struck_groups_ |= group_bit(slot);
        struck_slots_.push_back(slot);
    };
    each_used([&](Section& s) {
        for (const std::uint32_t place : s.struck) {
            mark(s.contacts.a(place));
            mark(s.contacts.b(place));
        }
    });
}

/// Finds the blocks with contacts of struck bodies.
template <int D>
void Solver<D>::find_struck_blocks(const Crew& crew) {
    each_used([&](Section& s) {
        const Part part = crew.part(s.contacts.blocks());
        const std::size_t width = s.contacts.width();
        for (std::size_t block = part.begin; block < part.end; ++block) {
            const std::size_t first = block * width, end = first + width;
            if (!groups_known_) {
                s.groups[block] = 0;
                for (std::size_t i = first; i < end; ++i)
                    s.groups[block] |= group_bit(s.contacts.a(i)) | group_bit(s.contacts.b(i));
            }
            s.has_struck[block] = 0;
            if (!(s.groups[block] & struck_groups_)) continue;
            for (std::size_t i = first; i < end; ++i)
                s.has_struck[block] |= is_struck_[s.contacts.a(i)] | is_struck_[s.contacts.b(i)];
        }
    });
    crew.meet();
}

/// The many small changes of settling are each rounded to the size of the velocity. So the velocities of
/// these bodies are made anew, in one sum, from the impulses that came out. Those on joints stay as they are:
/// what joints do is not in the sum.
template <int D>
void Solver<D>::sum_struck() {
    groups_known_ = true;
    sums_.resize(records_.size());
    RecordView<D> sums = view_;
    sums.records = sums_.data();
    // What the blocks give to other bodies is not looked at.
    for (const std::uint32_t slot : struck_slots_) {
        Body<D, float> body = gather<float>(view_, &slot);
        body.motion = {};
        write_record(sums, &slot, body);
    }
    wanted_.clear();
    each_used([&](Section& s) {
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block) {
            if (s.has_struck[block]) wanted_.push_back({s.contacts.span(block, 1), &passes_of(s)});
        }
    });
    for (const auto& [block, passes] : wanted_) passes->warm_start(block, sums);
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
}

#define CAROM_INSTANTIATE(D)                                       \
    template void Solver<D>::find_struck();                        \
    template bool Solver<D>::pick_struck_joints();                 \
    template void Solver<D>::note_blows();                         \
    template void Solver<D>::forget_last_blows();                  \
    template void Solver<D>::settle<true>(const Crew&);            \
    template void Solver<D>::settle<false>(const Crew&);           \
    template void Solver<D>::mark_struck_bodies();                 \
    template void Solver<D>::find_struck_blocks(const Crew& crew); \
    template void Solver<D>::sum_struck();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
