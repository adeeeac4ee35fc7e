#include <algorithm>
#include <array>
#include <cmath>

#include "collision/facet.hpp"
#include "collision/manifold.hpp"
#include "geometry/facet_point.hpp"
#include "world/state.hpp"

// What is particular about surfaces: seams between fixed shapes, one-way shapes, conveyor belts.

namespace carom::detail {

namespace {

/// Fixed shapes whose surfaces are no further apart count as flush.
constexpr double flush = 1e-4;  // m

/// Distance of the point from the shape, negative inside, or from a facet of it.
template <int D>
double distance_from(const Shape<D>& shape, std::uint32_t facet, const Transform<D>& placed,
                     const Vec<D>& point) {
    const Vec<D> local = unrotate(placed.rotation, point - placed.position);
    if (shape.kind == ShapeKind::terrain) return distance_to_facet(shape.terrain->facet(facet), local);
    Shape<D> dot_shape;
    dot_shape.a = local;
    return separate_shapes<D>(shape, dot_shape, Transform<D>{})->distance;
}

/// The plane of the facet, if the direction is within 2.5 degrees of its normal.
template <int D>
std::optional<FacePlane<D>> facing_plane(const Facet<D>& facet, const Vec<D>& direction) {
    const Vec<D> normal = facet.normal();
    const double cosine = dot(normal, direction);
    if (std::fabs(cosine) < 0.999 || (cosine < 0 && !facet.two_sided)) return std::nullopt;
    const Vec<D> outwards = cosine < 0 ? -normal : normal;
    return FacePlane<D>{outwards, dot(outwards, facet.points[0])};
}

template <int D, class Box>
bool near_box(const Box& box, const Vec<D>& point, double reach) {
    for (int i = 0; i < D; ++i) {
        if (point[i] < box.lower[i] - reach || point[i] > box.upper[i] + reach) return false;
    }
    return true;
}

}  // namespace

/// Of two faces that lie on each other nearly parallel, either may give the normal. Where the fixed one does
/// not, a body that slides would be led by its own tilt, the more so the faster it is; so it does here.
template <int D>
void WorldState<D>::lay_on_fixed_face(Manifold<D>& m, const ContactRecord<D>& c,
                                      const Transform<D>& b_in_a) const {
    const bool a_fixed = types[c.body_a] == BodyType::fixed;
    const Shape<D>& shape = shapes[a_fixed ? c.shape_a : c.shape_b].shape();
    const Transform<D> placed = a_fixed ? Transform<D>{} : b_in_a;
    const double outwards = a_fixed ? 1 : -1;
    const Vec<D> direction = unrotate(placed.rotation, outwards * m.normal);
    const auto face = shape.kind == ShapeKind::terrain
                          ? facing_plane(shape.terrain->facet(c.facet), direction)
                          : facing_plane<D>(shape, direction);
    if (!face) return;
    const Vec<D> normal = rotate(placed.rotation, face->normal);
    const double offset = face->offset + dot(normal, placed.position);
    for (int i = 0; i < m.count; ++i) {
        ManifoldPoint<D>& p = m.points[i];
        const Vec<D> on_mover = p.position + (0.5 * p.separation * outwards) * m.normal;
        p.separation = dot(normal, on_mover) - offset;
        p.position = on_mover - 0.5 * p.separation * normal;
    }
    m.normal = outwards * normal;
    m.normal_of = a_fixed ? NormalOf::first : NormalOf::second;
}

/// Where fixed shapes lie flush, the edges between them are not there for what slides over them. The contact
/// with one of them, at the point p with the normal n, is false when the union of the shapes has no such
/// normal there: when another shape that holds p reaches out beyond the plane through p across n, on the side
/// of the moving body. That a shape reaches out is told by its distance from p + δ n, which then is less than
/// δ. It may do so and yet leave room for the body, as a wall does beside a box on the floor; then the
/// surface goes on from p to below the body, and lies open somewhere on this way.
///
/// The point is given as it was found, from a's centre and midway between the shapes: were it rounded to
/// `float`, two shapes on whose common edge a body lies would each reach out beyond the other's plane.
///
/// Nothing is lost: as long as the shapes are apart, the fixed point nearest to the body is never false, for
/// whatever reaches out there would be nearer still.
template <int D>
bool WorldState<D>::is_artefact_of_seam(const ContactRecord<D>& c, const BodyState<D>& a,
                                        const BodyState<D>& b, const Vec<D>& middle,
                                        double separation) const {
    const bool a_fixed = types[c.body_a] == BodyType::fixed;
    const std::uint32_t body = a_fixed ? c.body_b : c.body_a;
    const std::uint32_t own_shape = a_fixed ? c.shape_a : c.shape_b;
    const auto is_own = [&](const FixedContact& other) {
        return other.other == own_shape && other.facet == c.facet;
    };
    const auto [first, last] = std::ranges::equal_range(fixed_contacts, body, {}, &FixedContact::body);
    if (last - first < 2) return false;

    const BodyState<D>& mover = a_fixed ? b : a;
    const Vec<D> arm = a.position - mover.position + middle;
    const Vec<D> n = (a_fixed ? 1.0 : -1.0) * narrow<double>(c.normal);
    const Vec<D> p = mover.position + arm - 0.5 * separation * n;  // on the fixed surface
    const double probe = std::clamp(0.02 * masses[body].radius, 10 * flush, 0.02);
    // Most often all are facets of one terrain.
    std::uint32_t placed_body = shapes[own_shape].body;
    Transform<D> placed = frame_of(placed_body);
    const auto distance = [&](const FixedContact& other, const Vec<D>& from) {
        const ShapeRecord<D>& s = shapes[other.other];
        if (s.body != placed_body) {
            placed_body = s.body;
            placed = frame_of(placed_body);
        }
        return distance_from<D>(s.shape(), other.facet, placed, from);
    };
    const auto holds = [&](const FixedContact& other, const Vec<D>& at) {
        if (is_own(other) || !near_box<D>(fat_boxes[other.other], at, flush)) return false;
        const ShapeRecord<D>& s = shapes[other.other];
        if (s.shape().kind == ShapeKind::terrain && s.body == placed_body) {
            const Vec<D> local = unrotate(placed.rotation, at - placed.position);
            const Facet<D> facet = s.shape().terrain->facet(other.facet);
            return near_box<D>(facet.bounds(), local, flush) && distance_to_facet(facet, local) <= flush;
        }
        return distance(other, at) <= flush;
    };
    const auto covers = [&](const Vec<D>& at) {
        return std::any_of(first, last, [&](const FixedContact& other) { return holds(other, at); });
    };
    const auto reaches_out = [&](const FixedContact& other) {
        constexpr double rounding = 1e-7;
        return holds(other, p) && distance(other, p + probe * n) < (1 - rounding) * probe;
    };
    if (std::none_of(first, last, reaches_out)) return false;

    const Vec<D> along = -arm + dot(arm, n) * n;  // towards the body, on the surface
    const double way = length(along);
    if (way < 1e-4 * length(arm)) return true;
    const auto& own = *std::find_if(first, last, is_own);
    return std::ranges::none_of(std::array{probe / way, 0.25, 0.5, 1.0}, [&](double share) {
        const Vec<D> onwards = p + std::min(share, 1.0) * along;
        return distance(own, onwards) <= flush && !covers(onwards + probe * n);
    });
}

/// How the shape's frame is turned in the world.
template <int D>
Rotation<D> WorldState<D>::axes_of(std::uint32_t shape) const {
    return states[shapes[shape].body].rotation * normalized(shapes[shape].definition().rotation);
}

/// A one-way shape lets pass what was not on its open side when it came near, until it has gone.
template <int D>
void WorldState<D>::pass_one_way(ContactRecord<D>& c, bool was_near) const {
    if (c.count == 0) c.passing = false;
    if (c.count == 0) return;
    const auto blocks = [&](std::uint32_t shape, double towards_other) {
        const auto& direction = shapes[shape].definition().one_way;
        if (!direction) return true;
        const Vec<D> open = rotate(axes_of(shape), *direction);
        constexpr double least_cosine = 0.1;
        return towards_other * dot(narrow<double>(c.normal), open) > least_cosine * length(open);
    };
    if (!was_near) c.passing = !blocks(c.shape_a, 1) || !blocks(c.shape_b, -1);
    if (c.passing) c.count = 0;
}

/// The velocity of the surfaces themselves, without the part along the normal.
template <int D>
void WorldState<D>::drag_along(ContactRecord<D>& c) const {
    const auto surface = [&](std::uint32_t shape) {
        return rotate(axes_of(shape), shapes[shape].definition().surface_velocity);
    };
    const Vec<D> normal = narrow<double>(c.normal);
    const Vec<D> relative_velocity = surface(c.shape_b) - surface(c.shape_a);
    c.surface_velocity = narrow<float>(relative_velocity - dot(relative_velocity, normal) * normal);
}

#define CAROM_INSTANTIATE(D)                                                                            \
    template void WorldState<D>::lay_on_fixed_face(Manifold<D>&, const ContactRecord<D>&,               \
                                                   const Transform<D>&) const;                          \
    template bool WorldState<D>::is_artefact_of_seam(const ContactRecord<D>&, const BodyState<D>&,      \
                                                     const BodyState<D>&, const Vec<D>&, double) const; \
    template Rotation<D> WorldState<D>::axes_of(std::uint32_t) const;                                   \
    template void WorldState<D>::pass_one_way(ContactRecord<D>&, bool) const;                           \
    template void WorldState<D>::drag_along(ContactRecord<D>&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
