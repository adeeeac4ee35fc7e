#include "solver/block_matrix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

// The sparse factors against dense elimination.

namespace carom::detail {
namespace {

double random_number(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) / 9007199254740992.0 - 0.5;
}

/// A random graph of nodes with blocks of one to four rows, and a positive matrix over it: B Bᵀ, where each
/// column of B belongs to a pair of nodes.
struct Problem {
    std::vector<std::uint8_t> sizes;
    std::vector<NodePair> pairs;
    BlockMatrix matrix;
    std::vector<std::vector<double>> dense;

    explicit Problem(std::uint64_t seed) {
        std::mt19937_64 random(seed);
        const auto nodes = static_cast<std::uint32_t>(2 + random() % 12);
        for (std::uint32_t i = 0; i < nodes; ++i)
            sizes.push_back(static_cast<std::uint8_t>(1 + random() % 4));
        for (std::uint32_t i = 1; i < nodes; ++i) {
            pairs.push_back({i, static_cast<std::uint32_t>(random() % i)});
            if (random() % 3 == 0) pairs.push_back({i, static_cast<std::uint32_t>(random() % i)});
        }
        matrix.plan(sizes, pairs);
        const std::size_t rows = matrix.rows();
        dense.assign(rows, std::vector<double>(rows, 0));
        const auto add_column = [&](std::uint32_t a, std::uint32_t b) {
            std::vector<double> column(rows, 0);
            for (const std::uint32_t node : {a, b})
                for (std::uint32_t r = 0; r < sizes[node]; ++r)
                    column[matrix.first_row(node) + r] = random_number(random);
            for (std::size_t r = 0; r < rows; ++r)
                for (std::size_t c = 0; c < rows; ++c) dense[r][c] += column[r] * column[c];
        };
        for (std::uint32_t i = 0; i < nodes; ++i)
            for (std::uint32_t r = 0; r < sizes[i]; ++r) add_column(i, i);
        for (const NodePair& p : pairs) add_column(p.row, p.column);
        fill();
    }

    /// Writes the dense matrix into the blocks.
    void fill() {
        matrix.clear(0, matrix.nodes());
        const auto write = [&](std::uint32_t row, std::uint32_t column, std::uint32_t place) {
            for (std::uint32_t r = 0; r < sizes[row]; ++r)
                for (std::uint32_t c = 0; c < sizes[column]; ++c)
                    matrix.values()[place++] = dense[matrix.first_row(row) + r][matrix.first_row(column) + c];
        };
        for (std::uint32_t i = 0; i < matrix.nodes(); ++i) write(i, i, matrix.place_of_diagonal(i));
        for (const NodePair& p : pairs) write(p.row, p.column, matrix.place(p));
    }

    std::vector<double> times(const std::vector<double>& x) const {
        std::vector<double> y(x.size(), 0);
        for (std::size_t r = 0; r < x.size(); ++r)
            for (std::size_t c = 0; c < x.size(); ++c) y[r] += dense[r][c] * x[c];
        return y;
    }
};

TEST(BlockMatrix, SolvesWhatItWasMadeOf) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Problem p(seed);
        std::mt19937_64 random(seed + 1000);
        std::vector<double> x(p.matrix.rows());
        for (double& value : x) value = random_number(random);
        std::vector<double> right = p.times(x);
        const std::vector<std::uint8_t> all(x.size(), 1);
        p.matrix.factorise(0, p.matrix.nodes(), all);
        p.matrix.solve(0, p.matrix.nodes(), right);
        const std::vector<double> back = p.times(right);
        const std::vector<double> wanted = p.times(x);
        for (std::size_t r = 0; r < x.size(); ++r) EXPECT_NEAR(back[r], wanted[r], 1e-9);
    }
}

TEST(BlockMatrix, RowsThatAreNotKeptStayZeroAndOutOfTheOthers) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        SCOPED_TRACE(seed);
        Problem p(seed);
        std::mt19937_64 random(seed + 2000);
        std::vector<std::uint8_t> kept(p.matrix.rows());
        for (auto& k : kept) k = random() % 3 != 0;
        std::vector<double> x(p.matrix.rows());
        for (std::size_t r = 0; r < x.size(); ++r) x[r] = kept[r] ? random_number(random) : 0;
        const std::vector<double> right = p.times(x);
        std::vector<double> found = right;
        p.matrix.factorise(0, p.matrix.nodes(), kept);
        p.matrix.solve(0, p.matrix.nodes(), found);
        const std::vector<double> back = p.times(found);
        for (std::size_t r = 0; r < x.size(); ++r) {
            if (kept[r])
                EXPECT_NEAR(back[r], right[r], 1e-9);
            else
                EXPECT_EQ(found[r], 0);
        }
    }
}

/// Two rows that say the same: one of them drops out, and the system is solved all the same.
TEST(BlockMatrix, ImpliedRowsDropOut) {
    BlockMatrix matrix;
    const std::uint8_t sizes[] = {2, 1};
    const NodePair pairs[] = {{1, 0}};
    matrix.plan(sizes, pairs);
    // Rows 0 and 2 are the same.
    const double own[] = {2, 0, 0, 1}, beside[] = {2, 0};
    std::ranges::copy(own, matrix.values().begin() + matrix.place_of_diagonal(0));
    std::ranges::copy(beside, matrix.values().begin() + matrix.place({1, 0}));
    matrix.values()[matrix.place_of_diagonal(1)] = 2;
    const std::uint8_t kept[] = {1, 1, 1};
    matrix.factorise(0, 2, kept);
    double right[] = {4, 3, 4};
    matrix.solve(0, 2, right);
    EXPECT_NEAR(2 * right[0] + 2 * right[2], 4, 1e-12);
    EXPECT_NEAR(right[1], 3, 1e-12);
}

TEST(BlockMatrix, EliminationOfATreeFillsNothingIn) {
    // A star of chains: every node but the last has one neighbour that is eliminated later.
    std::vector<NodePair> edges;
    for (std::uint32_t arm = 0; arm < 5; ++arm) {
        for (std::uint32_t i = 0; i < 6; ++i) edges.push_back({1 + arm * 6 + i, i == 0 ? 0 : arm * 6 + i});
    }
    const std::vector<std::uint32_t> order = elimination_order(31, edges);
    ASSERT_EQ(order.size(), 31u);
    std::vector<std::uint32_t> place(31);
    for (std::uint32_t k = 0; k < 31; ++k) place[order[k]] = k;
    std::vector<int> later(31, 0);
    for (const NodePair& e : edges) ++later[place[e.row] < place[e.column] ? e.row : e.column];
    EXPECT_EQ(*std::ranges::max_element(later), 1);
}

}  // namespace
}  // namespace carom::detail
