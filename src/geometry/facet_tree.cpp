#include "geometry/facet_tree.hpp"

#include <span>

namespace carom::detail {

namespace {

constexpr int bins = 16;

template <int D>
Aabb<D> nothing() {
    Aabb<D> box;
    for (int i = 0; i < D; ++i) {
        box.lower[i] = 1e300;
        box.upper[i] = -1e300;
    }
    return box;
}

template <int D>
void enclose(Aabb<D>& box, const Aabb<D>& other) {
    for (int i = 0; i < D; ++i) {
        box.lower[i] = std::min(box.lower[i], other.lower[i]);
        box.upper[i] = std::max(box.upper[i], other.upper[i]);
    }
}

/// Half of the perimeter or surface: how likely a random line is to hit the box.
template <int D>
double surface(const Aabb<D>& box) {
    const Vec<D> size = box.upper - box.lower;
    if constexpr (D == 2)
        return size.x + size.y;
    else
        return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace

template <int D>
class FacetTree<D>::Builder {
  public:
    Builder(FacetTree& tree, std::vector<Item>& items) : tree_(tree), items_(items) {}

    /// Makes the node of the items and all beneath it; returns its index.
    std::uint32_t make(std::span<Item> items, int depth) {
        std::array<Part, width> parts;
        parts[0] = part_of(items);
        int count = 1;
        // The part with the largest surface is parted next, until there are eight or all are leaves.
        while (count < width) {
            int widest = -1;
            for (int k = 0; k < count; ++k) {
                if (parts[k].items.size() <= largest_leaf) continue;
                if (widest < 0 || parts[k].surface > parts[widest].surface) widest = k;
            }
            if (widest < 0) break;
            const std::span<Item> whole = parts[widest].items;
            const std::size_t middle =
                depth < deepest_heuristic ? split(whole, parts[widest].box) : halve(whole, parts[widest].box);
            parts[widest] = part_of(whole.first(middle));
            parts[count++] = part_of(whole.subspan(middle));
        }
        const auto index = std::uint32_t(tree_.nodes_.size());
        tree_.nodes_.emplace_back();
        set_boxes(tree_.nodes_[index], std::span(parts).first(std::size_t(count)));
        for (int k = 0; k < count; ++k) {
            const bool leaf = parts[k].items.size() <= largest_leaf;
            const std::uint32_t child = leaf ? make_leaf(parts[k].items) : make(parts[k].items, depth + 1);
            tree_.nodes_[index].child[std::size_t(k)] = child;
        }
        return index;
    }

  private:
    struct Part {
        std::span<Item> items;
        Aabb<D> box;
        double surface;
    };

    static Part part_of(std::span<Item> items) {
        Aabb<D> box = nothing<D>();
        for (const Item& item : items) enclose(box, item.box);
        return {items, box, surface(box)};
    }

    std::uint32_t make_leaf(std::span<Item> items) {
        const auto first = std::uint32_t(items.data() - items_.data());
        std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.facet < b.facet; });
        for (std::size_t i = 0; i < items.size(); ++i) tree_.order_[first + i] = items[i].facet;
        return leaf_bit | std::uint32_t(items.size() - 1) << count_shift | first;
    }

    /// Twice the middle of the box.
    static double centre(const Item& item, int axis) { return item.box.lower[axis] + item.box.upper[axis]; }

    struct Bin {
        Aabb<D> box = nothing<D>();
        std::size_t count = 0;
    };
    /// Maps centres to bins along one axis.
    struct Ruler {
        double lowest, scale;
        int bin(double c) const { return std::clamp(int((c - lowest) * scale), 0, bins - 1); }
    };

    /// Puts the items that belong to one side first and returns how many they are.
    std::size_t split(std::span<Item> items, const Aabb<D>& box) {
        Vec<D> lowest = items[0].box.lower + items[0].box.upper, highest = lowest;
        for (const Item& item : items) {
            for (int i = 0; i < D; ++i) {
                lowest[i] = std::min(lowest[i], centre(item, i));
                highest[i] = std::max(highest[i], centre(item, i));
            }
        }
        double least = 1e300;
        int axis = -1, border = 0;
        std::array<Ruler, D> rulers;
        for (int i = 0; i < D; ++i) {
            rulers[i] = {lowest[i], bins / (highest[i] - lowest[i])};
            if (!(rulers[i].scale < 1e300)) continue;  // all in one place
            std::array<Bin, bins> row;
            for (const Item& item : items) {
                Bin& bin = row[std::size_t(rulers[i].bin(centre(item, i)))];
                enclose(bin.box, item.box);
                ++bin.count;
            }
            const auto [cost, place] = cheapest(row);
            if (cost >= least) continue;
            least = cost;
            axis = i;
            border = place;
        }
        if (axis < 0) return halve(items, box);
        const auto middle = std::partition(items.begin(), items.end(), [&](const Item& item) {
            return rulers[axis].bin(centre(item, axis)) < border;
        });
        return std::size_t(middle - items.begin());
    }

    /// The border between bins at which surface × number, summed over both sides, is least.
    static std::pair<double, int> cheapest(const std::array<Bin, bins>& row) {
        std::array<double, bins> right_cost{};
        Bin side;
        for (int k = bins - 1; k > 0; --k) {
            enclose(side.box, row[k].box);
            side.count += row[k].count;
            right_cost[k] = side.count > 0 ? surface(side.box) * double(side.count) : -1;
        }
        side = {};
        std::pair<double, int> best{1e300, 0};
        for (int k = 1; k < bins; ++k) {
            enclose(side.box, row[k - 1].box);
            side.count += row[k - 1].count;
            if (side.count == 0 || right_cost[k] < 0) continue;
            const double cost = surface(side.box) * double(side.count) + right_cost[k];
            if (cost < best.first) best = {cost, k};
        }
        return best;
    }

    /// The lower half along the longest axis; of items in one place, those with the lower numbers.
    std::size_t halve(std::span<Item> items, const Aabb<D>& box) {
        const Vec<D> size = box.upper - box.lower;
        int axis = 0;
        for (int i = 1; i < D; ++i)
            if (size[i] > size[axis]) axis = i;
        const std::size_t middle = items.size() / 2;
        std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(middle), items.end(),
                         [&](const Item& a, const Item& b) {
                             const double p = centre(a, axis), q = centre(b, axis);
                             return p != q ? p < q : a.facet < b.facet;
                         });
        return middle;
    }

    /// Lays the grid of the node and rounds the children's boxes outwards to it. A step that is a little too
    /// large, and no less than a billionth of the longest, does no harm.
    static void set_boxes(Node& node, std::span<const Part> parts) {
        Aabb<D> box = nothing<D>();
        for (const Part& part : parts) enclose(box, part.box);
        double longest = 0;
        for (int i = 0; i < D; ++i) longest = std::max(longest, box.upper[i] - box.lower[i]);
        for (int i = 0; i < D; ++i) {
            node.origin[i] = box.lower[i];
            node.step[i] = std::max({(box.upper[i] - box.lower[i]) / 254, 1e-9 * longest, 1e-30});
            node.lower[i].fill(255);
            node.upper[i].fill(0);
            for (std::size_t k = 0; k < parts.size(); ++k) {
                const double from = (parts[k].box.lower[i] - node.origin[i]) / node.step[i];
                const double to = (parts[k].box.upper[i] - node.origin[i]) / node.step[i];
                node.lower[i][k] = std::uint8_t(from * (1 - 1e-14));
                node.upper[i][k] = std::uint8_t(std::ceil(to * (1 + 1e-14)));
            }
        }
    }

    FacetTree& tree_;
    std::vector<Item>& items_;
};

template <int D>
void FacetTree<D>::build(std::vector<Item> items) {
    nodes_.clear();
    order_.assign(items.size(), 0);
    if (!items.empty()) Builder(*this, items).make(items, 0);
    nodes_.shrink_to_fit();
}

template class FacetTree<2>;
template class FacetTree<3>;

}  // namespace carom::detail
