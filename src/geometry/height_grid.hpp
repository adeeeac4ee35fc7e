#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/shapes.hpp"
#include "geometry/ray.hpp"

namespace carom::detail {

/// The cells of a height field with a pyramid over them: each of its blocks knows the lowest and the highest
/// height of four cells in each direction, and each block of the next level those of two blocks in each
/// direction. A cell is one segment, or two triangles that follow each other.
template <int D>
class HeightGrid {
  public:
    static constexpr int axes = D - 1;  ///< directions in which cells lie beside each other
    static constexpr int facets_per_cell = D == 2 ? 1 : 2;
    using Place = std::array<std::uint32_t, axes>;  ///< of a cell or block: column, and row

    HeightGrid() = default;
    /// `heights` row by row, `count` of them in each direction; NaN for a hole.
    HeightGrid(std::vector<double> heights, const Place& count, const std::array<double, axes>& spacing,
               const Transform<D>& placed);

    std::uint32_t size() const;
    /// Corners in the frame of the body; not finite at a hole.
    std::array<Vec<D>, D> facet(std::uint32_t index) const;

    /// Calls `visit(facet)` for every facet that may overlap the box (in the frame of the body), and others.
    template <class Visitor>
    void query(const Aabb<D>& box, Visitor&& visit) const;
    /// Calls `visit(facet, max_fraction)` for every facet that the ray (in the frame of the body) may meet
    /// before `max_fraction`, blocks front to back; what it returns is the `max_fraction` from then on.
    template <class Visitor>
    void cast(const Ray<D>& ray, double max_fraction, Visitor&& visit) const;

    std::size_t bytes() const;

  private:
    struct Range {
        double lowest = 1e300, highest = -1e300;
    };
    struct Level {
        Place count{};
        std::vector<Range> ranges;
    };
    struct Block {
        std::uint32_t level;
        Place place;
    };
    static constexpr std::uint32_t block_cells = 4;
    static constexpr int most_levels = 32;
    static constexpr int stack_size = 4 * most_levels;

    static std::size_t index_of(const Place& place, const Place& count) {
        std::size_t index = place[0];
        if constexpr (D == 3) index += std::size_t{place[1]} * count[0];
        return index;
    }
    Vec<D> corner(const Place& place) const;
    Aabb<D> local(const Aabb<D>& box) const;
    Aabb<D> box_of(const Block& block) const;
    void add_levels();
    /// Calls `visit(block)` for each block of the level beneath.
    template <class Visitor>
    void each_part(const Block& block, Visitor&& visit) const;
    /// Calls `visit(facet)` for the facets of a block of the lowest level.
    template <class Visitor>
    void each_facet(const Block& block, Visitor&& visit) const;

    std::vector<double> heights_;
    Place count_{};  ///< of heights
    std::array<double, axes> spacing_{};
    Transform<D> placed_{};
    std::vector<Level> levels_;
};

template <int D>
template <class Visitor>
void HeightGrid<D>::each_part(const Block& block, Visitor&& visit) const {
    const Level& below = levels_[block.level - 1];
    for (std::uint32_t k = 0; k < (D == 2 ? 2 : 4); ++k) {
        Place place;
        bool exists = true;
        for (int i = 0; i < axes; ++i) {
            place[i] = 2 * block.place[i] + (k >> i & 1);
            exists = exists && place[i] < below.count[i];
        }
        if (exists) visit(Block{block.level - 1, place});
    }
}

template <int D>
template <class Visitor>
void HeightGrid<D>::each_facet(const Block& block, Visitor&& visit) const {
    const std::uint32_t column = block.place[0] * block_cells;
    const std::uint32_t column_end = std::min(column + block_cells, count_[0] - 1);
    if constexpr (D == 2) {
        for (std::uint32_t x = column; x < column_end; ++x) visit(x);
    } else {
        const std::uint32_t row = block.place[1] * block_cells;
        const std::uint32_t row_end = std::min(row + block_cells, count_[1] - 1);
        for (std::uint32_t z = row; z < row_end; ++z) {
            for (std::uint32_t x = column; x < column_end; ++x) {
                const std::uint32_t first = 2 * (z * (count_[0] - 1) + x);
                visit(first);
                visit(first + 1);
            }
        }
    }
}

template <int D>
template <class Visitor>
void HeightGrid<D>::query(const Aabb<D>& box, Visitor&& visit) const {
    if (levels_.empty()) return;
    const Aabb<D> wanted = local(box);
    std::array<Block, stack_size> stack;
    int count = 0;
    stack[count++] = {std::uint32_t(levels_.size() - 1), {}};
    while (count > 0) {
        const Block block = stack[--count];
        const Aabb<D> here = box_of(block);
        bool meets = true;
        for (int i = 0; i < D; ++i)
            meets = meets && here.lower[i] <= wanted.upper[i] && wanted.lower[i] <= here.upper[i];
        if (!meets) continue;
        if (block.level == 0)
            each_facet(block, visit);
        else
            each_part(block, [&](const Block& part) { stack[count++] = part; });
    }
}

template <int D>
template <class Visitor>
void HeightGrid<D>::cast(const Ray<D>& ray, double max_fraction, Visitor&& visit) const {
    if (levels_.empty()) return;
    const Aabb<D> around = local({ray.origin - ray.half, ray.origin + ray.half});
    const Ray<D> here{0.5 * (around.lower + around.upper), unrotate(placed_.rotation, ray.translation),
                      0.5 * (around.upper - around.lower)};
    struct Entry {
        double fraction;
        Block block;
    };
    std::array<Entry, stack_size> stack;
    int count = 0;
    stack[count++] = {0, {std::uint32_t(levels_.size() - 1), {}}};
    while (count > 0) {
        const Entry top = stack[--count];
        if (top.fraction > max_fraction) continue;
        if (top.block.level == 0) {
            each_facet(top.block, [&](std::uint32_t facet) { max_fraction = visit(facet, max_fraction); });
            continue;
        }
        const int begin = count;
        each_part(top.block, [&](const Block& part) {
            const double fraction = entry(here, box_of(part), max_fraction);
            if (fraction > max_fraction) return;
            int place = count++;
            for (; place > begin && stack[place - 1].fraction <= fraction; --place)
                stack[place] = stack[place - 1];
            stack[place] = {fraction, part};
        });
    }
}

}  // namespace carom::detail
