#include <algorithm>
#include <cmath>

#include "collision/manifold/outline_2.hpp"
#include "collision/manifold/pairs_2.hpp"

namespace carom::detail {

namespace {

/// Cosine of the angle up to which two edges count as parallel, about 11°.
constexpr double parallel = 0.98;

/// The single point where two shapes are closest or deepest.
Manifold<2> single_point(const Proximity& near, const Outline& a, const Outline& b, std::uint32_t feature) {
    const Vec2 middle = 0.5 * (near.on_a + near.on_b) + 0.5 * (a.radius() - b.radius()) * near.axis;
    Manifold<2> result;
    result.normal = near.axis;
    result.points[0] = {middle, near.distance - a.radius() - b.radius(), feature};
    result.count = 1;
    return result;
}

/// Whose edge gives the normal: the one with the greater separation; of two that are parallel and as good up
/// to a small share of their length, the longer one. So a resting pair keeps its choice while it trembles,
/// and the choice does not depend on the order of the two.
bool edge_of_a_leads(const Outline& a, const Outline& b, const Proximity& near) {
    if (!a.has_edges() || !b.has_edges()) return a.has_edges();
    const double difference = near.face_a.separation - near.face_b.separation;
    if (dot(a.normal(near.face_a.edge), b.normal(near.face_b.edge)) < -parallel) {
        const auto edge_length = [](const Outline& outline, int edge) {
            return length(outline.corner(outline.next(edge)) - outline.corner(edge));
        };
        const double along_a = edge_length(a, near.face_a.edge), along_b = edge_length(b, near.face_b.edge);
        constexpr double steady = 1e-4;
        if (std::fabs(difference) <= steady * std::min(along_a, along_b)) return along_a >= along_b;
    }
    return difference >= 0;
}

/// The part of the facing edge of `other` that lies in front of the leading edge, by its two ends.
struct Overlap {
    struct End {
        Vec2 on_other{};                   ///< a point of the other's edge
        double height = 0;                 ///< of it above the leading edge
        int corner = 0, other_corner = 0;  ///< the ends of the two edges that meet here
    };
    Vec2 normal{};
    bool parallel_edges = false;
    double shorter = 0;  ///< of the two edges
    std::array<End, 2> ends{};
    bool exists = false;
};

Overlap clip(const Outline& leader, const Facing& facing, const Outline& other) {
    Overlap result;
    result.normal = leader.normal(facing.edge);
    const int edge = facing_edge(other, facing.corner, result.normal);
    result.parallel_edges = dot(other.normal(edge), result.normal) < -parallel;

    const int first = facing.edge, second = leader.next(first);
    const Vec2 origin = leader.corner(first), along = leader.corner(second) - origin;
    const double whole = length(along);
    // Outlines run counter-clockwise, so the edges run against each other: the other's ends where ours
    // begins.
    const int last_corner = edge, first_corner = other.next(edge);
    const Vec2 from = other.corner(first_corner), to = other.corner(last_corner);
    result.shorter = std::min(whole, length(to - from));
    const double begin = dot(from - origin, along) / whole, end = dot(to - origin, along) / whole;
    const double low = std::max(begin, 0.0), high = std::min(end, whole);
    result.exists = high > low;
    if (!result.exists) return result;
    const auto at = [&](double place) {
        // Ends stay what they are, bit by bit.
        return place == begin ? from
               : place == end ? to
                              : from + (place - begin) / (end - begin) * (to - from);
    };
    const Vec2 left = at(low), right = at(high);
    result.ends = {{{left, dot(left - origin, result.normal), first, first_corner},
                    {right, dot(right - origin, result.normal), second, last_corner}}};
    return result;
}

}  // namespace

std::optional<Separation<2>> separate_outlines(const Shape<2>& a, const Shape<2>& b,
                                               const Transform<2>& b_in_a) {
    const Outline first(a, {}), second(b, b_in_a);
    const Proximity near = proximity(first, second);
    return Separation<2>{near.axis, near.distance - first.radius() - second.radius()};
}

Manifold<2> collide_outlines(const Shape<2>& a, const Shape<2>& b, const Transform<2>& b_in_a, double reach,
                             const Vec2& axis) {
    const double last_gap = gap_along(a, b, b_in_a, axis);
    if (last_gap > reach) return apart_along(axis, last_gap);
    const Outline first(a, {}), second(b, b_in_a);
    const Proximity near = proximity(first, second);
    const double gap = near.distance - first.radius() - second.radius();
    return gap > reach ? apart_along(near.axis, gap) : touching(first, second, near, reach);
}

Manifold<2> touching(const Outline& first, const Outline& second, const Proximity& near, double reach) {
    const double rounding = first.radius() + second.radius();
    // A ball has nothing but itself to touch with; its contact lives on while it rolls from edge to edge.
    if (!first.has_edges() || !second.has_edges()) return single_point(near, first, second, 0);

    const bool a_leads = edge_of_a_leads(first, second, near);
    const Outline& leader = a_leads ? first : second;
    const Outline& other = a_leads ? second : first;
    std::uint32_t feature = feature_id(near.corner_a, near.corner_b);

    const Overlap overlap = clip(leader, a_leads ? near.face_a : near.face_b, other);
    Manifold<2> result;
    result.normal = a_leads ? overlap.normal : -overlap.normal;
    result.normal_of = a_leads ? NormalOf::first : NormalOf::second;
    for (int k = 0; overlap.exists && k < 2; ++k) {
        // The second end first where b leads: the points come in the same order whoever leads.
        const Overlap::End& end = overlap.ends[a_leads ? k : 1 - k];
        const double separation = end.height - rounding;
        if (separation > reach) continue;
        const Vec2 middle =
            end.on_other - 0.5 * (end.height - leader.radius() + other.radius()) * overlap.normal;
        const std::uint32_t name =
            a_leads ? feature_id(end.corner, end.other_corner) : feature_id(end.other_corner, end.corner);
        result.points[result.count++] = {middle, separation, name};
    }
    // Two corners that are closest to each other have a direction of their own, unless edges that end there
    // are so nearly parallel that they are what meets, and show the same gap.
    const double gap = near.distance - rounding;
    const auto confirms = [&] {
        const double least = std::min(result.points[0].separation, result.points[1].separation);
        return std::fabs(least - gap) <= 0.02 * overlap.shorter + 0.05 * std::fabs(gap);
    };
    if (result.count == 2 && (!near.corners || (overlap.parallel_edges && confirms()))) return result;
    // A point that is left of two keeps its name.
    if (result.count == 1 && !near.corners) feature = result.points[0].feature;
    Manifold<2> single = single_point(near, first, second, feature);
    if (!near.corners && single.normal == result.normal) single.normal_of = result.normal_of;
    return single;
}

}  // namespace carom::detail
