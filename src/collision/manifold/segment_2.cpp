#include "collision/facet.hpp"
#include "collision/manifold/outline_2.hpp"

namespace carom::detail {

namespace {

/// A segment and a convex shape, in the frame of the segment.
struct Meeting {
    Meeting(const Shape<2>& convex, const Facet<2>& facet, const Transform<2>& placed)
        : segment(shape_of(facet), {}),
          outline(convex, placed),
          one_sided(!facet.two_sided),
          behind(one_sided &&
                 dot(segment.normal(0), apply(placed, middle_of(convex)) - facet.points[0]) < 0) {
        if (behind) return;
        near = proximity(segment, outline);
        if (near.distance <= 0 && looks_back(near.axis)) near = front_depth(segment, outline, backward_slack);
    }

    /// The front of an outline's edge lies to its right, that of a facet to its left.
    static Shape<2> shape_of(const Facet<2>& facet) {
        Shape<2> shape;
        shape.kind = ShapeKind::facet;
        shape.a = facet.points[1];
        shape.b = facet.points[0];
        return shape;
    }
    bool looks_back(const Vec2& axis) const {
        return one_sided && dot(axis, segment.normal(0)) < -backward_slack;
    }
    double distance() const { return near.distance - outline.radius(); }

    Outline segment, outline;
    bool one_sided, behind;
    Proximity near;
};

}  // namespace

template <>
Manifold<2> collide_facet(const Shape<2>& convex, const Facet<2>& facet, const Transform<2>& placed,
                          double reach, const Vec2& axis) {
    const double last_gap = gap_along(convex, facet, placed, axis);
    if (last_gap > reach) return apart_along(axis, last_gap);
    const Meeting meeting(convex, facet, placed);
    if (meeting.behind) return {};
    if (meeting.distance() > reach) return apart_along(meeting.near.axis, meeting.distance());
    if (meeting.looks_back(meeting.near.axis)) return {};
    const Manifold<2> result = touching(meeting.segment, meeting.outline, meeting.near, reach);
    return meeting.looks_back(result.normal) ? Manifold<2>{} : result;
}

template <>
std::optional<Separation<2>> separate_facet(const Shape<2>& convex, const Facet<2>& facet,
                                            const Transform<2>& placed) {
    const Meeting meeting(convex, facet, placed);
    if (meeting.behind || meeting.looks_back(meeting.near.axis)) return std::nullopt;
    return Separation<2>{meeting.near.axis, meeting.distance()};
}

}  // namespace carom::detail
