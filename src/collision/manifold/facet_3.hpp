#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "geometry/shape.hpp"

namespace carom::detail {

/// One corner of a facet. `side` names the side that leads to the next corner.
struct FacetCorner {
    Vec3 position;
    std::uint32_t side;
};

/// What a core offers to rest on in some direction: a face (corners counter-clockwise seen from outside) or
/// an edge (two corners). The face of a plane has no corners; a disk is given by a polygon inscribed in it.
struct Facet3 {
    enum class Form : std::uint8_t { edge, face, disk, plane };
    explicit Facet3(std::pmr::memory_resource& memory) : corners(&memory) {}

    std::pmr::vector<FacetCorner> corners;
    Vec3 normal{};      ///< unit vector out of the face; zero for an edge
    double offset = 0;  ///< the face lies in the plane normal · x = offset
    double extent = 0;  ///< a length of the order of the facet's size
    std::uint32_t id = 0;
    Form form = Form::edge;
};

/// Corners of the polygon that stands for a disk, which it fits within half a percent of the radius. Every
/// eighth is one of the four that support a disk which rests entirely on a face.
constexpr int disk_corners = 32;

/// Sets `facet` to the face or edge of the shape's core that looks most along the unit vector `direction`,
/// among those that reach furthest along it. Not for balls.
void find_facet(const Shape<3>& shape, const Vec3& direction, Facet3& facet);

/// Carries the facet to the frame that `t` is placed in.
void move_facet(Facet3& facet, const Transform<3>& t);

}  // namespace carom::detail
