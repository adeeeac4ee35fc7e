#include "carom/collide.hpp"
#include "collision/manifold.hpp"
#include "math/check.hpp"

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

/// Two half-spaces overlap unless they look away from each other and leave a gap.
template <int D>
bool planes_overlap(const detail::Shape<D>& a, const detail::Shape<D>& b, const Transform<D>& b_in_a) {
    const Vec<D> b_normal = rotate(b_in_a.rotation, b.a);
    const bool opposite = length_squared(a.a + b_normal) < 1e-24;
    return !opposite || a.offset + b.offset + dot(b_normal, b_in_a.position) >= 0;
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
    const Transform<D> b_in_a = checked_relative(a_placed, b_placed);
    const auto found = detail::separate_shapes(a.shape(), b.shape(), b_in_a);
    if (found) return found->distance <= 0;
    return a.shape().kind == detail::ShapeKind::plane && b.shape().kind == detail::ShapeKind::plane &&
           planes_overlap(a.shape(), b.shape(), b_in_a);
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
    return detail::moved(detail::collide_shapes(a.shape(), b.shape(), b_in_a, reach), a_unit);
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

}  // namespace carom
