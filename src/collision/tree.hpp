#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/scheduler.hpp"
#include "collision/box.hpp"
#include "geometry/packed_box.hpp"

namespace carom::detail {

/// The stack of a walk through a tree: in place while it is short, as it nearly always is.
template <class T>
class WalkStack {
  public:
    bool empty() const { return count_ == 0; }
    void push(const T& value) {
        if (count_ < here_.size())
            here_[count_] = value;
        else
            beyond_.push_back(value);
        ++count_;
    }
    T pop() {
        --count_;
        if (count_ < here_.size()) return here_[count_];
        const T value = beyond_.back();
        beyond_.pop_back();
        return value;
    }

  private:
    std::array<T, 128> here_;
    std::vector<T> beyond_;
    std::size_t count_ = 0;
};

/// A binary tree of boxes that finds what overlaps what. Every leaf carries a number of the caller's. The
/// caller makes the boxes as fat as suits it; they are kept in single precision, rounded outwards, and a
/// question about what overlaps is rounded in the same way. Inserting looks for the place that adds the least
/// surface to the tree (branch and bound; Bittner, Hapala, Havran: Incremental BVH Construction, 2015), and
/// swaps neighbours where that lessens it (Kopta et al.: Fast, Effective BVH Updates for Animated Scenes,
/// 2012). The shape of the tree and the order of answers depend on nothing but the sequence of calls.
template <int D>
class Tree {
  public:
    static constexpr std::int32_t none = -1;

    struct Entry {
        OuterBox<D> box;
        std::uint32_t payload;
    };

    /// Adds a leaf and returns its index, which stays valid until the leaf is removed.
    std::int32_t insert(const OuterBox<D>& box, std::uint32_t payload);
    void remove(std::int32_t leaf);
    /// Gives the leaf another box.
    void move(std::int32_t leaf, const OuterBox<D>& box);
    /// Gives new boxes to many leaves at once, `box_of(payload)` to each of `leaves`, and goes through the
    /// whole tree once: cheaper than one by one where these are more than a tenth or so of all.
    template <class BoxOf>
    void move_all(std::span<const std::int32_t> leaves, BoxOf&& box_of);

    void clear();
    /// Replaces all by a tree built at once: entry i becomes leaf i (Wald: On fast Construction of SAH-based
    /// Bounding Volume Hierarchies, 2007).
    void build(std::span<const Entry> entries);
    /// Adds many leaves, whose indices go into `leaves`: where they are many beside those that there are, by
    /// building the tree anew, with the scheduler's workers if there is one. The tree is the same in any
    /// case.
    void insert_all(std::span<const Entry> entries, std::span<std::int32_t> leaves,
                    Scheduler* scheduler = nullptr);
    /// Builds the tree anew over the leaves that it has; they keep their indices.
    void rebuild(Scheduler* scheduler = nullptr);

    const OuterBox<D>& box(std::int32_t leaf) const { return nodes_[leaf].box; }
    std::uint32_t payload(std::int32_t leaf) const { return std::uint32_t(nodes_[leaf].child[1]); }
    /// Calls `visit(leaf)` for every leaf.
    template <class Visitor>
    void each_leaf(Visitor&& visit) const {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (nodes_[i].leaf() && nodes_[i].height == 0) visit(static_cast<std::int32_t>(i));
        }
    }
    /// Number of leaves.
    std::int32_t size() const { return leaf_count_; }
    /// Length of the longest path from the root to a leaf; zero for one leaf or none.
    std::int32_t height() const { return root_ == none ? 0 : nodes_[root_].height; }

    /// Calls `visit(payload)` for every leaf whose box overlaps `box`.
    template <class Visitor>
    void query(const OuterBox<D>& box, Visitor&& visit) const;
    /// Calls `visit(payload, other_payload)` for every overlapping pair of a leaf here and a leaf of `other`.
    /// With the tree itself as `other` it visits every pair of two different leaves once.
    template <class Visitor>
    void query_pairs(const Tree& other, Visitor&& visit) const;

    /// Follows a box with the half lengths `half` (zero for a ray) whose centre goes from `origin` to
    /// `origin` + `translation`: calls `visit(payload, limit)` for every leaf whose box it meets at a
    /// fraction ≤ limit of the way, roughly in the order in which it does. The limit is `limit` first and
    /// then what `visit` returned last; a negative one ends the walk. Boxes that it misses by rounding alone
    /// are visited.
    template <class Visitor>
    double cast(const Vec<D>& origin, const Vec<D>& translation, const Vec<D>& half, double limit,
                Visitor&& visit) const;
    /// Calls `visit(payload, limit)` for every leaf whose box lies within √limit of the point, the nearer of
    /// two neighbours first. The limit is the square of a distance; it starts and changes as in `cast`.
    template <class Visitor>
    double approach(const Vec<D>& point, double limit, Visitor&& visit) const;

    /// Sum of the inner boxes' surfaces over the root's: how many nodes a small query visits on average.
    double cost() const;
    /// Are all links, boxes, heights and counts consistent?
    bool validate() const;

  private:
    /// A leaf has child[0] == none and its payload in child[1]. A free node has height −1 and in `parent` the
    /// next free node.
    struct Node {
        OuterBox<D> box{};
        std::int32_t parent = none;
        std::int32_t child[2] = {none, none};
        std::int32_t height = 0;

        bool leaf() const { return child[0] == none; }
    };

    std::int32_t allocate();
    void free(std::int32_t node);
    std::int32_t best_sibling(const OuterBox<D>& box);
    void attach(std::int32_t leaf);
    void detach(std::int32_t leaf);
    void replace_child(std::int32_t parent, std::int32_t child, std::int32_t by);
    void enclose_children(std::int32_t node);
    void rotate_at(std::int32_t node);
    void refit_upwards(std::int32_t node, bool rotate);
    void refit();
    std::int32_t add_leaf(const OuterBox<D>& box, std::uint32_t payload);
    static std::size_t split(std::span<PackedBox> pieces);

    /// A stretch of the leaves of a tree that is being built; its node is to become `child[side]` of
    /// `parent`.
    struct Part {
        std::size_t begin, end;
        std::int32_t parent;
        int side;

        std::size_t size() const { return end - begin; }
    };
    struct Growth;
    void plant(std::span<const Entry> entries, std::span<std::int32_t> leaves, Scheduler* scheduler);
    std::int32_t place(const Growth& growth, const Part& part, std::size_t middle);
    void grow(const Growth& growth, const Part& whole, Scheduler* scheduler);

    std::vector<Node> nodes_;
    std::int32_t root_ = none;
    std::int32_t first_free_ = none;
    std::int32_t leaf_count_ = 0;
    std::vector<std::int32_t> downwards_;  ///< working space: inner nodes, each before its children
};

template <int D>
template <class BoxOf>
void Tree<D>::move_all(std::span<const std::int32_t> leaves, BoxOf&& box_of) {
    for (const std::int32_t leaf : leaves) {
        const OuterBox<D>& box = box_of(payload(leaf));
        // Who has gone away altogether needs another place.
        if (overlaps(nodes_[leaf].box, box))
            nodes_[leaf].box = box;
        else
            move(leaf, box);
    }
    refit();
}

template <int D>
template <class Visitor>
void Tree<D>::query(const OuterBox<D>& box, Visitor&& visit) const {
    if (root_ == none || !overlaps(nodes_[root_].box, box)) return;
    WalkStack<std::int32_t> stack;
    std::int32_t node = root_;  // overlaps
    for (;;) {
        if (nodes_[node].leaf()) {
            visit(std::uint32_t(nodes_[node].child[1]));
        } else {
            const std::int32_t first = nodes_[node].child[0], second = nodes_[node].child[1];
            const bool takes_first = overlaps(nodes_[first].box, box);
            const bool takes_second = overlaps(nodes_[second].box, box);
            if (takes_first && takes_second) stack.push(second);
            if (takes_first || takes_second) {
                node = takes_first ? first : second;
                continue;
            }
        }
        if (stack.empty()) return;
        node = stack.pop();
    }
}

template <int D>
template <class Visitor>
double Tree<D>::cast(const Vec<D>& origin, const Vec<D>& translation, const Vec<D>& half, double limit,
                     Visitor&& visit) const {
    const SlabTest<D> slabs(origin, translation, half);
    struct Reached {
        std::int32_t node;
        double enter;
    };
    WalkStack<Reached> stack;
    if (root_ != none) stack.push({root_, slabs.enter(nodes_[root_].box, limit)});
    while (!stack.empty()) {
        Reached entry = stack.pop();
        while (entry.enter <= limit) {
            const Node& node = nodes_[entry.node];
            if (node.leaf()) {
                limit = visit(std::uint32_t(node.child[1]), limit);
                break;
            }
            Reached near{node.child[0], slabs.enter(nodes_[node.child[0]].box, limit)};
            Reached far{node.child[1], slabs.enter(nodes_[node.child[1]].box, limit)};
            if (far.enter < near.enter) std::swap(near, far);
            if (far.enter <= limit) stack.push(far);
            entry = near;
        }
    }
    return limit;
}

template <int D>
template <class Visitor>
double Tree<D>::approach(const Vec<D>& point, double limit, Visitor&& visit) const {
    struct Reached {
        std::int32_t node;
        double square;
    };
    const auto entry_of = [&](std::int32_t node) {
        return Reached{node, distance_squared(nodes_[node].box, point)};
    };
    WalkStack<Reached> stack;
    if (root_ != none) stack.push(entry_of(root_));
    while (!stack.empty()) {
        const Reached entry = stack.pop();
        if (!(entry.square <= limit)) continue;
        const Node& node = nodes_[entry.node];
        if (node.leaf()) {
            limit = visit(std::uint32_t(node.child[1]), limit);
            continue;
        }
        Reached near = entry_of(node.child[0]), far = entry_of(node.child[1]);
        if (far.square < near.square) std::swap(near, far);
        stack.push(far);
        stack.push(near);
    }
    return limit;
}

template <int D>
template <class Visitor>
void Tree<D>::query_pairs(const Tree& other, Visitor&& visit) const {
    if (root_ == none || other.root_ == none) return;
    struct Pair {
        std::int32_t a, b;
    };
    WalkStack<Pair> stack;
    stack.push({root_, other.root_});
    while (!stack.empty()) {
        const Pair pair = stack.pop();
        const Node& a = nodes_[pair.a];
        const Node& b = other.nodes_[pair.b];
        if (this == &other && pair.a == pair.b) {
            if (a.leaf()) continue;
            stack.push({a.child[0], a.child[1]});
            stack.push({a.child[1], a.child[1]});
            stack.push({a.child[0], a.child[0]});
        } else if (!overlaps(a.box, b.box)) {
            continue;
        } else if (a.leaf() && b.leaf()) {
            visit(std::uint32_t(a.child[1]), std::uint32_t(b.child[1]));
        } else if (b.leaf() || (!a.leaf() && half_surface(a.box) >= half_surface(b.box))) {
            stack.push({a.child[1], pair.b});
            stack.push({a.child[0], pair.b});
        } else {
            stack.push({pair.a, b.child[1]});
            stack.push({pair.a, b.child[0]});
        }
    }
}

}  // namespace carom::detail
