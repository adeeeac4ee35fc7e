#include "collision/manifold.hpp"

namespace carom::detail {

template <int D>
Manifold<D> collide_shapes(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a, double reach) {
    if (a.kind > b.kind) return exchanged(moved(collide_shapes(b, a, inverse(b_in_a), reach), b_in_a));
    const auto routine = pair_routines<D>(a.kind, b.kind).collide;
    return routine ? routine(a, b, b_in_a, reach) : Manifold<D>{};
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

template Manifold<2> collide_shapes(const Shape<2>&, const Shape<2>&, const Transform<2>&, double);
template Manifold<3> collide_shapes(const Shape<3>&, const Shape<3>&, const Transform<3>&, double);
template std::optional<Separation<2>> separate_shapes(const Shape<2>&, const Shape<2>&, const Transform<2>&);
template std::optional<Separation<3>> separate_shapes(const Shape<3>&, const Shape<3>&, const Transform<3>&);

}  // namespace carom::detail
