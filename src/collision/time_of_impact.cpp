#include <algorithm>

#include "collision/cast.hpp"
#include "collision/closest.hpp"
#include "collision/manifold.hpp"
#include "math/dim.hpp"

namespace carom::detail {

namespace {

/// How far the shape reaches along the unit vector; a plane is only asked along its normal.
template <int D>
double reach_along(const Shape<D>& shape, const Transform<D>& placed, const Vec<D>& axis) {
    if (shape.kind == ShapeKind::plane) return shape.offset + dot(axis, placed.position);
    return dot(axis, apply(placed, core_support(shape, unrotate(placed.rotation, axis)))) +
           core_radius(shape);
}

/// A bound on the acceleration of any point of the shape's core, in lengths per motion²: a point that turns
/// about a centre at a distance r by the angle w is drawn inwards by w² r.
template <int D>
double acceleration(const Shape<D>& shape, const Sweep<D>& sweep) {
    const double square = angular_dot(sweep.rotation, sweep.rotation);
    return square > 0 ? square * core_reach(shape, sweep.center) : 0.0;
}

template <int D>
struct Pair {
    const Shape<D>& a;
    const Sweep<D>& a_sweep;
    const Shape<D>& b;
    const Sweep<D>& b_sweep;

    double gap_along(const Vec<D>& axis, double time) const {
        return -reach_along(b, b_sweep.at(time), -axis) - reach_along(a, a_sweep.at(time), axis);
    }
};

/// For shapes that overlap from the start.
template <int D>
Vec<D> first_axis(const Pair<D>& pair) {
    const auto apart = separate_shapes(pair.a, pair.b, relative(pair.a_sweep.start, pair.b_sweep.start));
    if (apart) return rotate(pair.a_sweep.start.rotation, apart->axis);
    return normalized(pair.a_sweep.translation - pair.b_sweep.translation);
}

/// The least that a function can be on a stretch of the length `whole` whose ends are `first` and `last` and
/// whose second derivative is at most `curvature`: the chord less ½ curvature · t · (whole − t).
double lowest_between(double first, double last, double whole, double curvature) {
    const double slope = (last - first) / whole;
    const double t = 0.5 * whole - slope / curvature;
    return curvature > 0 && t > 0 && t < whole ? first - 0.5 * curvature * t * t : std::min(first, last);
}

}  // namespace

/// Along a fixed axis every point's place is a function of time whose second derivative is bounded; so is,
/// from above, that of the gap, which is a least difference of such places. From each time the gap along the
/// separating axis is looked at further on, less far until the bound says that it was open all the way.
template <int D>
std::optional<CastHit<D>> time_of_impact(const Shape<D>& a, const Sweep<D>& a_sweep, const Shape<D>& b,
                                         const Sweep<D>& b_sweep, double tolerance) {
    // Below this the distance of two shapes is not known well enough.
    tolerance = std::max(tolerance, 1e-9 * (size_of(a) + size_of(b)));
    const Pair<D> pair{a, a_sweep, b, b_sweep};
    const double curvature = acceleration(a, a_sweep) + acceleration(b, b_sweep);
    double time = 0, stride = 1;
    for (;;) {
        const Transform<D> a_placed = a_sweep.at(time), b_placed = b_sweep.at(time);
        const ClosestPoints<D> found = closest_points(a, b, relative(a_placed, b_placed));
        Vec<D> axis = rotate(a_placed.rotation, found.axis);
        if (!(found.distance > 0)) axis = first_axis(pair);
        if (found.distance <= tolerance) return CastHit<D>{time, apply(a_placed, found.on_b), -axis};
        if (time >= 1) return std::nullopt;

        // Aims at the time when the gap, as it would be if it closed evenly, is half the tolerance.
        const double target = 0.5 * tolerance;
        stride = std::min(4 * stride, 1 - time);
        for (int tries = 0;; ++tries) {
            const double gap = pair.gap_along(axis, time + stride);
            if (lowest_between(found.distance, gap, stride, curvature) >= 0.5 * target) break;
            const double even = (found.distance - target) / (found.distance - gap);
            stride *= gap < 0.5 * target && tries < 4 ? std::max(0.1, even) : 0.5;
        }
        if (time + stride == time)  // the gap closes faster than time can be told apart
            return CastHit<D>{time, apply(a_placed, found.on_b), -axis};
        time += stride;
    }
}

template std::optional<CastHit<2>> time_of_impact(const Shape<2>&, const Sweep<2>&, const Shape<2>&,
                                                  const Sweep<2>&, double);
template std::optional<CastHit<3>> time_of_impact(const Shape<3>&, const Sweep<3>&, const Shape<3>&,
                                                  const Sweep<3>&, double);

}  // namespace carom::detail
