#pragma once

#include <array>
#include <cstdint>

#include "math/dim.hpp"
#include "solver/lane_shapes.hpp"

/// How two outlines in the plane lie to each other, several pairs side by side: the same choices as
/// collision/manifold/outline_2.cpp makes for one pair, with every corner and edge tried and what is best
/// selected, so that nothing branches on a value.
namespace carom::detail {

/// Outlines, one a lane, in the frame of a's centre of mass. After the last corner it is repeated, with its
/// normal, as often as some lane has more: what is best is found at the first of those that are alike,
/// however many follow.
template <class F>
struct LaneOutline {
    static constexpr int most = LaneShapes<2>::most_corners;
    std::array<Vec<2, F>, most> corners, normals;
    F count{}, radius{}, body_radius{};
    F kind{};      ///< `ShapeKind`
    int n = most;  ///< how many corners are looked at in all lanes

    /// The corner after i, the end of its edge.
    CAROM_INLINE Vec<2, F> next(int i) const {
        if (i + 1 == n) return corners[0];
        const auto goes_on = count > F(static_cast<float>(i + 1));
        return {select(goes_on, corners[i + 1].x, corners[0].x),
                select(goes_on, corners[i + 1].y, corners[0].y)};
    }
    CAROM_INLINE F next_name(int i) const {
        const F name(static_cast<float>(i + 1));
        return select(count > name, name, F(0));
    }
};

template <class F>
CAROM_INLINE void gather_outline(const float* shapes, const std::uint32_t* index, LaneOutline<F>& o) {
    constexpr std::size_t stride = LaneShapes<2>::stride;
    gather_record(shapes, index, stride, o.count, o.radius, o.body_radius, o.kind);
    o.n = 2;
    while (o.n < o.most && any(o.count > F(static_cast<float>(o.n)))) ++o.n;
    for (int i = 0; i < o.n; ++i)
        gather_record(shapes + 4 * (i + 1), index, stride, o.corners[i].x, o.corners[i].y, o.normals[i].x,
                      o.normals[i].y);
}

template <class Mask, class F>
CAROM_INLINE Vec<2, F> selected(Mask mask, const Vec<2, F>& yes, const Vec<2, F>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y)};
}

/// An edge: the names of its ends are the numbers of their corners.
template <class F>
struct LaneEdge {
    Vec<2, F> from{}, to{}, normal{};
    F name{}, to_name{};
};

template <class Mask, class F>
CAROM_INLINE LaneEdge<F> selected(Mask mask, const LaneEdge<F>& yes, const LaneEdge<F>& no) {
    return {selected(mask, yes.from, no.from), selected(mask, yes.to, no.to),
            selected(mask, yes.normal, no.normal), select(mask, yes.name, no.name),
            select(mask, yes.to_name, no.to_name)};
}

template <class F>
CAROM_INLINE LaneEdge<F> edge_of(const LaneOutline<F>& outline, int i) {
    return {outline.corners[i], outline.next(i), outline.normals[i], F(static_cast<float>(i)),
            outline.next_name(i)};
}

/// The edge of `a` that b is furthest in front of, and the corner of b that is furthest behind it.
template <class F>
struct LaneFacing {
    LaneEdge<F> edge{};
    Vec<2, F> corner{};
    F separation{};
    F corner_name{};
};

constexpr float far_behind = -1e30f;  // m

template <class F>
CAROM_INLINE LaneFacing<F> best_facing(const LaneOutline<F>& a, const LaneOutline<F>& b) {
    LaneFacing<F> best;
    best.separation = F(far_behind);
    for (int i = 0; i < a.n; ++i) {
        const Vec<2, F>& normal = a.normals[i];
        F lowest = dot(normal, b.corners[0]), name = F(0);
        Vec<2, F> corner = b.corners[0];
        for (int j = 1; j < b.n; ++j) {
            const F height = dot(normal, b.corners[j]);
            const auto lower = lowest > height;
            lowest = select(lower, height, lowest);
            name = select(lower, F(static_cast<float>(j)), name);
            corner = selected(lower, b.corners[j], corner);
        }
        const F separation = lowest - dot(normal, a.corners[i]);
        const auto better = separation > best.separation;
        best.edge = selected(better, edge_of(a, i), best.edge);
        best.corner = selected(better, corner, best.corner);
        best.separation = select(better, separation, best.separation);
        best.corner_name = select(better, name, best.corner_name);
    }
    best.separation = select(a.count > F(1), best.separation, F(far_behind));
    return best;
}

/// The edge that runs most against the direction.
template <class F>
CAROM_INLINE LaneEdge<F> edge_against(const LaneOutline<F>& outline, const Vec<2, F>& normal) {
    LaneEdge<F> best = edge_of(outline, 0);
    F least = dot(outline.normals[0], normal);
    for (int i = 1; i < outline.n; ++i) {
        const F d = dot(outline.normals[i], normal);
        const auto better = least > d;
        least = select(better, d, least);
        best = selected(better, edge_of(outline, i), best);
    }
    return best;
}

/// Two points of the cores that show how far these are apart, or how deep one is in the other.
template <class F>
struct LaneProximity {
    Vec<2, F> axis{};  ///< from a to b
    Vec<2, F> on_a{}, on_b{};
    F distance{};
    F corner_a{}, corner_b{};
    F between_corners{};     ///< 1: the cores are apart and two corners are closest; else 0
    F is_of_a{}, is_of_b{};  ///< 1 where the axis is the normal of an edge of this one; else 0
};

/// Tries the points of the edges of `outline` that are nearest to corners of the other, which lie on a if
/// `flip`.
template <class F>
CAROM_INLINE void try_edges(const LaneOutline<F>& outline, const LaneOutline<F>& other, bool flip,
                            LaneProximity<F>& best, F& square, Vec<2, F>& normal) {
    for (int i = 0; i < outline.n; ++i) {
        const Vec<2, F> from = outline.corners[i], to = outline.next(i), along = to - from;
        const F whole = dot(along, along), inverse_whole = F(1) / maximum(whole, F(1e-30f));
        const F name(static_cast<float>(i)), to_name = outline.next_name(i);
        for (int j = 0; j < other.n; ++j) {
            const Vec<2, F> corner = other.corners[j];
            const F share = dot(corner - from, along);
            const auto beyond_start = share > F(0), within = both(beyond_start, whole > share);
            const Vec<2, F> end = selected(beyond_start, to, from);
            const Vec<2, F> foot = selected(within, from + (share * inverse_whole) * along, end);
            const Vec<2, F> across = corner - foot;
            const F candidate = dot(across, across);
            const auto better = square > candidate;
            square = select(better, candidate, square);
            const F near_name = select(whole > F(2) * share, name, to_name);
            const F far_name(static_cast<float>(j));
            best.on_a = selected(better, flip ? corner : foot, best.on_a);
            best.on_b = selected(better, flip ? foot : corner, best.on_b);
            best.corner_a = select(better, flip ? far_name : near_name, best.corner_a);
            best.corner_b = select(better, flip ? near_name : far_name, best.corner_b);
            const F inside = select(within, F(1), F(0));
            best.between_corners = select(better, F(1) - inside, best.between_corners);
            best.is_of_a = select(better, flip ? F(0) : inside, best.is_of_a);
            best.is_of_b = select(better, flip ? inside : F(0), best.is_of_b);
            normal = selected(better, outline.normals[i], normal);
        }
    }
}

/// What two cores have that are apart. Closest points that show no more of a gap than the facing edge does,
/// but for rounding, may have no direction between them; then its normal is the axis.
template <class F>
CAROM_INLINE LaneProximity<F> closest(const LaneOutline<F>& a, const LaneOutline<F>& b,
                                      const LaneProximity<F>& facing, F separation, F& square) {
    LaneProximity<F> best;
    Vec<2, F> edge_normal{};
    square = F(1e30f);
    try_edges(a, b, false, best, square, edge_normal);
    try_edges(b, a, true, best, square, edge_normal);
    const Vec<2, F> across = best.on_b - best.on_a;
    const F distance = square_root(square);
    constexpr float float_rounding = 4e-7f;
    const F rounding = F(float_rounding) * (fabs(best.on_a.x) + fabs(best.on_a.y) + fabs(best.on_b.x) +
                                            fabs(best.on_b.y) + a.body_radius);
    const auto inside = F(0.5f) > best.between_corners;
    // Along the normal of an edge; only a segment has two sides.
    const Vec<2, F> normal = selected(best.is_of_b > F(0.5f), -edge_normal, edge_normal);
    const F along_normal = dot(normal, across);
    const auto behind = F(0) > along_normal;
    const Vec<2, F> outwards = selected(behind, -normal, normal);
    const Vec<2, F> between = across * (F(1) / maximum(distance, F(1e-30f)));
    best.axis = selected(inside, outwards, between);
    best.distance = select(inside, F(fabs(along_normal)), distance);
    // Where rounding hides the direction. Two balls in one place part along y.
    const auto no_edges = F(0.5f * far_behind) > separation;
    const auto hidden = either(!(distance > rounding), !(fabs(distance - separation) > rounding));
    const Vec<2, F> fallback = selected(no_edges, Vec<2, F>{F(0), F(1)}, facing.axis);
    best.axis = selected(hidden, fallback, best.axis);
    best.distance = select(hidden, select(separation > F(0), separation, distance), best.distance);
    best.is_of_a = select(hidden, facing.is_of_a, best.is_of_a);
    best.is_of_b = select(hidden, facing.is_of_b, best.is_of_b);
    return best;
}

/// What two cores have that overlap. The deepest point is the facing corner, except where parallel edges
/// leave the choice: then it is the point nearest to that.
template <class F>
CAROM_INLINE LaneProximity<F> overlapping(const LaneOutline<F>& a, const LaneOutline<F>& b,
                                          const LaneFacing<F>& of_a, const LaneFacing<F>& of_b) {
    const auto front_is_a = !(of_b.separation > of_a.separation);
    const LaneEdge<F> front = selected(front_is_a, of_a.edge, of_b.edge);
    const LaneEdge<F> other =
        selected(front_is_a, edge_against(b, front.normal), edge_against(a, front.normal));
    const Vec<2, F> corner = selected(front_is_a, of_a.corner, of_b.corner);
    const F corner_name = select(front_is_a, of_a.corner_name, of_b.corner_name);
    const F separation = select(front_is_a, of_a.separation, of_b.separation);

    const auto begins_there = !(fabs(corner_name - other.name) > F(0));
    const Vec<2, F> second = selected(begins_there, other.to, other.from);
    const F second_name = select(begins_there, other.to_name, other.name);
    const Vec<2, F> along = front.to - front.from, aside = second - corner;
    const F whole = dot(along, along), place = dot(corner - front.from, along);
    const F shift = minimum(maximum(place, F(0)), whole) - place, room = dot(aside, along);
    const auto has_room = shift * room > F(0);
    const F share = select(has_room, minimum(shift / select(has_room, room, F(1)), F(1)), F(0));
    const Vec<2, F> deepest = corner + share * aside;
    const Vec<2, F> surface = deepest - separation * front.normal;
    const F end = select(whole > F(2) * (place + shift), front.name, front.to_name);
    const F other_end = select(F(1) > F(2) * share, corner_name, second_name);

    LaneProximity<F> result;
    result.axis = selected(front_is_a, front.normal, -front.normal);
    result.distance = separation;
    result.on_a = selected(front_is_a, surface, deepest);
    result.on_b = selected(front_is_a, deepest, surface);
    result.corner_a = select(front_is_a, end, other_end);
    result.corner_b = select(front_is_a, other_end, end);
    result.is_of_a = select(front_is_a, F(1), F(0));
    result.is_of_b = select(front_is_a, F(0), F(1));
    return result;
}

template <class Mask, class F>
CAROM_INLINE LaneProximity<F> selected(Mask mask, const LaneProximity<F>& yes, const LaneProximity<F>& no) {
    return {selected(mask, yes.axis, no.axis),
            selected(mask, yes.on_a, no.on_a),
            selected(mask, yes.on_b, no.on_b),
            select(mask, yes.distance, no.distance),
            select(mask, yes.corner_a, no.corner_a),
            select(mask, yes.corner_b, no.corner_b),
            select(mask, yes.between_corners, no.between_corners),
            select(mask, yes.is_of_a, no.is_of_a),
            select(mask, yes.is_of_b, no.is_of_b)};
}

template <class F>
CAROM_INLINE LaneProximity<F> proximity(const LaneOutline<F>& a, const LaneOutline<F>& b,
                                        const LaneFacing<F>& of_a, const LaneFacing<F>& of_b) {
    const LaneProximity<F> deep = overlapping(a, b, of_a, of_b);
    const F separation = maximum(of_a.separation, of_b.separation);
    const auto apart = separation > F(0);
    // Two segments in one line have no normal along the line that would show the gap between them. Where they
    // cross, the closest corner is as far away as they are deep.
    const auto only_segments = both(F(2.5f) > a.count, F(2.5f) > b.count);
    if (!any(either(apart, only_segments))) return deep;
    F square;
    const LaneProximity<F> near = closest(a, b, deep, separation, square);
    const auto seen = both(only_segments, square > F(4) * separation * separation);
    const auto balls = both(F(1.5f) > a.count, F(1.5f) > b.count);
    return selected(either(apart, either(seen, balls)), near, deep);
}

/// How far the cores are apart, or deep in each other, and along which axis.
template <class F>
CAROM_INLINE LaneProximity<F> proximity(const LaneOutline<F>& a, const LaneOutline<F>& b) {
    return proximity(a, b, best_facing(a, b), best_facing(b, a));
}

}  // namespace carom::detail
