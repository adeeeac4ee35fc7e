#pragma once

#include <array>
#include <cstdint>

#include "carom/collide.hpp"
#include "math/dim.hpp"
#include "solver/lane_shapes.hpp"

/// The manifold of two outlines in the plane, several pairs side by side: the same choices as
/// collision/manifold/polygons_2.cpp makes for one pair, with every corner and edge tried and what is best
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
    gather_quads(shapes, index, stride, o.count, o.radius, o.body_radius, o.kind);
    o.n = 2;
    while (o.n < o.most && any(o.count > F(static_cast<float>(o.n)))) ++o.n;
    for (int i = 0; i < o.n; ++i)
        gather_quads(shapes + 4 * (i + 1), index, stride, o.corners[i].x, o.corners[i].y, o.normals[i].x,
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
                            LaneProximity<F>& best, F& square, LaneEdge<F>& edge) {
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
            edge.normal = selected(better, outline.normals[i], edge.normal);
        }
    }
}

/// What two cores have that are apart. Closest points that show no more of a gap than the facing edge does,
/// but for rounding, may have no direction between them; then its normal is the axis.
template <class F>
CAROM_INLINE LaneProximity<F> closest(const LaneOutline<F>& a, const LaneOutline<F>& b,
                                      const LaneProximity<F>& facing, F separation, F& square) {
    LaneProximity<F> best;
    LaneEdge<F> edge;
    square = F(1e30f);
    try_edges(a, b, false, best, square, edge);
    try_edges(b, a, true, best, square, edge);
    const Vec<2, F> across = best.on_b - best.on_a;
    const F distance = square_root(square);
    constexpr float float_rounding = 4e-7f;
    const F rounding = F(float_rounding) * (fabs(best.on_a.x) + fabs(best.on_a.y) + fabs(best.on_b.x) +
                                            fabs(best.on_b.y) + a.body_radius);
    const auto inside = F(0.5f) > best.between_corners;
    // Along the normal of an edge; only a segment has two sides.
    const Vec<2, F> normal = selected(best.is_of_b > F(0.5f), -edge.normal, edge.normal);
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

/// A manifold a lane, in the frame of a's centre of mass.
template <class F>
struct LaneManifold {
    struct Point {
        Vec<2, F> position{};
        F separation{};
        F feature{};
        F used{};  ///< 1, or 0 for a point that is not there
    };
    Vec<2, F> normal{};
    F is_of_a{}, is_of_b{};  ///< 1 if the normal turns with this one
    std::array<Point, 2> points{};
};

/// Names of features are the same in either order of the shapes: see `feature_id` and `collide_shapes`.
template <class Mask, class F>
CAROM_INLINE F feature_of(Mask in_order, F corner_a, F corner_b) {
    return F(65536.0f) * select(in_order, corner_a, corner_b) + select(in_order, corner_b, corner_a);
}

/// The part of the facing edge of the other outline that lies in front of the leading edge, by its two ends,
/// which come in the same order whoever leads.
template <class Mask, class F>
CAROM_INLINE void clip(Mask a_leads, Mask in_order, const LaneEdge<F>& lead, const LaneEdge<F>& other,
                       F lead_radius, F other_radius, F reach, LaneManifold<F>& result, F& shorter) {
    const Vec<2, F> way = lead.to - lead.from, other_way = other.to - other.from;
    const F whole = square_root(dot(way, way));
    const Vec<2, F> along = way * (F(1) / maximum(whole, F(1e-30f)));
    shorter = minimum(whole, square_root(dot(other_way, other_way)));
    // Outlines run counter-clockwise, so the other's edge ends where ours begins.
    const F begin = dot(other.to - lead.from, along), end = dot(other.from - lead.from, along);
    const F low = maximum(begin, F(0)), high = minimum(end, whole);
    const auto exists = high > low;
    const F stretch = select(end > begin, end - begin, F(1));
    const Vec<2, F> left =
        selected(low > begin, other.to + ((low - begin) / stretch) * (other.from - other.to), other.to);
    const Vec<2, F> right =
        selected(end > high, other.to + ((high - begin) / stretch) * (other.from - other.to), other.from);
    const auto set = [&](const Vec<2, F>& on_other, F lead_name, F other_name) {
        typename LaneManifold<F>::Point p;
        const F height = dot(on_other - lead.from, lead.normal);
        p.position = on_other - (F(0.5f) * (height - lead_radius + other_radius)) * lead.normal;
        p.separation = height - lead_radius - other_radius;
        p.feature = feature_of(in_order, select(a_leads, lead_name, other_name),
                               select(a_leads, other_name, lead_name));
        p.used = select(both(exists, !(p.separation > reach)), F(1), F(0));
        return p;
    };
    const auto at_left = set(left, lead.name, other.to_name), at_right = set(right, lead.to_name, other.name);
    const auto chosen = [&](const auto& yes, const auto& no) {
        return typename LaneManifold<F>::Point{
            selected(a_leads, yes.position, no.position), select(a_leads, yes.separation, no.separation),
            select(a_leads, yes.feature, no.feature), select(a_leads, yes.used, no.used)};
    };
    result.points = {chosen(at_left, at_right), chosen(at_right, at_left)};
}

/// Points further apart than `reach` are left out.
template <class F>
CAROM_INLINE LaneManifold<F> collide(const LaneOutline<F>& a, const LaneOutline<F>& b, F reach) {
    constexpr float parallel = 0.98f, steady = 1e-4f;
    const LaneFacing<F> of_a = best_facing(a, b), of_b = best_facing(b, a);
    const LaneProximity<F> near = proximity(a, b, of_a, of_b);
    const F gap = near.distance - a.radius - b.radius;

    // Whose edge gives the normal: see `edge_of_a_leads`.
    const auto edge_length = [](const LaneEdge<F>& e) {
        const Vec<2, F> along = e.to - e.from;
        return square_root(dot(along, along));
    };
    const F along_a = edge_length(of_a.edge), along_b = edge_length(of_b.edge);
    const F difference = of_a.separation - of_b.separation;
    const auto as_good = both(F(-parallel) > dot(of_a.edge.normal, of_b.edge.normal),
                              !(fabs(difference) > F(steady) * minimum(along_a, along_b)));
    const auto a_leads = either(both(as_good, !(along_b > along_a)), both(!as_good, !(F(0) > difference)));
    const LaneEdge<F> lead = selected(a_leads, of_a.edge, of_b.edge);
    const LaneEdge<F> other = selected(a_leads, edge_against(b, lead.normal), edge_against(a, lead.normal));

    LaneManifold<F> patch;
    F shorter;
    const auto in_order = !(a.kind > b.kind);
    clip(a_leads, in_order, lead, other, select(a_leads, a.radius, b.radius),
         select(a_leads, b.radius, a.radius), reach, patch, shorter);
    patch.normal = selected(a_leads, lead.normal, -lead.normal);
    patch.is_of_a = select(a_leads, F(1), F(0));
    patch.is_of_b = select(a_leads, F(0), F(1));

    // Two corners that are closest to each other have a direction of their own, unless edges that end there
    // are so nearly parallel that they are what meets, and show the same gap.
    const auto have_edges = both(a.count > F(1), b.count > F(1));
    const auto corners = near.between_corners > F(0.5f);
    const auto first = patch.points[0].used > F(0.5f), second = patch.points[1].used > F(0.5f);
    const F least = minimum(patch.points[0].separation, patch.points[1].separation);
    const auto confirms = both(F(-parallel) > dot(other.normal, lead.normal),
                               !(fabs(least - gap) > F(0.02f) * shorter + F(0.05f) * fabs(gap)));
    const auto two = both(both(have_edges, both(first, second)), either(!corners, confirms));

    LaneManifold<F> single;
    const auto keeps_name = both(have_edges, both(!corners, either(first, second)));
    const F own_name = select(have_edges, feature_of(in_order, near.corner_a, near.corner_b), F(0));
    auto& p = single.points[0];
    p.position = F(0.5f) * (near.on_a + near.on_b) + (F(0.5f) * (a.radius - b.radius)) * near.axis;
    p.separation = gap;
    p.feature = select(keeps_name, select(first, patch.points[0].feature, patch.points[1].feature), own_name);
    p.used = select(gap > reach, F(0), F(1));
    const F turns_with_edge = select(have_edges, F(1), F(0));
    single.is_of_a = near.is_of_a * turns_with_edge;
    single.is_of_b = near.is_of_b * turns_with_edge;

    const auto out_of_reach = gap > reach;
    LaneManifold<F> result;
    result.normal = selected(two, patch.normal, near.axis);
    result.is_of_a = select(two, patch.is_of_a, single.is_of_a);
    result.is_of_b = select(two, patch.is_of_b, single.is_of_b);
    for (int k = 0; k < 2; ++k) {
        const auto &yes = patch.points[k], &no = single.points[k];
        auto& r = result.points[k];
        r.position = selected(two, yes.position, no.position);
        r.separation = select(two, yes.separation, no.separation);
        r.feature = select(two, yes.feature, no.feature);
        r.used = select(out_of_reach, F(0), select(two, yes.used, no.used));
    }
    return result;
}

}  // namespace carom::detail
