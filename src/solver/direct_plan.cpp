#include <algorithm>
#include <map>

#include "solver/direct.hpp"

// Which joints that are solved directly share a body, and where their blocks are.

namespace carom::detail {

namespace {

/// Compliance of the rows, in parts of their own: where rows say what others say as well, they share the
/// impulse. That cannot be in a tree.
constexpr double compliance_in_tree = 1e-10, compliance_in_loops = 1e-6;

}  // namespace

template <int D>
void DirectSolver<D>::set_step(double substep) {
    const JointStep<float> step = joint_step(substep);
    step_ = {substep, 1 / substep, step.share, step.most_way};
}

template <int D>
void DirectSolver<D>::plan(const JointInput<D>& input, std::span<const std::uint32_t> joints,
                           std::span<const std::uint32_t> group_starts) {
    joints_.clear();
    groups_.clear();
    members_.clear();
    ties_.clear();
    for (std::size_t i = 0; i < group_starts.size(); ++i) {
        const std::size_t end = i + 1 < group_starts.size() ? group_starts[i + 1] : joints.size();
        add_group(input, joints.subspan(group_starts[i], end - group_starts[i]));
    }
    group_of_.assign(input.slots.size(), ~std::uint32_t{0});
    for (std::uint32_t i = 0; i < groups_.size(); ++i) {
        for (std::uint32_t k = groups_[i].first_body; k < groups_[i].last_body; ++k) {
            if (members_[k].slot >= input.bodies.first_movable) group_of_[members_[k].slot] = i;
        }
    }
    std::vector<std::uint8_t> sizes;
    std::vector<NodePair> pairs;
    for (const DirectJoint<D>& j : joints_) sizes.push_back(static_cast<std::uint8_t>(j.row_count()));
    for (const Tie& tie : ties_) pairs.push_back({tie.row, tie.column});
    matrix_.plan(sizes, pairs);
    for (Tie& tie : ties_) tie.place = matrix_.place({tie.row, tie.column});
    for (std::uint32_t k = 0; k < joints_.size(); ++k) joints_[k].first_row = matrix_.first_row(k);
    rows_.assign(matrix_.rows(), {});
    effects_.assign(matrix_.rows(), {});
    laws_.assign(matrix_.rows(), {});
    open_.assign(matrix_.rows(), 1);
    constexpr std::size_t n = DirectJoint<D>::most_rows;
    own_.assign(joints_.size() * n * n, 0);
    alone_.assign(joints_.size() * n * n, 0);
    arms_.assign(joints_.size(), {});
    right_.assign(matrix_.rows(), 0);
}

template <int D>
void DirectSolver<D>::add_group(const JointInput<D>& input, std::span<const std::uint32_t> joints) {
    Group group;
    group.first_joint = static_cast<std::uint32_t>(joints_.size());
    group.first_body = static_cast<std::uint32_t>(members_.size());
    std::map<std::uint32_t, std::vector<std::uint32_t>> joints_of;  // by slot, of bodies that can be pushed
    std::map<std::uint32_t, std::uint32_t> member_of;
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
        const JointRecord<D>& joint = input.joints[joints[i]];
        for (const std::uint32_t slot : {input.slot_of(joint.body_a), input.slot_of(joint.body_b)}) {
            if (member_of.emplace(slot, static_cast<std::uint32_t>(members_.size())).second)
                members_.push_back({slot});
            if (slot >= input.bodies.first_movable) joints_of[slot].push_back(i);
        }
    }
    std::vector<NodePair> edges;
    for (const auto& [slot, list] : joints_of) {
        for (std::size_t p = 0; p < list.size(); ++p) {
            for (std::size_t q = 0; q < p; ++q) {
                if (list[p] != list[q]) edges.push_back({list[p], list[q]});
            }
        }
    }
    for (const std::uint32_t i : elimination_order(static_cast<std::uint32_t>(joints.size()), edges)) {
        const JointRecord<D>& record = input.joints[joints[i]];
        DirectJoint<D> joint;
        joint.joint = joints[i];
        joint.layout = record.layout;
        joint.a = member_of[input.slot_of(record.body_a)];
        joint.b = member_of[input.slot_of(record.body_b)];
        joints_.push_back(joint);
    }
    group.last_joint = static_cast<std::uint32_t>(joints_.size());
    group.last_body = static_cast<std::uint32_t>(members_.size());
    group.first_tie = static_cast<std::uint32_t>(ties_.size());
    std::vector<std::vector<NodePair>> by_body(members_.size() - group.first_body);  // joint, is it body a?
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        for (const bool is_a : {true, false}) {
            const std::uint32_t body = is_a ? joints_[k].a : joints_[k].b;
            if (members_[body].slot < input.bodies.first_movable) continue;
            auto& list = by_body[body - group.first_body];
            for (const NodePair& other : list) {
                if (other.row != k) ties_.push_back({k, other.row, is_a, other.column != 0, 0});
            }
            list.push_back({k, is_a});
        }
    }
    group.last_tie = static_cast<std::uint32_t>(ties_.size());
    groups_.push_back(group);
    // Each joint of a tree brings a body of its own along; those to what stands still count as one body.
    const std::size_t still = group.last_body - group.first_body - joints_of.size();
    const bool is_tree = joints.size() < joints_of.size() + std::min<std::size_t>(still, 1);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k)
        joints_[k].compliance = is_tree ? compliance_in_tree : compliance_in_loops;
}

#define CAROM_INSTANTIATE(D)                                                                  \
    template void DirectSolver<D>::set_step(double);                                          \
    template void DirectSolver<D>::plan(const JointInput<D>&, std::span<const std::uint32_t>, \
                                        std::span<const std::uint32_t>);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
