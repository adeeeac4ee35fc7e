#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "geometry/shape.hpp"

namespace carom::detail {

/// Room for the common case; larger polyhedra spill to the heap.
struct Memory3 {
    alignas(std::max_align_t) std::array<std::byte, 16 * 1024> bytes;
    std::pmr::monotonic_buffer_resource resource{bytes.data(), bytes.size()};
};

/// How far a point lies above each face of a polyhedron. If the point is one of another polyhedron, no gap
/// between the two along the normal of the face is larger. Nor is one along a normal between those of two
/// faces that share an edge larger than the larger of their heights, if that is negative.
class Heights3 {
  public:
    Heights3(const Polyhedron& core, const Vec3& point, Memory3& memory) : heights_(&memory.resource) {
        const std::size_t count = core.normals.size();
        heights_.resize(std::max(count, core.faces.padded_size()));
        if (core.faces.empty()) {
            for (std::size_t f = 0; f < count; ++f) heights_[f] = dot(core.normals[f], point);
        } else {
            core.faces.products(point, heights_.data());
        }
        for (std::size_t f = 0; f < count; ++f) heights_[f] -= core.offsets[f];
    }

    double operator[](std::size_t face) const { return heights_[face]; }
    /// The first faces over which the point is higher than `least`, of `count`; as many as are returned.
    /// Nothing branches, as nobody could tell which way.
    std::size_t list_above(double least, std::size_t count, std::uint32_t* faces) const {
        std::size_t listed = 0;
        for (std::size_t f = 0; f < count; ++f) {
            faces[listed] = static_cast<std::uint32_t>(f);
            listed += heights_[f] > least;
        }
        return listed;
    }
    /// Is the point below both faces of the edge by more than −`gap`?
    bool hides(const Polyhedron::Edge& edge, double gap) const {
        return std::max(heights_[edge.left], heights_[edge.right]) < gap;
    }

  private:
    std::pmr::vector<double> heights_;
};

}  // namespace carom::detail
