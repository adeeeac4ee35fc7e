#include "carom/collide.hpp"
#include "collision/cast.hpp"
#include "collision/closest.hpp"
#include "collision/manifold.hpp"
#include "collision/point.hpp"
#include "collision/ray.hpp"
#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {

namespace {

/// Positions that two shapes are asked about must leave room for the squares of their distances.
constexpr double furthest = 1e100;

template <int D>
Transform<D> checked(const Transform<D>& placed, const std::string& name) {
    detail::require_in(placed.position, -furthest, furthest, name + ".position");
    detail::require_unit(placed.rotation, name + ".rotation");
    return {placed.position, normalized(placed.rotation)};
}

template <int D>
Transform<D> checked_relative(const Transform<D>& a_placed, const Transform<D>& b_placed) {
    return relative(checked(a_placed, "a_placed"), checked(b_placed, "b_placed"));
}

template <int D>
void check_place(const Vec<D>& value, std::string_view name) {
    detail::require_in(value, -furthest, furthest, name);
}

template <int D>
Sweep<D> checked(const Sweep<D>& sweep, const std::string& name, bool plane) {
    constexpr double most_turning = 1e4;  // rad
    Sweep<D> result = sweep;
    result.start = checked(sweep.start, name + ".start");
    check_place(sweep.translation, name + ".translation");
    check_place(sweep.center, name + ".center");
    double turning;
    if constexpr (D == 2) {
        detail::require_in(sweep.rotation, -most_turning, most_turning, name + ".rotation");
        turning = std::fabs(sweep.rotation);
    } else {
        detail::require_in(sweep.rotation, -most_turning, most_turning, name + ".rotation");
        turning = length(sweep.rotation);
    }
    if (plane && turning > 0) detail::refuse(name + ".rotation", turning, "turns a plane");
    return result;
}

/// The hit of a frame that `placed` places, in the outer frame.
template <int D>
std::optional<CastHit<D>> moved(std::optional<CastHit<D>> hit, const Transform<D>& placed) {
    if (hit) {
        hit->point = apply(placed, hit->point);
        hit->normal = rotate(placed.rotation, hit->normal);
    }
    return hit;
}

}  // namespace

template <int D>
Solid<D>::Solid(const ShapeDefinition<D>& definition)
    : shape_(std::make_shared<const detail::Shape<D>>(detail::make_shape(definition))) {}

template <int D>
Solid<D>::Solid(const Geometry<D>& geometry) : Solid(ShapeDefinition<D>{.geometry = geometry}) {}

template <int D>
bool overlap(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
             const Transform<D>& b_placed) {
    return detail::overlap_shapes(a.shape(), b.shape(), checked_relative(a_placed, b_placed));
}

template <int D>
std::optional<Separation<D>> separation(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                                        const Transform<D>& b_placed) {
    auto found = detail::separate_shapes(a.shape(), b.shape(), checked_relative(a_placed, b_placed));
    if (found) found->axis = rotate(normalized(a_placed.rotation), found->axis);
    return found;
}

template <int D>
Manifold<D> collide(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                    const Transform<D>& b_placed, double reach) {
    if (!(reach >= 0)) detail::refuse("reach", reach, "is negative or not a number");
    const Transform<D> b_in_a = checked_relative(a_placed, b_placed);
    const Transform<D> a_unit{a_placed.position, normalized(a_placed.rotation)};
    const Manifold<D> found = detail::collide_shapes(a.shape(), b.shape(), b_in_a, reach);
    return found.count > 0 ? detail::moved(found, a_unit) : Manifold<D>{};
}

template <int D>
ClosestPoints<D> closest_points(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                                const Transform<D>& b_placed) {
    const Transform<D> b_in_a = checked_relative(a_placed, b_placed);
    const Transform<D> a_unit{a_placed.position, normalized(a_placed.rotation)};
    const ClosestPoints<D> found = detail::closest_points(a.shape(), b.shape(), b_in_a);
    return {apply(a_unit, found.on_a), apply(a_unit, found.on_b), rotate(a_unit.rotation, found.axis),
            found.distance};
}

template <int D>
bool contains(const Solid<D>& solid, const Transform<D>& placed, const Vec<D>& point) {
    const Transform<D> unit = checked(placed, "placed");
    check_place(point, "point");
    return detail::holds(solid.shape(), apply_inverse(unit, point));
}

template <int D>
std::optional<CastHit<D>> cast_ray(const Solid<D>& solid, const Transform<D>& placed, const Vec<D>& origin,
                                   const Vec<D>& translation) {
    const Transform<D> unit = checked(placed, "placed");
    check_place(origin, "origin");
    check_place(translation, "translation");
    auto hit = moved(
        detail::cast_ray(solid.shape(), apply_inverse(unit, origin), unrotate(unit.rotation, translation)),
        unit);
    if (hit && hit->fraction == 0) hit->point = origin;
    return hit;
}

template <int D>
std::optional<CastHit<D>> cast_shape(const Solid<D>& moving, const Transform<D>& moving_placed,
                                     const Vec<D>& translation, const Solid<D>& target,
                                     const Transform<D>& target_placed) {
    const Transform<D> from = checked(moving_placed, "moving_placed"),
                       unit = checked(target_placed, "target_placed");
    check_place(translation, "translation");
    return moved(detail::cast_shape(target.shape(), moving.shape(), relative(unit, from),
                                    unrotate(unit.rotation, translation)),
                 unit);
}

template <int D>
Transform<D> Sweep<D>::at(double fraction) const {
    const Rotation<D> turned = detail::exp_rotation<D>(fraction * rotation) * start.rotation;
    return {start.position + fraction * translation + rotate(start.rotation, center) - rotate(turned, center),
            turned};
}

template <int D>
std::optional<CastHit<D>> time_of_impact(const Solid<D>& a, const Sweep<D>& a_sweep, const Solid<D>& b,
                                         const Sweep<D>& b_sweep, double tolerance) {
    detail::require_positive(tolerance, "tolerance");
    const auto is_plane = [](const Solid<D>& s) { return s.shape().kind == detail::ShapeKind::plane; };
    Sweep<D> from = checked(a_sweep, "a_sweep", is_plane(a)), to = checked(b_sweep, "b_sweep", is_plane(b));
    // All is worked out near where a starts, so nothing is lost far from the origin.
    const Vec<D> base = a_sweep.start.position;
    from.start.position = {};
    to.start.position -= base;
    auto hit = detail::time_of_impact(a.shape(), from, b.shape(), to, tolerance);
    if (hit) hit->point += base;
    return hit;
}

template class Solid<2>;
template class Solid<3>;
template bool overlap(const Solid<2>&, const Transform<2>&, const Solid<2>&, const Transform<2>&);
template bool overlap(const Solid<3>&, const Transform<3>&, const Solid<3>&, const Transform<3>&);
template std::optional<Separation<2>> separation(const Solid<2>&, const Transform<2>&, const Solid<2>&,
                                                 const Transform<2>&);
template std::optional<Separation<3>> separation(const Solid<3>&, const Transform<3>&, const Solid<3>&,
                                                 const Transform<3>&);
template Manifold<2> collide(const Solid<2>&, const Transform<2>&, const Solid<2>&, const Transform<2>&,
                             double);
template Manifold<3> collide(const Solid<3>&, const Transform<3>&, const Solid<3>&, const Transform<3>&,
                             double);

#define CAROM_INSTANTIATE(D)                                                                             \
    template struct Sweep<D>;                                                                            \
    template ClosestPoints<D> closest_points(const Solid<D>&, const Transform<D>&, const Solid<D>&,      \
                                             const Transform<D>&);                                       \
    template bool contains(const Solid<D>&, const Transform<D>&, const Vec<D>&);                         \
    template std::optional<CastHit<D>> cast_ray(const Solid<D>&, const Transform<D>&, const Vec<D>&,     \
                                                const Vec<D>&);                                          \
    template std::optional<CastHit<D>> cast_shape(const Solid<D>&, const Transform<D>&, const Vec<D>&,   \
                                                  const Solid<D>&, const Transform<D>&);                 \
    template std::optional<CastHit<D>> time_of_impact(const Solid<D>&, const Sweep<D>&, const Solid<D>&, \
                                                      const Sweep<D>&, double);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom
