#include "solver/joint_groups.hpp"

#include <algorithm>
#include <numeric>

namespace carom::detail {

template <int D>
bool JointGroups<D>::plan(const JointInput<D>& input) {
    if (look(input)) return false;
    const std::vector<std::uint32_t> before = direct_;
    group(input);
    return !direct_.empty() || !before.empty();
}

/// Returns whether all is as it was when it was last looked at.
template <int D>
bool JointGroups<D>::look(const JointInput<D>& input) {
    seen_.clear();
    const auto inverse_mass = [&](std::uint32_t body) {
        return body == no_body ? 0.0 : input.masses[body].inverse_mass;
    };
    for (const std::uint32_t i : input.active) {
        const JointRecord<D>& joint = input.joints[i];
        seen_.push_back({i, joint.layout, input.slot_of(joint.body_a), input.slot_of(joint.body_b),
                         inverse_mass(joint.body_a), inverse_mass(joint.body_b)});
    }
    const bool same =
        method_ == input.method && first_movable_ == input.bodies.first_movable && seen_ == ties_;
    method_ = input.method;
    first_movable_ = input.bodies.first_movable;
    std::swap(seen_, ties_);
    return same;
}

template <int D>
std::uint32_t JointGroups<D>::root(std::uint32_t tie) {
    while (parent_[tie] != tie) tie = parent_[tie] = parent_[parent_[tie]];
    return tie;
}

template <int D>
void JointGroups<D>::group(const JointInput<D>& input) {
    iterative_.clear();
    direct_.clear();
    starts_.clear();
    if (method_ == JointMethod::iterative) {
        iterative_.assign(input.active.begin(), input.active.end());
        return;
    }
    const auto count = static_cast<std::uint32_t>(ties_.size());
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0u);
    std::vector<std::uint32_t> first_of(input.slots.size(), count);  // by slot
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const std::uint32_t slot : {ties_[i].a, ties_[i].b}) {
            if (slot < first_movable_) continue;
            std::uint32_t& first = first_of[slot];
            if (first == count) first = i;
            // The older one is the root, so that groups come in the order of their first joints.
            const std::uint32_t p = root(first), q = root(i);
            parent_[std::max(p, q)] = std::min(p, q);
        }
    }
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return root(i); });
    for (std::size_t begin = 0, end; begin < count; begin = end) {
        end = begin;
        while (end < count && root(order[end]) == root(order[begin])) ++end;
        const std::span<const std::uint32_t> all(order.data() + begin, end - begin);
        const bool directly = method_ == JointMethod::direct || is_hard(all, input);
        if (directly) starts_.push_back(static_cast<std::uint32_t>(direct_.size()));
        for (const std::uint32_t i : all) (directly ? direct_ : iterative_).push_back(ties_[i].joint);
    }
}

/// Would sweeps not hold them?
template <int D>
bool JointGroups<D>::is_hard(std::span<const std::uint32_t> ties, const JointInput<D>&) const {
    return ties.size() > 0;
}

template class JointGroups<2>;
template class JointGroups<3>;

}  // namespace carom::detail
