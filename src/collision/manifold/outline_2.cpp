#include "collision/manifold/outline_2.hpp"

#include <algorithm>
#include <limits>

namespace carom::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The edge of `a` that `b` is furthest in front of (all of b counts). One round over both outlines: as the
/// edge's normal turns counter-clockwise, so moves the corner of b that is furthest against it. The two
/// normals of a segment are half a turn apart, too far to climb from one to the other.
Facing best_facing(const Outline& a, const Outline& b) {
    Facing best{-infinity, 0, 0};
    if (!a.has_edges()) return best;
    int corner = b.furthest(-a.normal(0));
    for (int edge = 0; edge < a.count(); ++edge) {
        const Vec2 normal = a.normal(edge);
        corner = a.count() > 2 ? b.climb(-normal, corner) : b.furthest(-normal);
        const double separation = dot(normal, b.corner(corner) - a.corner(edge));
        if (separation > best.separation) best = {separation, edge, corner};
    }
    return best;
}

/// The closest pair of a corner and a point of an edge (or a corner) that was tried so far.
struct Closest {
    double square = infinity;
    Vec2 on_edge{}, at_corner{};
    int edge = 0, end = 0, corner = 0;
    bool inside = false;  ///< the point of the edge is none of its ends
    bool edge_of_a = true;

    void try_pair(const Outline& outline, int its_edge, const Outline& other, int its_corner,
                  bool outline_is_a) {
        const int next = outline.next(its_edge);
        const Vec2 from = outline.corner(its_edge), to = outline.corner(next);
        const Vec2 point = other.corner(its_corner), along = to - from;
        const double share = dot(point - from, along), whole = length_squared(along);
        const bool within = share > 0 && share < whole;
        const Vec2 foot = within ? from + (share / whole) * along : share > 0 ? to : from;
        const double candidate = length_squared(point - foot);
        if (!(candidate < square)) return;
        square = candidate;
        on_edge = foot;
        at_corner = point;
        edge = its_edge;
        end = 2 * share < whole ? its_edge : next;
        corner = its_corner;
        inside = within;
        edge_of_a = outline_is_a;
    }
};

/// The closest points of the facing edge and the edges at the corner that it faces. In the difference of the
/// two outlines, itself a convex polygon with the normals of both, the origin is furthest in front of the
/// edge that holds the closest point, or of one that ends in it. An edge of the other outline that is all but
/// parallel prolongs that edge, hence the search beyond the facing corner.
Closest closest_points(const Outline& front, const Facing& facing, const Outline& other, bool front_is_a) {
    Closest closest;
    closest.try_pair(front, facing.edge, other, facing.corner, front_is_a);
    if (!other.has_edges()) return closest;
    for (const int corner : {other.previous(facing.corner), other.next(facing.corner)})
        closest.try_pair(front, facing.edge, other, corner, front_is_a);
    for (const int edge : {other.previous(facing.corner), facing.corner})
        for (const int corner : {facing.edge, front.next(facing.edge)})
            closest.try_pair(other, edge, front, corner, !front_is_a);
    return closest;
}

/// Fills in what two cores have that are apart. `separation` is the gap along `facing_axis`, the normal of
/// the edge that faces the other outline, and `magnitude` the size of the numbers that they come from.
/// Closest points that show no more of a gap than that edge does, but for rounding, may have no direction
/// between them, or lie on an edge beside it; then its normal is the axis.
void set_apart(Proximity& result, const Closest& closest, const Outline& a, const Outline& b,
               const Vec2& facing_axis, double separation, double magnitude) {
    result.on_a = closest.edge_of_a ? closest.on_edge : closest.at_corner;
    result.on_b = closest.edge_of_a ? closest.at_corner : closest.on_edge;
    result.corner_a = closest.edge_of_a ? closest.end : closest.corner;
    result.corner_b = closest.edge_of_a ? closest.corner : closest.end;
    result.corners = !closest.inside;
    const Vec2 across = result.on_b - result.on_a;
    const double distance = length(across), rounding = 1e-12 * magnitude;
    if (distance <= rounding || std::fabs(distance - separation) <= rounding) {
        result.axis = facing_axis;
        result.distance = separation > 0 ? separation : distance;
    } else if (closest.inside) {
        // The normal is known better than the difference of two close points. Only a segment has two sides.
        const Outline& outline = closest.edge_of_a ? a : b;
        const Vec2 normal = outline.normal(closest.edge);
        result.axis = closest.edge_of_a ? normal : -normal;
        if (outline.count() == 2 && dot(result.axis, across) < 0) result.axis = -result.axis;
        result.distance = dot(result.axis, across);
    } else {
        result.axis = across / distance;
        result.distance = distance;
    }
}

/// Fills in what two cores have that overlap. The deepest point is the facing corner, which lies behind the
/// facing edge, except where parallel edges leave the choice: then it is the point nearest to that.
void set_overlapping(Proximity& result, const Outline& front, const Facing& facing, const Outline& other,
                     bool front_is_a) {
    const Vec2 normal = front.normal(facing.edge);
    const int next = front.next(facing.edge), edge = facing_edge(other, facing.corner, normal);
    const int second = edge == facing.corner ? other.next(edge) : edge;
    const Vec2 from = front.corner(facing.edge), along = front.corner(next) - from;
    const Vec2 corner = other.corner(facing.corner), aside = other.corner(second) - corner;
    const double whole = length_squared(along), place = dot(corner - from, along);
    const double shift = std::clamp(place, 0.0, whole) - place, room = dot(aside, along);
    const double share = shift * room > 0 ? std::min(shift / room, 1.0) : 0.0;
    const Vec2 deepest = corner + share * aside;
    const Vec2 surface = deepest - facing.separation * normal;
    const int end = 2 * (place + shift) < whole ? facing.edge : next;
    const int other_end = 2 * share < 1 ? facing.corner : second;
    result.distance = facing.separation;
    result.on_a = front_is_a ? surface : deepest;
    result.on_b = front_is_a ? deepest : surface;
    result.corner_a = front_is_a ? end : other_end;
    result.corner_b = front_is_a ? other_end : end;
}

}  // namespace

Outline::Outline(const Shape<2>& shape, const Transform<2>& placed) : placed_(placed), radius_(shape.radius) {
    if (shape.core) {
        corners_ = shape.core->vertices;
        normals_ = shape.core->normals;
        return;
    }
    few_corners_ = {shape.a, shape.b};
    const Vec2 along = normalized(shape.b - shape.a);
    few_normals_ = {Vec2{along.y, -along.x}, Vec2{-along.y, along.x}};
    const bool point = shape.kind == ShapeKind::ball || length_squared(along) == 0;
    corners_ = std::span(few_corners_).first(point ? 1 : 2);
    normals_ = few_normals_;
}

int Outline::climb(const Vec2& direction, int start) const {
    const Vec2 local = unrotate(placed_.rotation, direction);
    int best = start;
    for (int i = next(start); i != start && dot(local, corners_[i] - corners_[best]) > 0; i = next(i))
        best = i;
    return best;
}

int Outline::furthest(const Vec2& direction) const {
    const Vec2 local = unrotate(placed_.rotation, direction);
    int best = 0;
    for (int i = 1; i < count(); ++i)
        if (dot(local, corners_[i] - corners_[best]) > 0) best = i;
    return best;
}

int facing_edge(const Outline& outline, int corner, const Vec2& normal) {
    const int before = outline.previous(corner);
    return dot(outline.normal(before), normal) < dot(outline.normal(corner), normal) ? before : corner;
}

Proximity proximity(const Outline& a, const Outline& b) {
    Proximity result;
    if (!a.has_edges() && !b.has_edges()) {
        result.on_a = a.corner(0);
        result.on_b = b.corner(0);
        result.distance = length(result.on_b - result.on_a);
        result.axis = result.distance > 0 ? (result.on_b - result.on_a) / result.distance : Vec2{0, 1};
        result.corners = true;
        return result;
    }
    result.face_a = best_facing(a, b);
    result.face_b = best_facing(b, a);
    const bool front_is_a = result.face_a.separation >= result.face_b.separation;
    const Outline& front = front_is_a ? a : b;
    const Outline& other = front_is_a ? b : a;
    const Facing& facing = front_is_a ? result.face_a : result.face_b;
    const Vec2 normal = front.normal(facing.edge);
    const Vec2 axis = front_is_a ? normal : -normal;

    // Two segments in one line have no normal along the line that would show the gap between them. Where they
    // cross, the closest corner is as far away as they are deep.
    const bool only_segments = a.count() <= 2 && b.count() <= 2;
    if (facing.separation > 0 || only_segments) {
        const Closest closest = closest_points(front, facing, other, front_is_a);
        if (facing.separation > 0 || closest.square > 4 * facing.separation * facing.separation) {
            const double magnitude = front.magnitude(facing.edge) + front.magnitude(front.next(facing.edge)) +
                                     other.magnitude(facing.corner);
            set_apart(result, closest, a, b, axis, facing.separation, magnitude);
            return result;
        }
    }
    result.axis = axis;
    set_overlapping(result, front, facing, other, front_is_a);
    return result;
}

Proximity front_depth(const Outline& a, const Outline& b, double slack) {
    Proximity result;
    const Vec2 front = a.normal(0);
    const int lowest = b.furthest(-front);
    result.face_a = {dot(front, b.corner(lowest) - a.corner(0)), 0, lowest};
    result.face_b = {-infinity, 0, 0};
    for (int edge = 0; b.has_edges() && edge < b.count(); ++edge) {
        const Vec2 normal = b.normal(edge);
        if (dot(normal, front) > slack) continue;
        const int corner = a.furthest(-normal);
        const double separation = dot(normal, a.corner(corner) - b.corner(edge));
        if (separation > result.face_b.separation) result.face_b = {separation, edge, corner};
    }
    const bool front_is_a = result.face_a.separation >= result.face_b.separation;
    result.axis = front_is_a ? front : -b.normal(result.face_b.edge);
    if (front_is_a)
        set_overlapping(result, a, result.face_a, b, true);
    else
        set_overlapping(result, b, result.face_b, a, false);
    return result;
}

}  // namespace carom::detail
