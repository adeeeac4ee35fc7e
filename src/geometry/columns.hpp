#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "carom/vec.hpp"

namespace carom::detail {

/// A list of vectors that is only read, laid out so that products with one vector are taken two at a time.
/// The products have the bits of `dot`.
class Columns {
  public:
    Columns() = default;
    explicit Columns(const std::vector<Vec3>& list);  ///< of at least one

    bool empty() const { return blocks_.empty(); }
    /// The index of the vector that lies furthest along the direction; the first of several.
    std::size_t furthest(const Vec3& direction) const;
    /// The products of all with the vector, into room for `padded_size()`.
    void products(const Vec3& v, double* result) const;
    std::size_t padded_size() const { return 4 * blocks_.size(); }
    /// The least and the greatest product with the direction.
    std::array<double, 2> range(const Vec3& direction) const;

  private:
    using Two [[gnu::vector_size(16)]] = double;
    /// Four vectors. The last one is repeated where there are fewer.
    struct Block {
        Two x[2], y[2], z[2];
    };
    static void products(const Block& block, const Vec3& v, Two (&result)[2]) {
        for (int k = 0; k < 2; ++k) result[k] = block.x[k] * v.x + block.y[k] * v.y + block.z[k] * v.z;
    }

    std::vector<Block> blocks_;
};

}  // namespace carom::detail
