#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace carom::detail {

/// Two nodes of a graph; in a matrix the row and the column of a block below the diagonal.
struct NodePair {
    std::uint32_t row = 0, column = 0;
    friend bool operator==(const NodePair&, const NodePair&) = default;
    friend auto operator<=>(const NodePair&, const NodePair&) = default;
};

/// In which order the nodes of a graph are eliminated so that little is filled in: always the one with the
/// fewest neighbours left (minimum degree; Tinney and Walker 1967), of those the first. The leaves of a tree
/// go first and nothing is filled in. The answer is the node at each place.
std::vector<std::uint32_t> elimination_order(std::uint32_t nodes, std::span<const NodePair> edges);

/// A symmetric positive matrix of blocks, of which few are not zero, and its Cholesky factors. The structure
/// is worked out once, with room for what elimination fills in; then the matrix is set and factorised as
/// often as one likes, without allocation. Columns are eliminated in their order.
class BlockMatrix {
  public:
    /// `sizes` of the nodes' blocks, and which pairs of nodes have one beside the diagonal (row > column).
    void plan(std::span<const std::uint8_t> sizes, std::span<const NodePair> pairs);

    std::uint32_t nodes() const { return static_cast<std::uint32_t>(columns_.size()); }
    /// The first row of a node.
    std::uint32_t first_row(std::uint32_t node) const { return columns_[node].first_row; }
    std::uint32_t rows() const { return rows_; }
    /// Where the block of two nodes begins in `values`; row by row.
    std::uint32_t place(NodePair pair) const;
    std::uint32_t place_of_diagonal(std::uint32_t node) const { return columns_[node].diagonal; }

    /// The matrix itself, as far as it lies on and below the diagonal.
    std::span<double> values() { return values_; }
    void clear(std::uint32_t begin, std::uint32_t end);

    /// Factorises the columns of nodes begin … end, which have no block with others. Rows that are not `kept`
    /// stay out. A row that others of its node and of nodes before it imply (its pivot is too small) drops
    /// out too.
    void factorise(std::uint32_t begin, std::uint32_t end, std::span<const std::uint8_t> kept);
    /// Solves for the right side in place; rows that dropped out become zero.
    void solve(std::uint32_t begin, std::uint32_t end, std::span<double> right) const;

  private:
    struct Column {
        std::uint32_t size = 0, first_row = 0;
        std::uint32_t diagonal = 0;  ///< place in `values`
        std::uint32_t first_block = 0, last_block = 0;
        std::uint32_t first_target = 0;
    };
    struct Block {
        std::uint32_t row = 0;  ///< node
        std::uint32_t place = 0;
    };

    void copy_kept(const Column& column, std::span<const std::uint8_t> kept);
    void factorise_diagonal(const Column& column);
    void divide(const Column& column, const Block& block);

    std::uint32_t rows_ = 0;
    std::vector<Column> columns_;
    std::vector<Block> blocks_;  ///< below the diagonal, by column
    std::vector<std::uint32_t>
        targets_;  ///< by column: for each pair of its blocks, where their product goes
    std::vector<double> values_, factors_;
    std::vector<double> inverse_pivots_;  ///< by row; zero for those that dropped out
};

}  // namespace carom::detail
