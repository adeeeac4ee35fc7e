#pragma once

#include "solver/lane_outlines.hpp"

/// The manifold of two outlines in the plane, several pairs side by side: the same choices as
/// collision/manifold/polygons_2.cpp makes for one pair.
namespace carom::detail {

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
