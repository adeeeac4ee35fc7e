#include "solver/block_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace carom::detail {

namespace {

/// The neighbours of each node, ascending.
std::vector<std::vector<std::uint32_t>> neighbours_of(std::uint32_t nodes, std::span<const NodePair> edges) {
    std::vector<std::vector<std::uint32_t>> all(nodes);
    for (const NodePair& e : edges) {
        all[e.row].push_back(e.column);
        all[e.column].push_back(e.row);
    }
    for (auto& list : all) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return all;
}

}  // namespace

std::vector<std::uint32_t> elimination_order(std::uint32_t nodes, std::span<const NodePair> edges) {
    auto near = neighbours_of(nodes, edges);
    std::set<std::pair<std::size_t, std::uint32_t>> left;
    for (std::uint32_t i = 0; i < nodes; ++i) left.insert({near[i].size(), i});
    std::vector<std::uint32_t> order, merged;
    order.reserve(nodes);
    while (!left.empty()) {
        const std::uint32_t node = left.begin()->second;
        left.erase(left.begin());
        order.push_back(node);
        // The neighbours become neighbours of one another.
        for (const std::uint32_t i : near[node]) {
            left.erase({near[i].size(), i});
            merged.clear();
            std::ranges::set_union(near[i], near[node], std::back_inserter(merged));
            std::erase_if(merged, [&](std::uint32_t k) { return k == node || k == i; });
            near[i] = merged;
            left.insert({near[i].size(), i});
        }
        near[node].clear();
    }
    return order;
}

void BlockMatrix::plan(std::span<const std::uint8_t> sizes, std::span<const NodePair> pairs) {
    const auto count = static_cast<std::uint32_t>(sizes.size());
    std::vector<std::vector<std::uint32_t>> below(count);
    for (const NodePair& p : pairs) below[p.column].push_back(p.row);
    columns_.assign(count, {});
    blocks_.clear();
    rows_ = 0;
    std::uint32_t place = 0;
    for (std::uint32_t k = 0; k < count; ++k) {
        auto& list = below[k];
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
        // What is below the first of them is filled in (the parent in the elimination tree).
        if (list.size() > 1) below[list[0]].insert(below[list[0]].end(), list.begin() + 1, list.end());
        Column& column = columns_[k];
        column.size = sizes[k];
        column.first_row = rows_;
        rows_ += sizes[k];
        column.diagonal = place;
        place += column.size * column.size;
        column.first_block = static_cast<std::uint32_t>(blocks_.size());
        for (const std::uint32_t row : list) {
            blocks_.push_back({row, place});
            place += column.size * sizes[row];
        }
        column.last_block = static_cast<std::uint32_t>(blocks_.size());
    }
    values_.assign(place, 0);
    factors_.assign(place, 0);
    inverse_pivots_.assign(rows_, 0);
    targets_.clear();
    for (Column& column : columns_) {
        column.first_target = static_cast<std::uint32_t>(targets_.size());
        for (std::uint32_t q = column.first_block; q < column.last_block; ++q) {
            targets_.push_back(columns_[blocks_[q].row].diagonal);
            for (std::uint32_t p = q + 1; p < column.last_block; ++p)
                targets_.push_back(this->place({blocks_[p].row, blocks_[q].row}));
        }
    }
}

std::uint32_t BlockMatrix::place(NodePair pair) const {
    const Column& column = columns_[pair.column];
    const auto first = blocks_.begin() + column.first_block, last = blocks_.begin() + column.last_block;
    return std::ranges::lower_bound(first, last, pair.row, {}, &Block::row)->place;
}

void BlockMatrix::clear(std::uint32_t begin, std::uint32_t end) {
    const std::size_t from = columns_[begin].diagonal;
    const std::size_t to = end < nodes() ? columns_[end].diagonal : values_.size();
    std::fill(values_.begin() + static_cast<std::ptrdiff_t>(from),
              values_.begin() + static_cast<std::ptrdiff_t>(to), 0.0);
}

void BlockMatrix::copy_kept(const Column& column, std::span<const std::uint8_t> kept) {
    const std::uint32_t n = column.size;
    const std::uint8_t* own = kept.data() + column.first_row;
    for (std::uint32_t r = 0; r < n; ++r) {
        for (std::uint32_t c = 0; c <= r; ++c) {
            const std::uint32_t at = column.diagonal + r * n + c;
            factors_[at] = own[r] && own[c] ? values_[at] : 0;
        }
    }
    for (std::uint32_t b = column.first_block; b < column.last_block; ++b) {
        const Column& row = columns_[blocks_[b].row];
        std::uint32_t at = blocks_[b].place;
        for (std::uint32_t r = 0; r < row.size; ++r) {
            for (std::uint32_t c = 0; c < n; ++c, ++at)
                factors_[at] = kept[row.first_row + r] && own[c] ? values_[at] : 0;
        }
    }
}

/// Cholesky factors of the block on the diagonal. A pivot that is so much smaller than what it began as is
/// that of a row which the others imply.
void BlockMatrix::factorise_diagonal(const Column& column) {
    constexpr double smallest = 1e-12;
    const std::uint32_t n = column.size;
    double* a = factors_.data() + column.diagonal;
    const double* whole = values_.data() + column.diagonal;
    double* inverse = inverse_pivots_.data() + column.first_row;
    for (std::uint32_t p = 0; p < n; ++p) {
        double pivot = a[p * n + p];
        for (std::uint32_t c = 0; c < p; ++c) pivot -= a[p * n + c] * a[p * n + c];
        const double first = whole[p * n + p];
        inverse[p] = first > 0 && pivot > smallest * first ? 1 / std::sqrt(pivot) : 0;
        for (std::uint32_t r = p + 1; r < n; ++r) {
            double sum = a[r * n + p];
            for (std::uint32_t c = 0; c < p; ++c) sum -= a[r * n + c] * a[p * n + c];
            a[r * n + p] = sum * inverse[p];
        }
    }
}

/// The block becomes that of the factors: times the inverse transpose of the column's own factor.
void BlockMatrix::divide(const Column& column, const Block& block) {
    const std::uint32_t n = column.size, rows = columns_[block.row].size;
    const double* own = factors_.data() + column.diagonal;
    const double* inverse = inverse_pivots_.data() + column.first_row;
    double* a = factors_.data() + block.place;
    for (std::uint32_t r = 0; r < rows; ++r, a += n) {
        for (std::uint32_t c = 0; c < n; ++c) {
            double sum = a[c];
            for (std::uint32_t k = 0; k < c; ++k) sum -= a[k] * own[c * n + k];
            a[c] = sum * inverse[c];
        }
    }
}

void BlockMatrix::factorise(std::uint32_t begin, std::uint32_t end, std::span<const std::uint8_t> kept) {
    for (std::uint32_t k = begin; k < end; ++k) copy_kept(columns_[k], kept);
    for (std::uint32_t k = begin; k < end; ++k) {
        const Column& column = columns_[k];
        const std::uint32_t n = column.size;
        factorise_diagonal(column);
        for (std::uint32_t b = column.first_block; b < column.last_block; ++b) divide(column, blocks_[b]);
        const std::uint32_t* target = targets_.data() + column.first_target;
        for (std::uint32_t q = column.first_block; q < column.last_block; ++q) {
            const std::uint32_t wide = columns_[blocks_[q].row].size;
            const double* y = factors_.data() + blocks_[q].place;
            for (std::uint32_t p = q; p < column.last_block; ++p, ++target) {
                const std::uint32_t high = columns_[blocks_[p].row].size;
                const double* x = factors_.data() + blocks_[p].place;
                double* to = factors_.data() + *target;
                for (std::uint32_t r = 0; r < high; ++r) {
                    for (std::uint32_t c = 0; c < wide; ++c) {
                        double sum = 0;
                        for (std::uint32_t i = 0; i < n; ++i) sum += x[r * n + i] * y[c * n + i];
                        to[r * wide + c] -= sum;
                    }
                }
            }
        }
    }
}

void BlockMatrix::solve(std::uint32_t begin, std::uint32_t end, std::span<double> right) const {
    for (std::uint32_t k = begin; k < end; ++k) {
        const Column& column = columns_[k];
        const std::uint32_t n = column.size;
        const double* own = factors_.data() + column.diagonal;
        double* x = right.data() + column.first_row;
        for (std::uint32_t r = 0; r < n; ++r) {
            for (std::uint32_t c = 0; c < r; ++c) x[r] -= own[r * n + c] * x[c];
            x[r] *= inverse_pivots_[column.first_row + r];
        }
        for (std::uint32_t b = column.first_block; b < column.last_block; ++b) {
            const Column& row = columns_[blocks_[b].row];
            const double* a = factors_.data() + blocks_[b].place;
            double* y = right.data() + row.first_row;
            for (std::uint32_t r = 0; r < row.size; ++r, a += n) {
                for (std::uint32_t c = 0; c < n; ++c) y[r] -= a[c] * x[c];
            }
        }
    }
    for (std::uint32_t k = end; k-- > begin;) {
        const Column& column = columns_[k];
        const std::uint32_t n = column.size;
        const double* own = factors_.data() + column.diagonal;
        double* x = right.data() + column.first_row;
        for (std::uint32_t b = column.first_block; b < column.last_block; ++b) {
            const Column& row = columns_[blocks_[b].row];
            const double* a = factors_.data() + blocks_[b].place;
            const double* y = right.data() + row.first_row;
            for (std::uint32_t r = 0; r < row.size; ++r, a += n) {
                for (std::uint32_t c = 0; c < n; ++c) x[c] -= a[c] * y[r];
            }
        }
        for (std::uint32_t r = n; r-- > 0;) {
            for (std::uint32_t c = r + 1; c < n; ++c) x[r] -= own[c * n + r] * x[c];
            x[r] *= inverse_pivots_[column.first_row + r];
        }
    }
}

}  // namespace carom::detail
