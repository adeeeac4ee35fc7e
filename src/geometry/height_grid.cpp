#include "geometry/height_grid.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace carom::detail {

template <int D>
HeightGrid<D>::HeightGrid(std::vector<double> heights, const Place& count,
                          const std::array<double, axes>& spacing, const Transform<D>& placed)
    : heights_(std::move(heights)), count_(count), spacing_(spacing), placed_(placed) {
    Level lowest;
    for (int i = 0; i < axes; ++i) lowest.count[i] = (count[i] - 1 + block_cells - 1) / block_cells;
    std::size_t blocks = lowest.count[0];
    if constexpr (D == 3) blocks *= lowest.count[1];
    lowest.ranges.resize(blocks);
    // A height between blocks belongs to all of them.
    const auto rows_end = D == 3 ? count[std::size_t(axes - 1)] : 1;
    for (std::uint32_t row = 0; row < rows_end; ++row) {
        for (std::uint32_t column = 0; column < count[0]; ++column) {
            const double height = heights_[std::size_t{row} * count[0] + column];
            if (!(std::fabs(height) < 1e300)) continue;
            const auto touched = [](std::uint32_t at, std::uint32_t blocks_along) {
                const std::uint32_t first = at > 0 ? (at - 1) / block_cells : 0;
                return std::pair(first, std::min(at / block_cells, blocks_along - 1));
            };
            const auto [left, right] = touched(column, lowest.count[0]);
            auto [front, back] = std::pair(0u, 0u);
            if constexpr (D == 3) std::tie(front, back) = touched(row, lowest.count[1]);
            for (std::uint32_t z = front; z <= back; ++z) {
                for (std::uint32_t x = left; x <= right; ++x) {
                    Range& range = lowest.ranges[std::size_t{z} * lowest.count[0] + x];
                    range.lowest = std::min(range.lowest, height);
                    range.highest = std::max(range.highest, height);
                }
            }
        }
    }
    levels_.push_back(std::move(lowest));
    add_levels();
}

template <int D>
void HeightGrid<D>::add_levels() {
    while (levels_.back().ranges.size() > 1) {
        Level level;
        std::size_t blocks = 1;
        for (int i = 0; i < axes; ++i) {
            level.count[i] = (levels_.back().count[i] + 1) / 2;
            blocks *= level.count[i];
        }
        level.ranges.resize(blocks);
        const std::uint32_t rows = D == 3 ? level.count[std::size_t(axes - 1)] : 1;
        levels_.push_back(std::move(level));
        for (std::uint32_t row = 0; row < rows; ++row) {
            for (std::uint32_t column = 0; column < levels_.back().count[0]; ++column) {
                Block block{std::uint32_t(levels_.size() - 1), {}};
                block.place[0] = column;
                if constexpr (D == 3) block.place[1] = row;
                Range range;
                each_part(block, [&](const Block& part) {
                    const Level& below = levels_[part.level];
                    const Range& other = below.ranges[index_of(part.place, below.count)];
                    range.lowest = std::min(range.lowest, other.lowest);
                    range.highest = std::max(range.highest, other.highest);
                });
                levels_.back().ranges[index_of(block.place, levels_.back().count)] = range;
            }
        }
    }
}

template <int D>
std::uint32_t HeightGrid<D>::size() const {
    std::uint32_t cells = 1;
    for (int i = 0; i < axes; ++i) cells *= count_[i] - 1;
    return cells * facets_per_cell;
}

template <int D>
Vec<D> HeightGrid<D>::corner(const Place& place) const {
    const double height = heights_[index_of(place, count_)];
    if constexpr (D == 2)
        return apply(placed_, {place[0] * spacing_[0], height});
    else
        return apply(placed_, {place[0] * spacing_[0], height, place[1] * spacing_[1]});
}

template <int D>
std::array<Vec<D>, D> HeightGrid<D>::facet(std::uint32_t index) const {
    if constexpr (D == 2) {
        return {corner({index}), corner({index + 1})};
    } else {
        const std::uint32_t cell = index / 2, columns = count_[0] - 1;
        const std::uint32_t x = cell % columns, z = cell / columns;
        const Vec3 from = corner({x, z}), to = corner({x + 1, z + 1});
        return index % 2 == 0 ? std::array{from, corner({x, z + 1}), to}
                              : std::array{from, to, corner({x + 1, z})};
    }
}

/// The box around `box` in the frame of the field, grown by more than the rounding of carrying it there.
template <int D>
Aabb<D> HeightGrid<D>::local(const Aabb<D>& box) const {
    const Vec<D> half = 0.5 * (box.upper - box.lower);
    const Vec<D> middle = apply_inverse(placed_, 0.5 * (box.lower + box.upper));
    Vec<D> reach{};
    double largest = 0;
    for (int i = 0; i < D; ++i) {
        Vec<D> axis{};
        axis[i] = half[i];
        const Vec<D> turned = unrotate(placed_.rotation, axis);
        for (int j = 0; j < D; ++j) reach[j] += std::fabs(turned[j]);
        largest = std::max(
            {largest, std::fabs(box.lower[i]), std::fabs(box.upper[i]), std::fabs(placed_.position[i])});
    }
    for (int i = 0; i < D; ++i) reach[i] += 1e-14 * largest;
    return {middle - reach, middle + reach};
}

template <int D>
Aabb<D> HeightGrid<D>::box_of(const Block& block) const {
    const Level& level = levels_[block.level];
    const Range& range = level.ranges[index_of(block.place, level.count)];
    const double cells = double(block_cells) * double(std::uint64_t{1} << block.level);
    Aabb<D> box;
    for (int i = 0; i < axes; ++i) {
        const int axis = 2 * i;  // x, and z in space
        const double last = count_[i] - 1;
        box.lower[axis] = block.place[i] * cells * spacing_[i];
        box.upper[axis] = std::min((block.place[i] + 1) * cells, last) * spacing_[i];
    }
    box.lower[1] = range.lowest;
    box.upper[1] = range.highest;
    return box;
}

template <int D>
std::size_t HeightGrid<D>::bytes() const {
    std::size_t sum = heights_.size() * sizeof(double);
    for (const Level& level : levels_) sum += level.ranges.size() * sizeof(Range);
    return sum;
}

template class HeightGrid<2>;
template class HeightGrid<3>;

}  // namespace carom::detail
