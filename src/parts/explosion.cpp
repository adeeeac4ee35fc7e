#include "carom/parts/explosion.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

/// Area that a ball of the same measure shows: the root is that of r from V = 4/3 πr³, found by Newton.
template <int D>
double cross_section(double measure) {
    if constexpr (D == 2) {
        return 2 * std::sqrt(measure / pi);
    } else {
        const double cube = 0.75 * measure / pi;
        if (!(cube > 0)) return 0;
        double r = std::max(1.0, cube);
        for (double next = r; (next = (2 * r + cube / (r * r)) / 3) < r;) r = next;
        return pi * r * r;
    }
}

template <int D>
double share_at(const Explosion<D>& e, double distance) {
    const double rest = std::max(0.0, 1 - distance / e.radius);
    switch (e.falloff) {
        case Falloff::none:
            return 1;
        case Falloff::linear:
            return rest;
        default:
            return rest * rest;
    }
}

/// The shapes that the filter lets through and that belong to such bodies.
template <int D, class Test>
QueryFilter<D> only(const World<D>& world, const QueryFilter<D>& filter, const Test& test) {
    QueryFilter<D> result = filter;
    result.accepts = [&world, &filter, test](ShapeId<D> shape) {
        return test(world.body_of(shape)) && (!filter.accepts || filter.accepts(shape));
    };
    return result;
}

template <int D>
bool is_shielded(const World<D>& world, const Explosion<D>& e, BodyId<D> body, const Vec<D>& point) {
    const auto shields = [&](BodyId<D> other) {
        return other != body && world.type(other) == BodyType::fixed;
    };
    // Nearly there: what the body leans on is not between.
    return world.cast_ray_any({e.center, 0.999 * (point - e.center)}, only(world, e.filter, shields));
}

template <int D>
bool push(World<D>& world, const Explosion<D>& e, BodyId<D> body) {
    const auto is_body = [body](BodyId<D> other) { return other == body; };
    const auto nearest = world.nearest_point(e.center, e.radius, only(world, e.filter, is_body));
    if (!nearest) return false;
    if (e.shielded && is_shielded(world, e, body, nearest->point) &&
        is_shielded(world, e, body, world.center_of_mass(body)))
        return false;
    // From within a body it is pushed as a whole.
    const bool inside = nearest->distance == 0;
    const Vec<D> point = inside ? world.center_of_mass(body) : nearest->point;
    const Vec<D> away = normalized(point - e.center);
    double measured = 0;
    for (const ShapeId<D> shape : world.shapes(body)) measured += measure<D>(world.shape(shape).geometry);
    const double impulse = e.pressure * cross_section<D>(measured) * share_at(e, nearest->distance);
    if (impulse == 0 || away == Vec<D>{}) return false;
    world.apply_impulse(body, impulse * away, point);
    return true;
}

}  // namespace

template <int D>
std::vector<BodyId<D>> explode(World<D>& world, const Explosion<D>& explosion) {
    require_finite(explosion.center, "center");
    require_positive(explosion.radius, "radius");
    require_not_negative(explosion.pressure, "pressure");
    const auto can_fly = [&](BodyId<D> body) { return world.type(body) == BodyType::dynamic; };
    std::vector<BodyId<D>> bodies;
    for (const ShapeId<D> shape : world.overlapping(Solid<D>(Ball{explosion.radius}), {explosion.center, {}},
                                                    only(world, explosion.filter, can_fly)))
        bodies.push_back(world.body_of(shape));
    std::ranges::sort(bodies, {}, &BodyId<D>::index);
    bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
    std::erase_if(bodies, [&](BodyId<D> body) { return !push(world, explosion, body); });
    return bodies;
}

template std::vector<BodyId2> explode(World2&, const Explosion<2>&);
template std::vector<BodyId3> explode(World3&, const Explosion<3>&);

}  // namespace carom
