#pragma once

#include <cstdint>
#include <vector>

#include "core/column.hpp"

namespace carom::detail {

/// Links between nodes, and for each node a list of those that it has: lists within arrays, so that a link
/// is added or removed in a few steps however many its nodes have. Links and nodes are numbers of the
/// caller's. The order of a list depends on its history; who needs one that does not sorts what it finds.
class Adjacency {
  public:
    /// Lets there be room for nodes below this number, so that the first link of one does not pay for it.
    void make_room(std::uint32_t nodes) {
        if (nodes > first_.size()) first_.resize(nodes);
    }

    void add(std::uint32_t link, std::uint32_t a, std::uint32_t b) {
        if (link >= links_.size()) links_.resize(link + 1);
        links_[link].node[0] = a;
        links_[link].node[1] = b;
        for (const std::uint32_t side : {0u, 1u}) attach(2 * link + side);
    }

    void remove(std::uint32_t link) {
        for (const std::uint32_t side : {0u, 1u}) detach(2 * link + side);
    }

    /// The link `from` takes the number `to`, which no link has.
    void renumber(std::uint32_t from, std::uint32_t to) {
        if (to >= links_.size()) links_.resize(to + 1);
        links_[to] = links_[from];
        for (const std::uint32_t side : {0u, 1u}) {
            const End& end = links_[to].end[side];
            set_after(end.before, links_[to].node[side], 2 * to + side);
            if (end.after != none) at(end.after).before = 2 * to + side;
        }
    }

    /// One of the two nodes of a link.
    std::uint32_t node(std::uint32_t link, int side) const { return links_[link].node[side]; }

    /// Calls `visit(link, other_node)` for each link of the node. Nothing may be added or removed meanwhile.
    template <class Visit>
    void each(std::uint32_t node, Visit&& visit) const {
        if (node >= first_.size()) return;
        for (std::uint32_t i = first_of(node); i != none;) {
            const Link& link = links_[i / 2];
            visit(i / 2, link.node[1 - i % 2]);
            i = link.end[i % 2].after;
        }
    }

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// One end of a link in the list of its node. Ends are numbered 2 · link + side.
    struct End {
        std::uint32_t before = none, after = none;
    };
    struct Link {
        std::uint32_t node[2];
        End end[2];
    };

    std::uint32_t first_of(std::uint32_t node) const { return first_[node] - 1; }
    /// After that end, or if it is `none`, first of the node, comes `next`.
    void set_after(std::uint32_t before, std::uint32_t node, std::uint32_t next) {
        if (before == none)
            first_[node] = next + 1;
        else
            at(before).after = next;
    }
    End& at(std::uint32_t i) { return links_[i / 2].end[i % 2]; }
    void attach(std::uint32_t i) {
        const std::uint32_t node = links_[i / 2].node[i % 2];
        if (node >= first_.size()) first_.resize(node + 1);
        const std::uint32_t after = first_of(node);
        at(i) = {none, after};
        if (after != none) at(after).before = i;
        set_after(none, node, i);
    }
    void detach(std::uint32_t i) {
        const End end = at(i);
        set_after(end.before, links_[i / 2].node[i % 2], end.after);
        if (end.after != none) at(end.after).before = end.before;
    }

    std::vector<Link> links_;      ///< by number
    Column<std::uint32_t> first_;  ///< by node: one more than the number of the end, or 0 where there is none
};

}  // namespace carom::detail
