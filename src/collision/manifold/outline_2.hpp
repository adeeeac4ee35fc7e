#pragma once

#include <array>
#include <span>

#include "collision/manifold.hpp"

namespace carom::detail {

/// The core of a 2D shape as a closed chain of corners, counter-clockwise, in the frame in which it is
/// placed: one corner for a ball; two, with an edge there and an edge back, for a capsule or a facet, whose
/// front is edge 0; a polygon for a box or hull.
class Outline {
  public:
    Outline(const Shape<2>& shape, const Transform<2>& placed);
    Outline(const Outline&) = delete;
    Outline& operator=(const Outline&) = delete;

    int count() const { return int(corners_.size()); }
    /// There are as many edges as corners, but none where there is one corner only.
    bool has_edges() const { return corners_.size() > 1; }
    int next(int i) const { return i + 1 < count() ? i + 1 : 0; }
    int previous(int i) const { return i > 0 ? i - 1 : count() - 1; }

    Vec2 corner(int i) const { return apply(placed_, corners_[i]); }
    /// The size of the numbers that the place of a corner comes from.
    double magnitude(int i) const { return length(corners_[i]) + length(placed_.position); }
    /// Out of the edge from corner i to the next.
    Vec2 normal(int i) const { return rotate(placed_.rotation, normals_[i]); }
    /// By how much the shape is larger than its core.
    double radius() const { return radius_; }

    /// The corner furthest along the direction. It climbs from `start`, which gets there if the direction
    /// lies less than half a turn counter-clockwise from one along which `start` was furthest.
    int climb(const Vec2& direction, int start) const;
    /// The corner furthest along the direction.
    int furthest(const Vec2& direction) const;

  private:
    std::span<const Vec2> corners_, normals_;
    std::array<Vec2, 2> few_corners_, few_normals_;
    Transform<2> placed_;
    double radius_;
};

/// An edge of one outline, the corner of the other that is furthest behind it, and how far that is in front
/// of it (negative: behind).
struct Facing {
    double separation;
    int edge, corner;
};

/// How two outlines lie to each other.
struct Proximity {
    double distance = 0;  ///< between the cores; negative: depth
    Vec2 axis{};          ///< unit vector from a to b
    Vec2 on_a{}, on_b{};  ///< the two points of the cores that are `distance` apart along `axis`
    int corner_a = 0,
        corner_b = 0;           ///< those points themselves, or the near end of the edge that they are on
    bool corners = false;       ///< the cores are apart and two corners are closest
    Facing face_a{}, face_b{};  ///< the edge of a, of b that the other is furthest in front of
};

/// Exact distance or depth of two cores. Rounding by their radii adds to it and leaves the axis as it is.
Proximity proximity(const Outline& a, const Outline& b);

/// The depth of two cores that overlap if the outline `a`, a segment, can be left only on the side of the
/// normal of its edge 0. Directions up to `slack` behind that count as well.
Proximity front_depth(const Outline& a, const Outline& b, double slack);

/// The manifold of two outlines: one point or two.
Manifold<2> touching(const Outline& a, const Outline& b, const Proximity& near, double reach);

/// The edge that runs most against the direction of `normal`, of the two that meet at the corner.
int facing_edge(const Outline& outline, int corner, const Vec2& normal);

}  // namespace carom::detail
