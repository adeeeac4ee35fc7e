#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/shape.hpp"
#include "math/check.hpp"

/// What the hulls of both dimensions and their steps share.
namespace carom::detail {

/// Corners, edges and faces that stand out by less than this share of the hull's extent are left out.
constexpr double hull_tolerance = 1e-5;
/// A hull must be at least this share of its extent thick.
constexpr double thinnest_hull = 1e-4;
constexpr std::size_t most_hull_points = 4096;

/// The longest side of the axis-aligned box around the points.
template <int D>
double extent_of(const std::vector<Vec<D>>& points) {
    double extent = 0;
    for (int i = 0; i < D; ++i) {
        const auto [lowest, highest] = std::minmax_element(
            points.begin(), points.end(), [i](const auto& a, const auto& b) { return a[i] < b[i]; });
        extent = std::max(extent, (*highest)[i] - (*lowest)[i]);
    }
    return extent;
}

/// Refuses too few and too many points and coordinates that are not finite or too large.
template <int D>
void check_points(const std::vector<Vec<D>>& points) {
    if (points.size() < D + 1) {
        throw Error("points: " + std::to_string(points.size()) + " are fewer than " + std::to_string(D + 1));
    }
    if (points.size() > most_hull_points) {
        throw Error("points: " + std::to_string(points.size()) + " are more than " +
                    std::to_string(most_hull_points));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        require_in(points[i], -longest_length, longest_length, component("points", static_cast<int>(i)));
    }
}

/// A point of a cubic lattice, coordinates from 0 to `lattice_size`: with so few bits a determinant of
/// differences fits into 64 bits, so that it is known exactly on which side of a triangle a point lies.
using LatticePoint = std::array<std::int64_t, 3>;
constexpr std::int64_t lattice_size = 1 << 20;

/// A triangle of a closed surface; corners counter-clockwise seen from outside.
struct HullTriangle {
    std::array<std::uint32_t, 3> corners;
    std::array<std::uint32_t, 3> neighbours;  ///< across the edge from corner i to i + 1
};

/// Convex hull of lattice points (Barber, Dobkin, Huhdanpaa 1996, The quickhull algorithm for convex hulls).
/// Points that stand out by less than `tolerance` lattice steps may stay outside. The surface is exactly
/// convex, coplanar triangles included. Empty when the points lie in a plane, within the tolerance.
std::vector<HullTriangle> quickhull(const std::vector<LatticePoint>& points, double tolerance);

/// Measures a polyhedron that has its corners and faces: middle, extent and unevenness.
void measure(Polyhedron& polyhedron);

/// Finds the edges of a polyhedron that has its corners and faces. False when the faces do not close a
/// surface.
bool connect(Polyhedron& polyhedron);

}  // namespace carom::detail
