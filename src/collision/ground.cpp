#include "collision/ground.hpp"

#include <algorithm>
#include <limits>

#include "collision/cast.hpp"
#include "collision/closest.hpp"
#include "collision/facet.hpp"
#include "collision/gjk.hpp"
#include "math/dim.hpp"

namespace carom::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A facet as a convex shape without thickness.
template <int D>
Shape<D> shape_of(const Facet<D>& facet) {
    Shape<D> shape;
    if constexpr (D == 2) {
        shape.kind = ShapeKind::capsule;
        shape.a = facet.points[0];
        shape.b = facet.points[1];
    } else {
        auto core = std::make_shared<Polyhedron>();
        core->vertices.assign(facet.points.begin(), facet.points.end());
        shape.kind = ShapeKind::facet;
        shape.a = (facet.points[0] + facet.points[1] + facet.points[2]) / 3;
        shape.core = core;
    }
    return shape;
}

/// Where the ray crosses the facet. Which side of an edge it passes is worked out alike for both facets that
/// meet there, but for the sign, so that no ray slips through between them.
template <int D>
std::optional<double> crossing(const Facet<D>& facet, const Vec<D>& origin, const Vec<D>& way) {
    double sides[D];
    if constexpr (D == 2) {
        sides[0] = cross(facet.points[0] - origin, way);
        sides[1] = -cross(facet.points[1] - origin, way);
    } else {
        for (int i = 0; i < 3; ++i)
            sides[i] = dot(way, cross(facet.points[(i + 1) % 3] - origin, facet.points[i] - origin));
    }
    const auto [least, most] = std::minmax_element(sides, sides + D);
    if (*least < 0 && *most > 0) return std::nullopt;
    const Vec<D> normal = facet.normal();
    const double speed = dot(normal, way);
    if (speed == 0 || (speed > 0 && !facet.two_sided)) return std::nullopt;
    const double fraction = dot(normal, facet.points[0] - origin) / speed;
    return fraction >= 0 && fraction <= 1 ? std::optional(fraction) : std::nullopt;
}

template <int D>
bool is_bounded(const Shape<D>& shape) {
    return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::terrain;
}

/// May what moves meet the facet: is its middle not behind, or the facet two-sided?
template <int D>
bool is_in_front(const Facet<D>& facet, const Vec<D>& middle) {
    return facet.two_sided || dot(facet.normal(), middle - facet.points[0]) >= 0;
}

/// A hit of a facet counts unless it is one of its back.
template <int D>
bool counts(const Facet<D>& facet, const Vec<D>& normal) {
    return facet.two_sided || dot(facet.normal(), normal) >= -backward_slack;
}

/// Calls `look(facet)` for the facets in boxes about `own` that grow until nothing outside could be nearer
/// than the distance that it returned last.
template <int D, class Look>
void look_around(const Terrain<D>& terrain, const Aabb<D>& own, const Look& look) {
    const Aabb<D> whole = terrain.bounds();
    double furthest = 0, extent = 0;
    for (int i = 0; i < D; ++i) {
        furthest = std::max({furthest, own.lower[i] - whole.lower[i], whole.upper[i] - own.upper[i]});
        extent = std::max({extent, own.upper[i] - own.lower[i], 1e-3 * (whole.upper[i] - whole.lower[i])});
    }
    for (double reach = extent;; reach *= 4) {
        double least = infinity;
        Vec<D> margin{};
        for (int i = 0; i < D; ++i) margin[i] = reach;
        terrain.query({own.lower - margin, own.upper + margin},
                      [&](std::uint32_t i) { least = std::min(least, look(terrain.facet(i))); });
        if (least <= reach || reach >= furthest) return;
    }
}

}  // namespace

template <int D>
std::optional<CastHit<D>> cast_ray_at_ground(const Shape<D>& ground, const Vec<D>& origin,
                                             const Vec<D>& translation) {
    std::optional<CastHit<D>> best;
    ground.terrain->cast(origin, translation, 1.0, [&](std::uint32_t index, double limit) {
        const Facet<D> facet = ground.terrain->facet(index);
        const auto fraction = crossing(facet, origin, translation);
        if (!fraction || (best && *fraction >= best->fraction)) return limit;
        const Vec<D> normal = facet.normal();
        best = CastHit<D>{*fraction, origin + *fraction * translation,
                          dot(normal, translation) > 0 ? -normal : normal};
        return std::min(limit, *fraction);
    });
    return best;
}

template <int D>
Vec<D> nearest_on_ground(const Shape<D>& ground, const Vec<D>& point) {
    Shape<D> probe;
    probe.a = point;
    double least = infinity;
    Vec<D> nearest = point;
    look_around(*ground.terrain, Aabb<D>{point, point}, [&](const Facet<D>& facet) {
        const CoreDistance<D> found = core_distance(shape_of(facet), probe, Transform<D>{});
        if (found.distance < least) {
            least = found.distance;
            nearest = found.overlap ? point : found.on_a;
        }
        return found.distance;
    });
    return nearest;
}

template <int D>
ClosestPoints<D> closest_to_ground(const Shape<D>& ground, const Shape<D>& b, const Transform<D>& b_placed) {
    ClosestPoints<D> best;
    best.distance = infinity;
    look_around(*ground.terrain, bounds(b, b_placed), [&](const Facet<D>& facet) {
        const ClosestPoints<D> found = closest_points(shape_of(facet), b, b_placed);
        if (found.distance < best.distance) best = found;
        return found.distance;
    });
    return best;
}

template <int D>
std::optional<CastHit<D>> cast_at_ground(const Shape<D>& ground, const Shape<D>& b,
                                         const Transform<D>& b_placed, const Vec<D>& translation) {
    const Aabb<D> box = bounds(b, b_placed);
    const Vec<D> middle = apply(b_placed, middle_of(b));
    std::optional<CastHit<D>> best;
    const auto visit = [&](std::uint32_t index, double limit) {
        const Facet<D> facet = ground.terrain->facet(index);
        if (is_bounded(b) && !is_in_front(facet, middle)) return limit;
        const Shape<D> shape = shape_of(facet);
        const ClosestPoints<D> start = closest_points(shape, b, b_placed);
        std::optional<CastHit<D>> hit;
        if (start.distance > 0) {
            hit = cast_shape(shape, b, b_placed, translation);
        } else if (!is_bounded(b)) {
            hit = CastHit<D>{0, start.on_a, facet.normal()};
        } else if (const auto out = separate_facet(b, facet, b_placed); out && out->distance <= 0) {
            hit = CastHit<D>{0, start.on_a, out->axis};
        }
        if (!hit || !counts(facet, hit->normal) || (best && hit->fraction >= best->fraction)) return limit;
        best = hit;
        return std::min(limit, hit->fraction);
    };
    ground.terrain->cast(0.5 * (box.lower + box.upper), translation, 1.0, visit,
                         0.5 * (box.upper - box.lower));
    return best;
}

template <int D>
std::optional<CastHit<D>> impact_with_ground(const Shape<D>& ground, const Sweep<D>& ground_sweep,
                                             const Shape<D>& b, const Sweep<D>& b_sweep, double tolerance) {
    // All that b can reach, in the frame of the ground: its centre goes straight there unless the ground
    // turns.
    const Transform<D> from = relative(ground_sweep.start, b_sweep.start);
    const Vec<D> start = apply(from, b_sweep.center);
    const Vec<D> way = unrotate(ground_sweep.start.rotation, b_sweep.translation - ground_sweep.translation);
    const double reach = core_reach(b, b_sweep.center) + core_radius(b) + tolerance;
    const bool turns = angular_dot(ground_sweep.rotation, ground_sweep.rotation) > 0;
    Aabb<D> box = ground.terrain->bounds();
    for (int i = 0; i < D && !turns && is_bounded(b); ++i) {
        box.lower[i] = start[i] + std::min(way[i], 0.0) - reach;
        box.upper[i] = start[i] + std::max(way[i], 0.0) + reach;
    }
    const Vec<D> middle = apply(from, middle_of(b));
    std::optional<CastHit<D>> best;
    ground.terrain->query(box, [&](std::uint32_t index) {
        const Facet<D> facet = ground.terrain->facet(index);
        if (is_bounded(b) && !is_in_front(facet, middle)) return;
        const auto hit = time_of_impact(b, b_sweep, shape_of(facet), ground_sweep, tolerance);
        if (!hit || (best && hit->fraction >= best->fraction)) return;
        const Rotation<D> turned = ground_sweep.at(hit->fraction).rotation;
        if (counts(facet, unrotate(turned, hit->normal))) best = hit;
    });
    return best;
}

#define CAROM_INSTANTIATE(D)                                                                                 \
    template std::optional<CastHit<D>> cast_ray_at_ground(const Shape<D>&, const Vec<D>&, const Vec<D>&);    \
    template Vec<D> nearest_on_ground(const Shape<D>&, const Vec<D>&);                                       \
    template ClosestPoints<D> closest_to_ground(const Shape<D>&, const Shape<D>&, const Transform<D>&);      \
    template std::optional<CastHit<D>> cast_at_ground(const Shape<D>&, const Shape<D>&, const Transform<D>&, \
                                                      const Vec<D>&);                                        \
    template std::optional<CastHit<D>> impact_with_ground(const Shape<D>&, const Sweep<D>&, const Shape<D>&, \
                                                          const Sweep<D>&, double);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
