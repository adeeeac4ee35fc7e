#include "geometry/facet_tree.hpp"

#include <mutex>

#include "core/crew.hpp"
#include "geometry/packed_box.hpp"

namespace carom::detail {

namespace {

/// Stretches of fewer items than this are not worth a worker of their own.
constexpr std::size_t grain = 1u << 14;

/// The float below x, or −x the float above; x is within the range of floats.
float below(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) <= x ? f : -std::nextafter(-f, std::numeric_limits<float>::max());
}

}  // namespace

/// The items of a part of the tree whose nodes are yet to be made, and the child that it is to become.
template <int D>
struct FacetTree<D>::Branch {
    std::span<PackedBox> items;
    PackedBounds bounds;
    int depth = 0;
    std::uint32_t parent = 0;
    int child = 0;
};

/// Makes nodes from the top. What is large is gone through by all workers together; the branches below that
/// are made side by side, each in a list of its own, and the lists are joined in the order of the branches.
template <int D>
class FacetTree<D>::Builder {
  public:
    Builder(const Vec<D>& base, std::span<PackedBox> all, std::vector<std::uint32_t>& order,
            std::vector<Node>& nodes, std::vector<Branch>* branches, Scheduler* scheduler)
        : base_(base), all_(all), order_(order), nodes_(nodes), branches_(branches), scheduler_(scheduler) {}

    /// Makes the node of the items and all beneath it, but for what becomes a branch; returns its index.
    std::uint32_t make(std::span<PackedBox> items, const PackedBounds& bounds, int depth) {
        std::array<Group, width> groups;
        groups[0] = {items, bounds, half_surface<D>(bounds)};
        int count = 1;
        // The one with the largest surface is parted next, until there are eight or all are leaves.
        while (count < width) {
            int widest = -1;
            for (int k = 0; k < count; ++k) {
                if (groups[k].items.size() <= largest_leaf) continue;
                if (widest < 0 || groups[k].surface > groups[widest].surface) widest = k;
            }
            if (widest < 0) break;
            const auto [first, second] = split(groups[widest], depth < deepest_heuristic);
            groups[widest] = first;
            groups[count++] = second;
        }
        const auto index = std::uint32_t(nodes_.size());
        nodes_.emplace_back();
        set_boxes(nodes_[index], bounds, std::span(groups).first(std::size_t(count)));
        for (int k = 0; k < count; ++k) {
            const Group& group = groups[k];
            if (branches_ && group.items.size() > largest_leaf && group.items.size() <= grain) {
                branches_->push_back({group.items, group.bounds, depth + 1, index, k});
                continue;
            }
            const bool leaf = group.items.size() <= largest_leaf;
            const std::uint32_t child =
                leaf ? make_leaf(group.items) : make(group.items, group.bounds, depth + 1);
            nodes_[index].child[std::size_t(k)] = child;
        }
        return index;
    }

  private:
    struct Group {
        std::span<PackedBox> items;
        PackedBounds bounds;
        float surface = 0;
    };

    std::uint32_t make_leaf(std::span<PackedBox> items) {
        const auto first = std::uint32_t(items.data() - all_.data());
        for (std::size_t i = 0; i < items.size(); ++i) order_[first + i] = items[i].number();
        std::sort(order_.begin() + first, order_.begin() + first + std::ptrdiff_t(items.size()));
        return leaf_bit | std::uint32_t(items.size() - 1) << count_shift | first;
    }

    /// Adds all items to what holds nothing yet: `add(sum, item)`, and `join(sum)` for the sum of a stretch.
    template <class Sum, class Add, class Join>
    void gather(std::span<const PackedBox> items, Sum& total, const Add& add, const Join& join) {
        if (!branches_ || !scheduler_) {
            for (const PackedBox& item : items) add(total, item);
            return;
        }
        const Sum nothing = total;
        std::mutex joining;
        run_range(scheduler_, items.size(), grain, [&](std::size_t begin, std::size_t end) {
            Sum sum = nothing;
            for (std::size_t i = begin; i < end; ++i) add(sum, items[i]);
            const std::lock_guard lock(joining);
            join(sum);
        });
    }

    std::pair<Group, Group> split(const Group& whole, bool by_surface) {
        PackedBounds centers;
        gather(
            whole.items, centers, [](PackedBounds& sum, const PackedBox& item) { sum.hold(item.center()); },
            [&](const PackedBounds& sum) { centers.hold(sum); });
        if (!by_surface) return halves(whole, centers);
        Bins<D> bins(centers, whole.items.size());
        gather(
            whole.items, bins, [](Bins<D>& sum, const PackedBox& item) { sum.add(item); },
            [&](const Bins<D>& sum) { bins.add(sum); });
        const auto border = bins.cheapest();
        if (border.axis < 0) return halves(whole, centers);
        std::partition(whole.items.begin(), whole.items.end(),
                       [&](const PackedBox& item) { return bins.is_below(border, item); });
        return {group_of(whole.items.first(border.below.count), border.below.bounds),
                group_of(whole.items.subspan(border.below.count), border.above.bounds)};
    }

    static Group group_of(std::span<PackedBox> items, const PackedBounds& bounds) {
        return {items, bounds, half_surface<D>(bounds)};
    }
    static Group group_of(std::span<PackedBox> items) {
        PackedBounds bounds;
        for (const PackedBox& item : items) bounds.hold(item);
        return group_of(items, bounds);
    }

    /// The lower half along the axis along which the middles spread most; of items in one place, those with
    /// the lower numbers.
    static std::pair<Group, Group> halves(const Group& whole, const PackedBounds& centers) {
        const Four size = centers.upper - centers.lower;
        int axis = 0;
        for (int i = 1; i < D; ++i)
            if (size[i] > size[axis]) axis = i;
        const std::size_t middle = whole.items.size() / 2;
        std::nth_element(whole.items.begin(), whole.items.begin() + std::ptrdiff_t(middle), whole.items.end(),
                         [&](const PackedBox& a, const PackedBox& b) {
                             const float p = a.center()[axis], q = b.center()[axis];
                             return p != q ? p < q : a.number() < b.number();
                         });
        return {group_of(whole.items.first(middle)), group_of(whole.items.subspan(middle))};
    }

    /// Lays the grid of the node and rounds the children's boxes outwards to it. A step that is a little too
    /// large, and no less than a billionth of the longest, does no harm.
    void set_boxes(Node& node, const PackedBounds& whole, std::span<const Group> groups) const {
        double longest = 0;
        for (int i = 0; i < D; ++i)
            longest = std::max(longest, double(whole.upper[i]) - double(whole.lower[i]));
        for (int i = 0; i < D; ++i) {
            const double origin = whole.lower[i];
            node.origin[i] = base_[i] + origin;
            node.step[i] = std::max({(whole.upper[i] - origin) / 254, 1e-9 * longest, 1e-30});
            node.lower[i].fill(255);
            node.upper[i].fill(0);
            for (std::size_t k = 0; k < groups.size(); ++k) {
                const double from = (groups[k].bounds.lower[i] - origin) / node.step[i];
                const double to = (groups[k].bounds.upper[i] - origin) / node.step[i];
                node.lower[i][k] = std::uint8_t(from * (1 - 1e-14));
                node.upper[i][k] = std::uint8_t(std::ceil(to * (1 + 1e-14)));
            }
        }
    }

    const Vec<D>& base_;
    std::span<PackedBox> all_;
    std::vector<std::uint32_t>& order_;
    std::vector<Node>& nodes_;
    std::vector<Branch>* branches_;  ///< where what is not large is left for later; null while that is made
    Scheduler* scheduler_;
};

template <int D>
void FacetTree<D>::build(std::span<const Item> items, Scheduler* scheduler) {
    nodes_.clear();
    order_.assign(items.size(), 0);
    if (items.empty()) return;

    Aabb<D> whole = items[0].box;
    for (const Item& item : items) {
        for (int i = 0; i < D; ++i) {
            whole.lower[i] = std::min(whole.lower[i], item.box.lower[i]);
            whole.upper[i] = std::max(whole.upper[i], item.box.upper[i]);
        }
    }
    const Vec<D> base = 0.5 * (whole.lower + whole.upper);
    std::vector<PackedBox> packed(items.size());
    PackedBounds bounds;
    std::mutex joining;
    run_range(scheduler, items.size(), grain, [&](std::size_t begin, std::size_t end) {
        PackedBounds sum;
        for (std::size_t k = begin; k < end; ++k) {
            PackedBox box{};
            for (int i = 0; i < D; ++i) {
                // Room for the rounding of the base's distances and, later, of places that are told from it.
                const double low = items[k].box.lower[i], high = items[k].box.upper[i];
                const double room = 1e-15 * (std::fabs(base[i]) + std::max(std::fabs(low), std::fabs(high)));
                box.lower[i] = below(low - base[i] - room);
                box.upper[i] = -below(base[i] - high - room);
            }
            box.set_number(items[k].facet);
            packed[k] = box;
            sum.hold(box);
        }
        const std::lock_guard lock(joining);
        bounds.hold(sum);
    });

    std::vector<Branch> branches;
    Builder(base, packed, order_, nodes_, &branches, scheduler).make(packed, bounds, 0);
    std::vector<std::vector<Node>> made(branches.size());
    run_range(scheduler, branches.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Branch& branch = branches[k];
            Builder(base, packed, order_, made[k], nullptr, nullptr)
                .make(branch.items, branch.bounds, branch.depth);
        }
    });

    std::size_t count = nodes_.size();
    for (const auto& list : made) count += list.size();
    nodes_.reserve(count);
    for (std::size_t k = 0; k < branches.size(); ++k) {
        const auto first = std::uint32_t(nodes_.size());
        nodes_[branches[k].parent].child[std::size_t(branches[k].child)] = first;
        for (Node& node : made[k]) {
            for (std::uint32_t& child : node.child)
                if (!(child & leaf_bit)) child += first;
            nodes_.push_back(node);
        }
    }
}

template class FacetTree<2>;
template class FacetTree<3>;

}  // namespace carom::detail
