#include "collision/manifold.hpp"

#include <limits>

#include "collision/gjk.hpp"

namespace carom::detail {

template <int D>
Manifold<D> collide_shapes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, double reach,
                           const Vec<D>& axis) {
    if (a.kind > b.kind) {
        const Vec<D> seen_from_b = -unrotate(b_in_a.rotation, axis);
        return exchanged(moved(collide_shapes(b, a, inverse(b_in_a), reach, seen_from_b), b_in_a));
    }
    const auto routine = pair_routines<D>(a.kind, b.kind).collide;
    return routine ? routine(a, b, b_in_a, reach, axis) : Manifold<D>{};
}

template <int D>
double gap_along(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, const Vec<D>& axis) {
    const double size = length(axis);
    if (size == 0 || std::max(a.kind, b.kind) >= ShapeKind::plane)
        return -std::numeric_limits<double>::infinity();
    const Vec<D> extreme = difference_support(a, b, b_in_a, axis).difference;
    return dot(axis, extreme) / -size - core_radius(a) - core_radius(b);
}

template <int D>
std::optional<Separation<D>> separate_shapes(const Shape<D>& a, const Shape<D>& b,
                                             const Transform<D>& b_in_a) {
    if (a.kind > b.kind) {
        auto result = separate_shapes(b, a, inverse(b_in_a));
        if (result) result->axis = -rotate(b_in_a.rotation, result->axis);
        return result;
    }
    const auto routine = pair_routines<D>(a.kind, b.kind).separate;
    return routine ? routine(a, b, b_in_a) : std::nullopt;
}

#define CAROM_INSTANTIATE(D)                                                                           \
    template Manifold<D> collide_shapes(const Shape<D>&, const Shape<D>&, const Transform<D>&, double, \
                                        const Vec<D>&);                                                \
    template double gap_along(const Shape<D>&, const Shape<D>&, const Transform<D>&, const Vec<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE
template std::optional<Separation<2>> separate_shapes(const Shape<2>&, const Shape<2>&, const Transform<2>&);
template std::optional<Separation<3>> separate_shapes(const Shape<3>&, const Shape<3>&, const Transform<3>&);

}  // namespace carom::detail
