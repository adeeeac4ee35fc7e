#include "collision/cast.hpp"

#include "collision/closest.hpp"
#include "collision/manifold.hpp"

namespace carom::detail {

namespace {

/// They touch from the start.
template <int D>
CastHit<D> touching(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a,
                    const Vec<D>& translation, const Vec<D>& point) {
    const auto apart = separate_shapes(a, b, b_in_a);
    return {0, point, apart ? apart->axis : -normalized(translation)};
}

}  // namespace

/// The distance of two convex shapes is a convex function of the way, and its slope is that of the gap along
/// the axis. So Newton's method from the start comes nearer from one side: quadratically, and by halves where
/// the shapes only graze each other.
template <int D>
std::optional<CastHit<D>> cast_shape(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a,
                                     const Vec<D>& translation) {
    constexpr int most_steps = 200;
    const double tolerance = 1e-10 * (size_of(a) + size_of(b));
    ClosestPoints<D> found = closest_points(a, b, b_in_a);
    if (!(found.distance > 0)) return touching(a, b, b_in_a, translation, found.on_a);
    double fraction = 0;
    for (int step = 0; step < most_steps && found.distance > tolerance; ++step) {
        const double closing = -dot(translation, found.axis);
        if (!(closing > 0)) return std::nullopt;
        const double further = fraction + found.distance / closing;
        if (further > 1) return std::nullopt;
        if (further == fraction) break;
        fraction = further;
        const Transform<D> moved_b{b_in_a.position + fraction * translation, b_in_a.rotation};
        const Vec<D> axis = found.axis;
        found = closest_points(a, b, moved_b);
        if (!(found.distance > 0)) found.axis = axis;
    }
    return CastHit<D>{fraction, found.on_a, found.axis};
}

template std::optional<CastHit<2>> cast_shape(const Shape<2>&, const Shape<2>&, const Transform<2>&,
                                              const Vec<2>&);
template std::optional<CastHit<3>> cast_shape(const Shape<3>&, const Shape<3>&, const Transform<3>&,
                                              const Vec<3>&);

}  // namespace carom::detail
