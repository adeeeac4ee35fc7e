#include "collision/tree.hpp"

#include <cassert>
#include <limits>

#include "core/crew.hpp"
#include "core/room.hpp"

namespace carom::detail {

namespace {

template <int D>
PackedBox packed(const OuterBox<D>& box, std::int32_t leaf) {
    PackedBox result{};
    for (int i = 0; i < D; ++i) {
        result.lower[i] = box.lower[i];
        result.upper[i] = box.upper[i];
    }
    result.set_number(std::uint32_t(leaf));
    return result;
}

template <int D>
OuterBox<D> unpacked(const PackedBounds& bounds) {
    OuterBox<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = bounds.lower[i];
        box.upper[i] = bounds.upper[i];
    }
    return box;
}

/// The middle of the box; what is infinite both ways has its centre at 0.
Four center_of(const PackedBox& box) {
    constexpr float f = 1e30f;
    constexpr Four furthest{f, f, f, f};
    return 0.5f * greatest(box.lower, -furthest) + 0.5f * least(box.upper, furthest);
}

}  // namespace

template <int D>
std::int32_t Tree<D>::allocate() {
    if (first_free_ == none) {
        nodes_.emplace_back();
        return std::int32_t(nodes_.size()) - 1;
    }
    const std::int32_t node = first_free_;
    first_free_ = nodes_[node].parent;
    nodes_[node] = Node{};
    return node;
}

template <int D>
void Tree<D>::free(std::int32_t node) {
    nodes_[node] = Node{};
    nodes_[node].height = -1;
    nodes_[node].parent = first_free_;
    first_free_ = node;
}

template <int D>
std::int32_t Tree<D>::insert(const OuterBox<D>& box, std::uint32_t payload) {
    const std::int32_t leaf = add_leaf(box, payload);
    attach(leaf);
    return leaf;
}

template <int D>
std::int32_t Tree<D>::add_leaf(const OuterBox<D>& box, std::uint32_t payload) {
    const std::int32_t leaf = allocate();
    nodes_[leaf].box = box;
    nodes_[leaf].child[1] = std::int32_t(payload);
    ++leaf_count_;
    return leaf;
}

template <int D>
void Tree<D>::remove(std::int32_t leaf) {
    detach(leaf);
    free(leaf);
    --leaf_count_;
}

template <int D>
void Tree<D>::move(std::int32_t leaf, const OuterBox<D>& box) {
    assert(nodes_[leaf].height == 0 && nodes_[leaf].leaf());
    const std::int32_t parent = nodes_[leaf].parent;
    // While the parent holds the new box, no better place is to be expected; one that the old box still
    // touches is worth keeping, if its ancestors may swap their children.
    const bool held = parent == none || contains(nodes_[parent].box, box);
    const bool stays = held || overlaps(nodes_[leaf].box, box);
    if (!stays) detach(leaf);
    nodes_[leaf].box = box;
    if (stays)
        refit_upwards(parent, !held);
    else
        attach(leaf);
}

template <int D>
void Tree<D>::clear() {
    *this = Tree{};
}

/// The node that, taken together with a new leaf of that box under a new parent, adds the least surface to
/// the tree: that of the new parent and what all its ancestors grow by.
template <int D>
std::int32_t Tree<D>::best_sibling(const OuterBox<D>& box) {
    struct Candidate {
        std::int32_t node;
        double growth;  ///< what the node's ancestors grow by
    };
    const double leaf_surface = half_surface(box);
    std::int32_t best = root_;
    double best_cost = std::numeric_limits<double>::infinity();
    WalkStack<Candidate> stack;
    stack.push({root_, 0});
    while (!stack.empty()) {
        const Candidate candidate = stack.pop();
        // Nothing beneath can cost less than the leaf's own surface on top of the ancestors' growth.
        if (candidate.growth + leaf_surface >= best_cost) continue;
        const Node& node = nodes_[candidate.node];
        const double surface = half_surface(merged(node.box, box));
        if (surface + candidate.growth < best_cost) {
            best_cost = surface + candidate.growth;
            best = candidate.node;
        }
        const double growth = candidate.growth + surface - half_surface(node.box);
        if (node.leaf() || growth + leaf_surface >= best_cost) continue;
        // The child that grows less goes last on the stack, so it is looked at first and the bound falls
        // early.
        const auto growth_of = [&](std::int32_t child) {
            return half_surface(merged(nodes_[child].box, box)) - half_surface(nodes_[child].box);
        };
        const bool second_first = growth_of(node.child[1]) < growth_of(node.child[0]);
        stack.push({node.child[second_first ? 0 : 1], growth});
        stack.push({node.child[second_first ? 1 : 0], growth});
    }
    return best;
}

template <int D>
void Tree<D>::replace_child(std::int32_t parent, std::int32_t child, std::int32_t by) {
    nodes_[by].parent = parent;
    if (parent == none)
        root_ = by;
    else
        nodes_[parent].child[nodes_[parent].child[1] == child] = by;
}

template <int D>
void Tree<D>::attach(std::int32_t leaf) {
    nodes_[leaf].parent = none;
    if (root_ == none) {
        root_ = leaf;
        return;
    }
    const std::int32_t sibling = best_sibling(nodes_[leaf].box);
    const std::int32_t joint = allocate();
    replace_child(nodes_[sibling].parent, sibling, joint);
    nodes_[joint].child[0] = sibling;
    nodes_[joint].child[1] = leaf;
    nodes_[sibling].parent = joint;
    nodes_[leaf].parent = joint;
    refit_upwards(joint, true);
}

template <int D>
void Tree<D>::detach(std::int32_t leaf) {
    assert(nodes_[leaf].height == 0 && nodes_[leaf].leaf());
    const std::int32_t parent = nodes_[leaf].parent;
    if (parent == none) {
        root_ = none;
        return;
    }
    const std::int32_t sibling = nodes_[parent].child[nodes_[parent].child[0] == leaf];
    const std::int32_t above = nodes_[parent].parent;
    replace_child(above, parent, sibling);
    free(parent);
    refit_upwards(above, false);
}

template <int D>
void Tree<D>::enclose_children(std::int32_t index) {
    Node& node = nodes_[index];
    const Node& left = nodes_[node.child[0]];
    const Node& right = nodes_[node.child[1]];
    node.box = merged(left.box, right.box);
    node.height = 1 + std::max(left.height, right.height);
}

/// Swaps a child with a child of its sibling where that makes the sibling smaller.
template <int D>
void Tree<D>::rotate_at(std::int32_t index) {
    double best_gain = 0;
    int best_side = 0, best_grandchild = 0;
    for (int side = 0; side < 2; ++side) {
        const Node& child = nodes_[nodes_[index].child[side]];
        const Node& sibling = nodes_[nodes_[index].child[1 - side]];
        if (sibling.leaf()) continue;
        for (int k = 0; k < 2; ++k) {
            const Node& stays = nodes_[sibling.child[1 - k]];
            const double gain = half_surface(sibling.box) - half_surface(merged(child.box, stays.box));
            if (gain > best_gain) {
                best_gain = gain;
                best_side = side;
                best_grandchild = k;
            }
        }
    }
    if (!(best_gain > 0)) return;
    const std::int32_t child = nodes_[index].child[best_side];
    const std::int32_t sibling = nodes_[index].child[1 - best_side];
    const std::int32_t grandchild = nodes_[sibling].child[best_grandchild];
    nodes_[index].child[best_side] = grandchild;
    nodes_[grandchild].parent = index;
    nodes_[sibling].child[best_grandchild] = child;
    nodes_[child].parent = sibling;
    enclose_children(sibling);
    enclose_children(index);
}

template <int D>
void Tree<D>::refit_upwards(std::int32_t node, bool rotate) {
    for (; node != none; node = nodes_[node].parent) {
        enclose_children(node);
        if (rotate) rotate_at(node);
    }
}

template <int D>
void Tree<D>::refit() {
    downwards_.clear();
    if (root_ != none && !nodes_[root_].leaf()) downwards_.push_back(root_);
    for (std::size_t i = 0; i < downwards_.size(); ++i) {
        for (const std::int32_t child : nodes_[downwards_[i]].child) {
            if (!nodes_[child].leaf()) downwards_.push_back(child);
        }
    }
    for (auto node = downwards_.rbegin(); node != downwards_.rend(); ++node) {
        enclose_children(*node);
        rotate_at(*node);
    }
}

template <int D>
void Tree<D>::build(std::span<const Entry> entries) {
    clear();
    nodes_.reserve(2 * entries.size());
    for (const Entry& entry : entries) add_leaf(entry.box, entry.payload);
    rebuild();
}

template <int D>
void Tree<D>::insert_all(std::span<const Entry> entries, std::span<std::int32_t> leaves,
                         Scheduler* scheduler) {
    constexpr std::size_t few = 64;
    const bool at_once = entries.size() > few && 4 * entries.size() > static_cast<std::size_t>(leaf_count_);
    if (at_once && nodes_.empty()) return plant(entries, leaves, scheduler);
    if (at_once) make_room(nodes_, 2 * entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        leaves[i] = add_leaf(entries[i].box, entries[i].payload);
        if (!at_once) attach(leaves[i]);
    }
    if (at_once) rebuild(scheduler);
}

/// What a tree is built from. A part of the pieces that is split before number `middle` has its node at
/// `inner[middle - 1]`; or, where no leaf has a place yet, at 2 `middle` − 1, and the leaf of piece i at 2i.
/// So all nodes of a part lie together.
template <int D>
struct Tree<D>::Growth {
    std::span<PackedBox> pieces;          ///< numbered by leaf or, without `inner`, by entry
    std::span<const std::int32_t> inner;  ///< places of all nodes that are no leaves
    std::span<const Entry> entries;
    std::span<std::int32_t> leaves;
};

/// Fills the empty tree.
template <int D>
void Tree<D>::plant(std::span<const Entry> entries, std::span<std::int32_t> leaves, Scheduler* scheduler) {
    std::vector<PackedBox> pieces;
    make_room(pieces, entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i)
        pieces.push_back(packed(entries[i].box, std::int32_t(i)));
    make_room(nodes_, 2 * entries.size() - 1);
    nodes_.resize(2 * entries.size() - 1);
    leaf_count_ = std::int32_t(entries.size());
    grow({pieces, {}, entries, leaves}, {0, pieces.size(), none, 0}, scheduler);
}

template <int D>
void Tree<D>::rebuild(Scheduler* scheduler) {
    std::vector<PackedBox> pieces;
    make_room(pieces, static_cast<std::size_t>(leaf_count_));
    for (std::int32_t i = 0; i < std::int32_t(nodes_.size()); ++i) {
        if (nodes_[i].height == 0)
            pieces.push_back(packed(nodes_[i].box, i));
        else if (nodes_[i].height > 0)
            free(i);
    }
    root_ = none;
    if (pieces.empty()) return;
    std::vector<std::int32_t> inner;
    make_room(inner, pieces.size());
    while (inner.size() + 1 < pieces.size()) inner.push_back(allocate());
    grow({pieces, inner, {}, {}}, {0, pieces.size(), none, 0}, scheduler);
}

/// Makes the node of a part that is split there, but for what depends on its children. Returns its index.
template <int D>
std::int32_t Tree<D>::place(const Growth& growth, const Part& part, std::size_t middle) {
    const bool single = part.size() == 1, fresh = !growth.entries.empty();
    const std::uint32_t number = growth.pieces[part.begin].number();
    const auto node = fresh    ? std::int32_t(single ? 2 * part.begin : 2 * middle - 1)
                      : single ? std::int32_t(number)
                               : growth.inner[middle - 1];
    if (fresh && single) {
        nodes_[node].box = growth.entries[number].box;
        nodes_[node].child[1] = std::int32_t(growth.entries[number].payload);
        growth.leaves[number] = node;
    }
    nodes_[node].parent = part.parent;
    if (part.parent == none)
        root_ = node;
    else
        nodes_[part.parent].child[part.side] = node;
    return node;
}

/// Builds the tree of a part: splits it until what is left is a sixteenth of it, goes on with each of these
/// parts, for which a worker is enough, and then encloses what it made.
template <int D>
void Tree<D>::grow(const Growth& growth, const Part& whole, Scheduler* scheduler) {
    constexpr std::size_t few = 1024, ways = 16;
    const std::size_t least = whole.size() <= few ? 0 : std::max(few, whole.size() / ways);
    std::vector<Part> parts{whole}, branches;
    std::vector<std::int32_t> inner;
    while (!parts.empty()) {
        const Part part = parts.back();
        parts.pop_back();
        if (part.size() <= least) {
            branches.push_back(part);
            continue;
        }
        const bool single = part.size() == 1;
        const std::size_t middle =
            single ? part.end : part.begin + split(growth.pieces.subspan(part.begin, part.size()));
        const std::int32_t node = place(growth, part, middle);
        if (single) continue;
        inner.push_back(node);
        parts.push_back({middle, part.end, node, 1});
        parts.push_back({part.begin, middle, node, 0});
    }
    run_range(scheduler, branches.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) grow(growth, branches[i], nullptr);
    });
    // Every node was made before its children.
    for (auto node = inner.rbegin(); node != inner.rend(); ++node) enclose_children(*node);
}

/// Orders the pieces so that the first ones, as many as it returns, make one half and the rest the other, at
/// the least of (number · surface) summed over both, tried at the borders of equal bins of the centres.
template <int D>
std::size_t Tree<D>::split(std::span<PackedBox> pieces) {
    constexpr int most_bins = 16;
    const int bin_count = int(std::min<std::size_t>(most_bins, pieces.size()));
    struct Bin {  // of which only those that are used are set
        Four lower, upper;
        std::size_t count;
    };
    struct Side {
        PackedBounds bounds;
        std::size_t count = 0;

        void add(const Bin& bin) {
            bounds.hold(bin);
            count += bin.count;
        }
        double cost() const { return count == 0 ? 0 : double(count) * half_surface(unpacked<D>(bounds)); }
    };
    if (pieces.size() == 2) return 1;
    PackedBounds centers;
    for (const PackedBox& piece : pieces) centers.hold(center_of(piece));
    const Four size = centers.upper - centers.lower;
    int axis = 0;
    for (int i = 1; i < D; ++i)
        if (size[i] > size[axis]) axis = i;
    if (!(size[axis] > 0)) return pieces.size() / 2;

    const float per_length = static_cast<float>(bin_count) / size[axis], origin = centers.lower[axis];
    const auto bin_of = [&](const PackedBox& piece) {
        return std::min(bin_count - 1, int((center_of(piece)[axis] - origin) * per_length));
    };
    std::array<Bin, most_bins> bins;
    constexpr PackedBounds nothing;
    for (int i = 0; i < bin_count; ++i) bins[i] = {nothing.lower, nothing.upper, 0};
    for (PackedBox& piece : pieces) {
        const int place = bin_of(piece);
        piece.upper[3] = float(place);
        Bin& bin = bins[place];
        bin.lower = least(bin.lower, piece.lower);
        bin.upper = greatest(bin.upper, piece.upper);
        ++bin.count;
    }

    std::array<double, most_bins> cost{};  // of a border before bin i
    Side left, right;
    for (int i = 1; i < bin_count; ++i) {
        left.add(bins[i - 1]);
        cost[i] = left.cost();
    }
    for (int i = bin_count - 1; i > 0; --i) {
        right.add(bins[i]);
        cost[i] += right.cost();
    }
    // The outermost bins hold a piece each, so no border leaves a side empty.
    const int border = int(std::min_element(cost.begin() + 1, cost.begin() + bin_count) - cost.begin());
    const auto middle = std::partition(pieces.begin(), pieces.end(),
                                       [&](const PackedBox& p) { return p.upper[3] < float(border); });
    return std::size_t(middle - pieces.begin());
}

template <int D>
double Tree<D>::cost() const {
    if (root_ == none) return 0;
    double sum = 0;
    for (const Node& node : nodes_)
        if (node.height > 0) sum += half_surface(node.box);
    return sum / half_surface(nodes_[root_].box);
}

template <int D>
bool Tree<D>::validate() const {
    std::size_t used = 0;
    std::int32_t leaves = 0;
    WalkStack<std::int32_t> stack;
    if (root_ != none) {
        if (nodes_[root_].parent != none) return false;
        stack.push(root_);
    }
    while (!stack.empty() && used++ < nodes_.size()) {
        const std::int32_t index = stack.pop();
        const Node& node = nodes_[index];
        if (node.leaf()) {
            if (node.height != 0) return false;
            ++leaves;
            continue;
        }
        const Node& left = nodes_[node.child[0]];
        const Node& right = nodes_[node.child[1]];
        if (left.parent != index || right.parent != index) return false;
        if (node.box != merged(left.box, right.box)) return false;
        if (node.height != 1 + std::max(left.height, right.height)) return false;
        stack.push(node.child[0]);
        stack.push(node.child[1]);
    }
    std::size_t unused = 0;
    for (std::int32_t node = first_free_; node != none && unused++ < nodes_.size();
         node = nodes_[node].parent)
        if (nodes_[node].height != -1) return false;
    return stack.empty() && leaves == leaf_count_ && used + unused == nodes_.size();
}

template class Tree<2>;
template class Tree<3>;

}  // namespace carom::detail
