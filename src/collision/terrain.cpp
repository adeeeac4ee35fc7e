#include "collision/facet.hpp"

#include <algorithm>
#include <limits>

namespace carom::detail {

namespace {

/// The facet that is nearest to a shape or overlaps it most.
template <int D>
struct NearestFacet {
    Separation<D> separation;
    std::uint32_t facet;
};

/// Looks in larger and larger boxes, until no facet outside could be nearer than the best inside, or none is
/// nearer than `limit`.
template <int D>
std::optional<NearestFacet<D>> nearest_facet(const Shape<D>& convex, const Terrain<D>& terrain,
                                             const Transform<D>& placed, double limit) {
    const Aabb<D> own = bounds(convex, placed), whole = terrain.bounds();
    double extent = 0, furthest = 0;
    for (int i = 0; i < D; ++i) {
        extent = std::max(extent, own.upper[i] - own.lower[i]);
        furthest = std::max({furthest, own.lower[i] - whole.lower[i], whole.upper[i] - own.upper[i]});
    }
    std::optional<NearestFacet<D>> best;
    for (double reach = std::min(extent, limit);; reach = std::min(4 * reach, limit)) {
        Vec<D> margin{};
        for (int i = 0; i < D; ++i) margin[i] = reach;
        best.reset();
        terrain.query({own.lower - margin, own.upper + margin}, [&](std::uint32_t i) {
            const auto found = separate_facet(convex, terrain.facet(i), placed);
            if (found && (!best || found->distance < best->separation.distance)) best = {*found, i};
        });
        if (best && best->separation.distance <= reach) return best;
        if (reach >= furthest || reach >= limit) return best;
    }
}

}  // namespace

template <int D>
double gap_along(const Shape<D>& convex, const Facet<D>& facet, const Transform<D>& placed,
                 const Vec<D>& axis) {
    const double size = length(axis);
    if (size == 0) return -std::numeric_limits<double>::infinity();
    const Vec<D> lowest = apply(placed, core_support(convex, -unrotate(placed.rotation, axis)));
    double highest = dot(axis, facet.points[0]);
    for (int i = 1; i < D; ++i) highest = std::max(highest, dot(axis, facet.points[i]));
    return (dot(axis, lowest) - highest) / size - core_radius(convex);
}

template <int D>
Manifold<D> collide_terrain(const Shape<D>& a, const Shape<D>& terrain, const Transform<D>& terrain_in_a,
                            double reach, const Vec<D>&) {
    const Transform<D> placed = inverse(terrain_in_a);
    const auto nearest = nearest_facet(a, *terrain.terrain, placed, reach);
    if (!nearest) return {};
    const Facet<D> facet = terrain.terrain->facet(nearest->facet);
    return exchanged(moved(collide_facet(a, facet, placed, reach), terrain_in_a));
}

template <int D>
std::optional<Separation<D>> separate_from_terrain(const Shape<D>& a, const Shape<D>& terrain,
                                                   const Transform<D>& terrain_in_a) {
    const auto nearest =
        nearest_facet(a, *terrain.terrain, inverse(terrain_in_a), std::numeric_limits<double>::infinity());
    if (!nearest) return std::nullopt;
    return Separation<D>{-rotate(terrain_in_a.rotation, nearest->separation.axis),
                         nearest->separation.distance};
}

template Manifold<2> collide_terrain(const Shape<2>&, const Shape<2>&, const Transform<2>&, double,
                                     const Vec2&);
template Manifold<3> collide_terrain(const Shape<3>&, const Shape<3>&, const Transform<3>&, double,
                                     const Vec3&);
template double gap_along(const Shape<2>&, const Facet<2>&, const Transform<2>&, const Vec2&);
template double gap_along(const Shape<3>&, const Facet<3>&, const Transform<3>&, const Vec3&);
template std::optional<Separation<2>> separate_from_terrain(const Shape<2>&, const Shape<2>&,
                                                            const Transform<2>&);
template std::optional<Separation<3>> separate_from_terrain(const Shape<3>&, const Shape<3>&,
                                                            const Transform<3>&);

}  // namespace carom::detail
