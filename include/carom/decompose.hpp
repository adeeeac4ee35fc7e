#pragma once

#include <vector>

#include "carom/shapes.hpp"

namespace carom {

/// Convex pieces that together are the simple polygon `outline` (corners in either sense of rotation): the
/// polygon is cut into triangles by clipping the best formed ears (Meisters 1975), which are then joined
/// again as long as they stay convex (Hertel and Mehlhorn 1983); no more than four times as many as are
/// needed. They do not overlap and leave no gap, but for slivers too thin to be a hull. Throws `Error` for
/// fewer than 3 or more than 4096 corners, coordinates out of range, an outline without area, or one that
/// crosses itself.
std::vector<Hull2> convex_pieces(const std::vector<Vec2>& outline);

/// How finely a solid is cut into convex pieces.
struct Decomposition {
    /// Share of the volume of the whole solid's convex hull by which a piece's hull may be larger than the
    /// piece, 0 … 1.
    double concavity = 0.01;
    int most_pieces = 32;  ///< 1 … 1024
    int planes = 12;       ///< cuts tried along each axis for each piece, 1 … 256
};

/// Convex pieces that together are about the solid within a closed surface of triangles. The piece with the
/// most empty room in its hull is cut in two by the plane, across one of the axes, that leaves the least of
/// it, until all is well or there are enough pieces (in the spirit of V-HACD, Mamou and Ghorbel 2009, and
/// CoACD, Wei et al. 2022, with exact volumes in place of voxels and samples). Every piece holds its part of
/// the solid, but for slivers too thin to be a hull. Throws `Error` for a mesh that cannot be, or whose
/// surface is not closed or holds no volume, and for settings out of range.
std::vector<Hull3> convex_pieces(const Mesh& mesh, const Decomposition& settings = {});

}  // namespace carom
