#include "solver/joint_solver.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "simd/width.hpp"
#include "solver/direct.hpp"
#include "solver/joint_groups.hpp"
#include "solver/joint_load.hpp"

namespace carom::detail {

template <int D>
JointSolver<D>::JointSolver()
    : groups_(std::make_unique<JointGroups<D>>()), direct_(std::make_unique<DirectSolver<D>>()) {}
template <int D>
JointSolver<D>::~JointSolver() = default;

template <int D>
bool JointSolver<D>::is_small() const {
    return joint_.size() + 4 * direct_->size() < 256;
}

template <int D>
void JointSolver<D>::plan(const JointInput<D>& input) {
    first_movable_ = input.bodies.first_movable;
    couplings_.plan(input);
    direct_->set_step(input.substep);
    step_ = joint_step(input.substep);
    is_fresh_ = is_stale_;
    if (!is_stale_) return;
    let_go(input.joints);
    is_stale_ = false;
    batches_.clear();
    joint_.clear();
    place_of_.assign(input.joints.size(), none);
    ties_listed_ = false;
    if (groups_->plan(input)) direct_->plan(input, groups_->direct(), groups_->starts());
    if (groups_->iterative().empty()) return;
    JointInput<D> rest = input;
    rest.active = groups_->iterative();
    wide_ = &joint_programs<D>(lane_width());
    colour(rest);
    make_batches(rest);
    holds_ = true;
}

template <int D>
void JointSolver<D>::let_go(std::span<JointRecord<D>> joints) {
    if (!holds_) return;
    for (const std::uint32_t joint : joint_) {
        if (joint != none) read(joint, joints[joint]);
    }
    holds_ = false;
    is_stale_ = true;
}

template <int D>
void JointSolver<D>::read(std::uint32_t joint, JointRecord<D>& record) const {
    if (!holds_ || joint >= place_of_.size() || place_of_[joint] == none) return;
    const std::size_t place = place_of_[joint];
    const Batch& batch = *std::prev(std::ranges::upper_bound(batches_, place, {}, &Batch::first_place));
    const JointLoader<D>& loader = joint_loaders<D>()[batch.layout];
    const std::size_t i = place - batch.first_place, width = batch.width;
    loader.store(record, rows(batch) + i / width * loader.fields * width + i % width, width);
}

template <int D>
template <class Visit>
void JointSolver<D>::each_share(const Crew& crew, bool writes_bodies, Visit&& visit) const {
    constexpr std::size_t least_blocks = 4;
    for (std::size_t i = 0; i < batches_.size(); ++i) {
        const Batch& batch = batches_[i];
        const bool one_by_one = writes_bodies && batch.colour == overflow;
        const Part part =
            one_by_one ? Part{0, crew.is_first() ? batch.blocks : 0} : crew.part(batch.blocks, least_blocks);
        if (part.size() > 0) visit(batch, part);
        const bool last_of_colour = i + 1 == batches_.size() || batches_[i + 1].colour != batch.colour;
        if (writes_bodies && last_of_colour) crew.meet();
    }
}

template <int D>
void JointSolver<D>::prepare(const JointInput<D>& input, const Crew& crew) {
    each_share(crew, false, [&](const Batch& batch, const Part& part) { fill(input, batch, part); });
    direct_->load(input, crew);
    // Bodies are loaded, and rows that others filled are read.
    crew.meet();
    crew.alone([&] { couplings_.prepare(input); });
    each_share(crew, true, [&](const Batch& batch, const Part& part) {
        program(batch).start(span(batch, part), input.bodies);
    });
    if (!direct_->any()) return;
    direct_->start(input.bodies, crew);
    crew.meet();
}

/// Greedy colouring in the order of the joints: the first colour that neither body has yet.
template <int D>
void JointSolver<D>::colour(const JointInput<D>& input) {
    taken_.assign(input.slots.size(), 0);
    colour_.resize(input.active.size());
    const auto is_movable = [&](std::uint32_t slot) { return slot >= input.bodies.first_movable; };
    for (std::size_t i = 0; i < input.active.size(); ++i) {
        const JointRecord<D>& joint = input.joints[input.active[i]];
        const std::uint32_t a = input.slot_of(joint.body_a), b = input.slot_of(joint.body_b);
        const std::uint64_t taken = (is_movable(a) ? taken_[a] : 0) | (is_movable(b) ? taken_[b] : 0);
        const int free = std::countr_one(taken);
        const std::uint64_t bit = free == overflow ? 0 : std::uint64_t{1} << free;
        if (is_movable(a)) taken_[a] |= bit;
        if (is_movable(b)) taken_[b] |= bit;
        colour_[i] = static_cast<std::uint8_t>(free);
    }
}

template <int D>
void JointSolver<D>::make_batches(const JointInput<D>& input) {
    std::array<std::array<std::uint32_t, layout_count>, colours + 1> next{};
    for (std::size_t i = 0; i < input.active.size(); ++i)
        ++next[colour_[i]][input.joints[input.active[i]].layout];
    std::size_t places = 0, blocks = 0, floats = 0;
    for (int c = 0; c <= colours; ++c) {
        for (std::uint32_t layout = 0; layout < layout_count; ++layout) {
            std::uint32_t& count = next[c][layout];
            if (count == 0) continue;
            const std::uint32_t width = c == overflow ? 1 : static_cast<std::uint32_t>(wide_->width);
            const std::size_t of_batch = (count + width - 1) / width;
            batches_.push_back({c, layout, width, places, blocks, of_batch, floats});
            count = static_cast<std::uint32_t>(places);  // from now on the next free place
            places += of_batch * width;
            blocks += of_batch;
            floats += (of_batch * width * joint_loaders<D>()[layout].fields + 15) / 16 * 16;
        }
    }
    joint_.assign(places, none);
    a_.assign(places, BodySlots::still);
    b_.assign(places, BodySlots::still);
    body_a_.assign(places, 0);
    body_b_.assign(places, 0);
    constexpr std::size_t stride = JointSites<D>::anchor_stride;
    anchors_.assign(places * stride, 0);
    some_fixed_.assign(blocks, 0);
    in_world_.assign(blocks, 0);
    // Lanes without a joint are to hold zeros.
    lines_.assign((floats + 15) / 16, Line{});
    for (std::size_t i = 0; i < input.active.size(); ++i) {
        const JointRecord<D>& joint = input.joints[input.active[i]];
        const std::size_t place = next[colour_[i]][joint.layout]++;
        place_of_[input.active[i]] = static_cast<std::uint32_t>(place);
        joint_[place] = input.active[i];
        a_[place] = input.slot_of(joint.body_a);
        b_[place] = input.slot_of(joint.body_b);
        body_b_[place] = joint.body_b;
        const auto set_anchor = [&](std::size_t from, std::uint32_t body, const Vec<D>& anchor) {
            const Vec<D> arm = anchor - input.masses[body].center;
            for (int k = 0; k < D; ++k) anchors_[place * stride + from + k] = arm[k];
        };
        set_anchor(D, joint.body_b, joint.anchor_b);
        if (joint.body_a == no_body) continue;
        body_a_[place] = joint.body_a;
        set_anchor(0, joint.body_a, joint.anchor_a);
    }
    for (const Batch& batch : batches_) mark_blocks(batch, input);
}

/// What lanes of the blocks of a batch have in common.
template <int D>
void JointSolver<D>::mark_blocks(const Batch& batch, const JointInput<D>& input) {
    for (std::size_t i = 0; i < batch.blocks * batch.width; ++i) {
        const std::size_t place = batch.first_place + i, block = batch.first_block + i / batch.width;
        const std::uint32_t first = input.bodies.first_movable;
        some_fixed_[block] |= a_[place] < first || b_[place] < first ? 1 : 0;
        in_world_[block] |= joint_[place] != none && input.joints[joint_[place]].body_a == no_body ? 1 : 0;
    }
}

/// Brings rows to where the bodies are at the start of the step.
template <int D>
void JointSolver<D>::fill(const JointInput<D>& input, const Batch& batch, const Part& part) {
    const auto place = program(batch).place;
    for (std::size_t block = part.begin; block < part.end; ++block) {
        if (!place || is_fresh_ || in_world_[batch.first_block + block]) {
            load(input, batch, block);
            continue;
        }
        const std::size_t first = batch.first_place + block * batch.width;
        place(span(batch, {block, block + 1}),
              {reinterpret_cast<const double*>(input.states.data()), body_a_.data() + first,
               body_b_.data() + first, anchors_.data() + first * JointSites<D>::anchor_stride});
    }
}

/// The same for one block, joint by joint.
template <int D>
void JointSolver<D>::load(const JointInput<D>& input, const Batch& batch, std::size_t block) {
    const JointLoader<D>& loader = joint_loaders<D>()[batch.layout];
    const bool has_drives = layouts<D>[batch.layout].drive_count > 0;
    float* to = rows(batch) + block * loader.fields * batch.width;
    for (std::size_t lane = 0; lane < batch.width; ++lane) {
        const std::uint32_t i = joint_[batch.first_place + block * batch.width + lane];
        if (i == none) continue;
        JointRecord<D>& joint = input.joints[i];
        if (is_fresh_) loader.take(joint, to + lane, batch.width);
        loader.load(joint, pose_of<D>(joint, input.states, input.masses, has_drives), input.states,
                    input.masses, input.substep, to + lane, batch.width);
    }
}

template <int D>
const JointProgram<D>& JointSolver<D>::program(const Batch& batch) const {
    const bool is_wide = batch.width == static_cast<std::uint32_t>(wide_->width);
    return (is_wide ? *wide_ : joint_programs<D>(1)).of_layout[batch.layout];
}

template <int D>
JointSpan JointSolver<D>::span(const Batch& batch, const Part& part) {
    const std::size_t place = batch.first_place + part.begin * batch.width;
    return {rows(batch) + part.begin * joint_loaders<D>()[batch.layout].fields * batch.width,
            a_.data() + place, b_.data() + place, some_fixed_.data() + batch.first_block + part.begin,
            part.size()};
}

template <int D>
void JointSolver<D>::solve(const RecordView<D>& bodies, const Crew& crew) {
    if (couplings_.any()) crew.alone([&] { couplings_.solve(bodies); });
    each_share(crew, true, [&](const Batch& batch, const Part& part) {
        program(batch).solve(span(batch, part), bodies, step_);
    });
    if (!direct_->any()) return;
    direct_->solve(bodies, crew);
    crew.meet();
}

template <int D>
void JointSolver<D>::relax(const RecordView<D>& bodies, const Crew& crew) {
    if (couplings_.any()) crew.alone([&] { couplings_.relax(bodies); });
    each_share(crew, true, [&](const Batch& batch, const Part& part) {
        program(batch).relax(span(batch, part), bodies, step_);
    });
    if (!direct_->any()) return;
    direct_->relax(bodies, crew);
    crew.meet();
}

template <int D>
void JointSolver<D>::store(const JointInput<D>& input, const Crew& crew) const {
    if (crew.is_first()) couplings_.store(input);
    direct_->store(input, crew);
}

template class JointSolver<2>;
template class JointSolver<3>;

}  // namespace carom::detail
