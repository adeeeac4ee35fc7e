#include "solver/joint_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace carom::detail {

template <int D>
bool JointGroups<D>::plan(const JointInput<D>& input) {
    if (look(input)) return false;
    const std::vector<std::uint32_t> before = direct_;
    group(input);
    return !direct_.empty() || !before.empty();
}

namespace {

/// Is there a range that it may leave?
template <int D>
bool is_limited(const JointRecord<D>& joint) {
    return std::ranges::any_of(joint.drives, [](const DriveSettings& d) {
        return d.low < d.high && (std::isfinite(d.low) || std::isfinite(d.high));
    });
}

}  // namespace

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
                         inverse_mass(joint.body_a), inverse_mass(joint.body_b), is_limited(joint)});
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
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(root(i), i); });
    for (std::size_t begin = 0, end; begin < count; begin = end) {
        end = begin;
        while (end < count && root(order[end]) == root(order[begin])) ++end;
        const std::span<const std::uint32_t> all(order.data() + begin, end - begin);
        const bool directly = method_ == JointMethod::direct || is_hard(all);
        if (directly) starts_.push_back(static_cast<std::uint32_t>(direct_.size()));
        for (const std::uint32_t i : all) (directly ? direct_ : iterative_).push_back(ties_[i].joint);
    }
}

/// Would sweeps not hold them? What counts is how much hangs on a joint beside the lighter of its two bodies:
/// found along the shortest ways from what stands still or, where nothing does, from the heaviest body. Nets,
/// of which the factors would be filled in, are left to sweeps.
template <int D>
bool JointGroups<D>::is_hard(std::span<const std::uint32_t> group) {
    constexpr std::size_t small_net = 24;
    constexpr std::size_t few = 4;
    // A chain of ten equal links has 10. A ragdoll has 9, and sweeps do for it.
    constexpr double most_load = 9.5;  // masses of the lighter body
    bodies_.clear();
    bool some_still = false;
    for (const std::uint32_t i : group) {
        const Tie& tie = ties_[i];
        for (const auto& [slot, inverse_mass] : {std::pair{tie.a, tie.mass_a}, {tie.b, tie.mass_b}}) {
            if (slot >= first_movable_)
                bodies_.push_back({slot, inverse_mass > 0 ? 1 / inverse_mass : 0});
            else
                some_still = true;
        }
    }
    std::ranges::sort(bodies_, {}, &Hanging::slot);
    const auto doubles = std::ranges::unique(bodies_, {}, &Hanging::slot);
    bodies_.erase(doubles.begin(), doubles.end());
    const std::size_t whole = group.size() + (some_still ? 0 : 1);
    const std::size_t loops = whole > bodies_.size() ? whole - bodies_.size() : 0;
    if (loops > 1 + bodies_.size() / 8 && group.size() > small_net) return false;
    // Sweeps do not come to agree about several joints that keep bodies from turning, and give them energy;
    // and a blow at a limit leaves joints beside it torn apart for some steps.
    const auto locks = [&](std::uint32_t i) {
        return layouts<D>[ties_[i].layout].angular == AngularPart::locked;
    };
    if (group.size() > 2 && std::ranges::any_of(group, locks)) return true;
    // What is made of drives alone is solved coordinate by coordinate in sweeps, which is good for few.
    const auto is_made_of_drives = [&](std::uint32_t i) {
        const Layout& l = layouts<D>[ties_[i].layout];
        return l.linear == LinearPart::none && l.angular == AngularPart::none && l.drive_count > 1;
    };
    if (std::ranges::any_of(group, is_made_of_drives)) return true;
    const auto is_limited = [&](std::uint32_t i) { return ties_[i].is_limited; };
    if (group.size() > 1 && group.size() <= few && std::ranges::any_of(group, is_limited)) return true;
    return greatest_load(group, some_still) > most_load;
}

template <int D>
double JointGroups<D>::greatest_load(std::span<const std::uint32_t> group, bool some_still) {
    const auto find = [&](std::uint32_t slot) {
        return std::ranges::lower_bound(bodies_, slot, {}, &Hanging::slot);
    };
    // Who is reached by which joint, and in which order: breadth first.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_body;  // slot and tie
    for (const std::uint32_t i : group) {
        if (ties_[i].a >= first_movable_) by_body.push_back({ties_[i].a, i});
        if (ties_[i].b >= first_movable_) by_body.push_back({ties_[i].b, i});
    }
    std::ranges::sort(by_body);
    std::vector<Hanging*> order;
    const auto reach = [&](std::uint32_t slot, Hanging* from) {
        Hanging& body = *find(slot);
        if (body.reached) return;
        body.reached = true;
        body.from = from;
        body.load = body.mass;
        order.push_back(&body);
    };
    if (some_still) {
        for (const std::uint32_t i : group) {
            if (ties_[i].a < first_movable_) reach(ties_[i].b, nullptr);
            if (ties_[i].b < first_movable_) reach(ties_[i].a, nullptr);
        }
    } else {
        reach(std::ranges::max_element(bodies_, {}, &Hanging::mass)->slot, nullptr);
    }
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::uint32_t slot = order[k]->slot;
        for (auto at = std::ranges::lower_bound(by_body, std::pair{slot, 0u});
             at != by_body.end() && at->first == slot; ++at) {
            const Tie& tie = ties_[at->second];
            const std::uint32_t other = tie.a == slot ? tie.b : tie.a;
            if (other >= first_movable_) reach(other, order[k]);
        }
    }
    double most = 0;
    for (std::size_t k = order.size(); k-- > 0;) {
        const Hanging& body = *order[k];
        if (!body.from && !some_still) continue;
        const double lighter = body.from ? std::min(body.mass, body.from->mass) : body.mass;
        most = std::max(most, body.load / lighter);
        if (body.from) body.from->load += body.load;
    }
    return most;
}

template class JointGroups<2>;
template class JointGroups<3>;

}  // namespace carom::detail
