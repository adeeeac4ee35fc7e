#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "carom/scheduler.hpp"
#include "geometry/ray.hpp"

namespace carom::detail {

/// A tree of boxes that never changes, for very many of them. A node has up to eight children and holds their
/// boxes in bytes, as multiples of a step from the node's own corner, rounded outwards: a box and eight of
/// them are compared byte by byte, and a node of space fills two cache lines (after Ylitie, Karras and Laine:
/// Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017). It is built from the top
/// by the surface-area heuristic over bins (`Bins`), in single precision about the middle of all. Its form,
/// and so the order of its answers, depends on nothing but the boxes.
template <int D>
class FacetTree {
  public:
    struct Item {
        Aabb<D> box;
        std::uint32_t facet;
    };
    static constexpr int width = 8;
    static constexpr std::uint32_t most_items = 1u << 27;

    /// Builds the tree, with the workers of the scheduler if there is one; at most `most_items`.
    void build(std::span<const Item> items, Scheduler* scheduler = nullptr);

    /// Calls `visit(facet)` for every item whose box may overlap `box`: for all that do, and a few more.
    template <class Visitor>
    void query(const Aabb<D>& box, Visitor&& visit) const;

    /// Calls `visit(facet)` for every item whose box the ray may enter before `max_fraction`, nodes front to
    /// back; what it returns is the `max_fraction` from then on.
    template <class Visitor>
    void cast(const Ray<D>& ray, double max_fraction, Visitor&& visit) const;

    /// Memory that it holds.
    std::size_t bytes() const { return nodes_.size() * sizeof(Node) + order_.size() * sizeof(std::uint32_t); }

  private:
    using Lanes = std::array<std::uint8_t, width>;
    /// A child is the index of a node or, with `leaf_bit`, a run of `order_`: the number of its items less
    /// one in two bits, then its start. Where there are fewer than eight children, the boxes of the rest
    /// begin at 255 and end at 0; no other box begins beyond 254.
    struct Node {
        Vec<D> origin{}, step{};
        std::array<Lanes, D> lower{}, upper{};
        std::array<std::uint32_t, width> child{};
    };
    static constexpr std::uint32_t leaf_bit = 1u << 31;
    static constexpr int count_shift = 27;
    static constexpr int largest_leaf = 4;
    /// Below this depth halves replace the heuristic, so that the walks' stacks have a bound: eight and seven
    /// more a level, of which there are 24 and at most log₂ 2²⁷.
    static constexpr int deepest_heuristic = 24;
    static constexpr int stack_size = 8 + 7 * (deepest_heuristic + 27);

    class Builder;
    struct Branch;
    template <class Visitor>
    double visit_leaf(std::uint32_t leaf, double max_fraction, Visitor&& visit) const {
        const std::uint32_t first = leaf & ((1u << count_shift) - 1);
        const std::uint32_t count = (leaf >> count_shift & 3) + 1;
        for (std::uint32_t i = first; i < first + count; ++i) max_fraction = visit(order_[i], max_fraction);
        return max_fraction;
    }
    /// Bit k is set where child k of the node may overlap the box.
    static std::uint32_t overlapped(const Node& node, const Aabb<D>& box);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

template <int D>
std::uint32_t FacetTree<D>::overlapped(const Node& node, const Aabb<D>& box) {
    // 1e-14 is more than the rounding of the two operations before it.
    std::array<std::uint8_t, D> low, high;
    for (int i = 0; i < D; ++i) {
        const double from = (box.lower[i] - node.origin[i]) / node.step[i] * (1 - 1e-14);
        const double to = (box.upper[i] - node.origin[i]) / node.step[i] * (1 + 1e-14);
        if (!(from <= 255 && to >= 0)) return 0;
        low[i] = std::uint8_t(std::max(std::ceil(from), 0.0));
        high[i] = std::uint8_t(std::min(to, 254.0));
    }
    using Eight [[gnu::vector_size(8)]] = std::uint8_t;
    static_assert(width == sizeof(Eight) && std::endian::native == std::endian::little);
    Eight beside{};
    for (int i = 0; i < D; ++i) {
        const auto lower = std::bit_cast<Eight>(node.lower[i]), upper = std::bit_cast<Eight>(node.upper[i]);
        beside |= Eight(lower > high[i]) | Eight(upper < low[i]);
    }
    // The lowest bit of each byte comes to the highest byte, the first byte's lowest.
    const std::uint64_t hit = ~std::bit_cast<std::uint64_t>(beside) & 0x0101010101010101u;
    const auto bits = static_cast<std::uint32_t>((hit * 0x0102040810204080u) >> 56);
    return bits;
}

template <int D>
template <class Visitor>
void FacetTree<D>::query(const Aabb<D>& box, Visitor&& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, stack_size> stack;
    int count = 0;
    stack[count++] = 0;
    while (count > 0) {
        const std::uint32_t top = stack[--count];
        if (top & leaf_bit) {
            visit_leaf(top, 0, [&](std::uint32_t facet, double) {
                visit(facet);
                return 0.0;
            });
            continue;
        }
        const Node& node = nodes_[top];
        const std::uint32_t hits = overlapped(node, box);
        for (int k = width - 1; k >= 0; --k)
            if (hits >> k & 1) stack[count++] = node.child[k];
    }
}

template <int D>
template <class Visitor>
void FacetTree<D>::cast(const Ray<D>& ray, double max_fraction, Visitor&& visit) const {
    if (nodes_.empty()) return;
    struct Entry {
        double fraction;
        std::uint32_t child;
    };
    std::array<Entry, stack_size> stack;
    int count = 0;
    stack[count++] = {0, 0};
    while (count > 0) {
        const Entry top = stack[--count];
        if (top.fraction > max_fraction) continue;
        if (top.child & leaf_bit) {
            max_fraction = visit_leaf(top.child, max_fraction, visit);
            continue;
        }
        const Node& node = nodes_[top.child];
        const int begin = count;
        for (int k = 0; k < width; ++k) {
            if (node.lower[0][k] > node.upper[0][k]) continue;
            Aabb<D> box;
            for (int i = 0; i < D; ++i) {
                box.lower[i] = node.origin[i] + node.lower[i][k] * node.step[i];
                box.upper[i] = node.origin[i] + node.upper[i][k] * node.step[i];
            }
            const double fraction = entry(ray, box, max_fraction);
            if (fraction > max_fraction) continue;
            // Sorted in: the nearest comes to lie on top, of equals the first.
            int place = count++;
            for (; place > begin && stack[place - 1].fraction <= fraction; --place)
                stack[place] = stack[place - 1];
            stack[place] = {fraction, node.child[k]};
        }
    }
}

}  // namespace carom::detail
