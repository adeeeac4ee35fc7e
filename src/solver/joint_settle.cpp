#include <algorithm>

#include "simd/width.hpp"
#include "solver/direct.hpp"
#include "solver/joint_groups.hpp"
#include "solver/joint_load.hpp"
#include "solver/joint_solver.hpp"

/// Joints of bodies that were hit. A blow stops the one bone of a figure that it meets, and one pass over
/// contacts and joints tells the others of it one after another, a sub-step each: joints are torn apart until
/// they know. So these joints are solved along with the contacts that were hit until both agree.
namespace carom::detail {

/// Which joints hold a body.
template <int D>
void JointSolver<D>::list_ties() {
    ties_listed_ = true;
    const std::size_t slots = taken_.size();
    first_tie_.assign(slots + 1, 0);
    const auto each = [&](auto&& visit) {
        for (std::size_t place = 0; place < joint_.size(); ++place) {
            if (joint_[place] == none) continue;
            visit(a_[place], place);
            visit(b_[place], place);
        }
    };
    each([&](std::uint32_t slot, std::size_t) { ++first_tie_[slot + 1]; });
    for (std::size_t slot = 0; slot < slots; ++slot) first_tie_[slot + 1] += first_tie_[slot];
    ties_.resize(first_tie_[slots]);
    std::vector<std::uint32_t> next(first_tie_.begin(), first_tie_.end() - 1);
    each([&](std::uint32_t slot, std::size_t place) {
        ties_[next[slot]++] = static_cast<std::uint32_t>(place);
    });
}

template <int D>
bool JointSolver<D>::pick_near(std::span<const std::uint32_t> slots) {
    constexpr int reach = 8;  // joints from the blow
    picked_.clear();
    near_.assign(slots.begin(), slots.end());
    const bool some_direct = direct_->any() && direct_->pick(slots);
    if (joint_.empty()) return some_direct;
    if (!ties_listed_) list_ties();
    is_picked_.assign(joint_.size(), 0);
    for (std::size_t begin = 0, way = 0; way < reach && begin < near_.size(); ++way) {
        const std::size_t end = near_.size();
        for (; begin < end; ++begin) {
            const std::uint32_t slot = near_[begin];
            for (std::uint32_t k = first_tie_[slot]; k < first_tie_[slot + 1]; ++k) {
                const std::uint32_t place = ties_[k];
                if (is_picked_[place]) continue;
                is_picked_[place] = 1;
                picked_.push_back(place);
                const std::uint32_t other = a_[place] == slot ? b_[place] : a_[place];
                if (other >= first_movable_) near_.push_back(other);
            }
        }
    }
    std::ranges::sort(picked_);
    return some_direct || !picked_.empty();
}

template <int D>
void JointSolver<D>::copy_picked(bool back) {
    for (const Picked& p : of_batch_) {
        const std::size_t width = p.batch.width, fields = joint_loaders<D>()[p.batch.layout].fields;
        float* near = picked_lines_[0].floats.data() + p.batch.first_float;
        for (std::uint32_t k = 0; k < p.count; ++k) {
            const std::size_t place = picked_[p.first + k] - p.from->first_place;
            float* from = rows(*p.from) + place / width * fields * width + place % width;
            float* to = near + k / width * fields * width + k % width;
            for (std::size_t f = 0; f < fields; ++f)
                (back ? from : to)[f * width] = (back ? to : from)[f * width];
        }
    }
}

template <int D>
void JointSolver<D>::begin_settling() {
    of_batch_.clear();
    std::size_t places = 0, blocks = 0, floats = 0;
    std::uint32_t next = 0;
    for (const Batch& batch : batches_) {
        const std::size_t end = batch.first_place + batch.blocks * batch.width;
        const std::uint32_t first = next;
        while (next < picked_.size() && picked_[next] < end) ++next;
        if (next == first) continue;
        Batch near = batch;
        near.blocks = (next - first + batch.width - 1) / batch.width;
        near.first_place = places;
        near.first_block = blocks;
        near.first_float = floats;
        of_batch_.push_back({near, &batch, first, next - first});
        places += near.blocks * near.width;
        blocks += near.blocks;
        floats += (near.blocks * near.width * joint_loaders<D>()[batch.layout].fields + 15) / 16 * 16;
    }
    if (of_batch_.empty()) return;
    picked_a_.assign(places, BodySlots::still);
    picked_b_.assign(places, BodySlots::still);
    picked_fixed_.assign(blocks, 0);
    picked_lines_.assign(floats / 16, Line{});
    for (const Picked& p : of_batch_) {
        for (std::size_t k = 0; k < p.batch.blocks * p.batch.width; ++k) {
            const bool is_joint = k < p.count;
            const std::size_t place = p.batch.first_place + k;
            if (is_joint) {
                picked_a_[place] = a_[picked_[p.first + k]];
                picked_b_[place] = b_[picked_[p.first + k]];
            }
            if (picked_a_[place] < first_movable_ || picked_b_[place] < first_movable_)
                picked_fixed_[p.batch.first_block + k / p.batch.width] = 1;
        }
    }
    copy_picked(false);
}

template <int D>
void JointSolver<D>::settle(const RecordView<D>& bodies, bool before_moving) {
    JointStep<float> step = step_;
    step.again = true;
    step.share = 0;
    for (const Picked& p : of_batch_) {
        const JointProgram<D>& passes = program(p.batch);
        (before_moving ? passes.solve : passes.relax)(
            {picked_lines_[0].floats.data() + p.batch.first_float, picked_a_.data() + p.batch.first_place,
             picked_b_.data() + p.batch.first_place, picked_fixed_.data() + p.batch.first_block,
             p.batch.blocks},
            bodies, step);
    }
    if (direct_->any()) direct_->settle(bodies, before_moving);
}

template <int D>
void JointSolver<D>::end_settling() {
    copy_picked(true);
}

#define CAROM_INSTANTIATE(D)                                                 \
    template bool JointSolver<D>::pick_near(std::span<const std::uint32_t>); \
    template void JointSolver<D>::begin_settling();                          \
    template void JointSolver<D>::settle(const RecordView<D>&, bool);        \
    template void JointSolver<D>::end_settling();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
