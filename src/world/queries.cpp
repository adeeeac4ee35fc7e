#include <algorithm>

#include "collision/cast.hpp"
#include "collision/closest.hpp"
#include "collision/point.hpp"
#include "collision/ray.hpp"
#include "math/check.hpp"
#include "world/state.hpp"

// What the user asks of a world between steps. Nothing is written, so several threads may ask at once. A
// shape is asked in the frame of its body: the difference of positions is taken first, and nothing is lost
// far away.

namespace carom {

using namespace detail;

namespace {

constexpr double furthest = 1e100;  // m; leaves room for the squares of distances

template <int D>
void check(const Vec<D>& value, std::string_view name) {
    require_in(value, -furthest, furthest, name);
}

template <int D>
Transform<D> checked(const Transform<D>& placed) {
    check(placed.position, "placed.position");
    require_unit(placed.rotation, "placed.rotation");
    return {placed.position, normalized(placed.rotation)};
}

template <int D>
void check(const Ray<D>& ray) {
    check(ray.origin, "origin");
    check(ray.translation, "translation");
}

/// A hit of a shape in the frame of its body.
template <int D>
struct Found {
    std::uint32_t shape;
    CastHit<D> hit;

    bool before(const Found& other) const {
        return hit.fraction != other.hit.fraction ? hit.fraction < other.hit.fraction : shape < other.shape;
    }
};

/// The first of all hits; `walk(visit)` goes through the trees, as `cast_through_trees` does.
template <int D, class Walk, class Cast>
std::optional<Found<D>> first_hit(const Walk& walk, const Cast& cast) {
    std::optional<Found<D>> best;
    walk([&](std::uint32_t shape, double limit) {
        const auto hit = cast(shape);
        if (!hit) return limit;
        const Found<D> found{shape, *hit};
        if (!best || found.before(*best)) best = found;
        return best->hit.fraction;
    });
    return best;
}

template <int D, class Walk, class Cast>
std::vector<Found<D>> all_hits(const Walk& walk, const Cast& cast) {
    std::vector<Found<D>> result;
    walk([&](std::uint32_t shape, double limit) {
        if (const auto hit = cast(shape)) result.push_back({shape, *hit});
        return limit;
    });
    std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.before(b); });
    return result;
}

}  // namespace

namespace detail {

template <int D>
bool WorldState<D>::is_seen(std::uint32_t shape, const QueryFilter<D>& filter) const {
    const ShapeRecord<D>& s = shapes[shape];
    const Filter& own = s.definition().filter;
    if (s.definition().sensor && !filter.sensors) return false;
    if ((own.category & filter.mask) == 0 || (own.mask & filter.category) == 0) return false;
    if (infos[s.body].disabled || (filter.ignored && filter.ignored.index == s.body)) return false;
    return !filter.accepts || filter.accepts(shape_slots.template id<ShapeId<D>>(shape));
}

/// Calls `visit(shape, limit)` for the shapes whose boxes the box with the half lengths `half` meets on its
/// way; see `Tree::cast`.
template <int D>
template <class Visitor>
void WorldState<D>::cast_through_trees(const Vec<D>& origin, const Vec<D>& translation, const Vec<D>& half,
                                       Visitor&& visit) const {
    double limit = 1;
    for (const Tree<D>& tree : trees) limit = tree.cast(origin, translation, half, limit, visit);
}

/// The shapes that are seen, whose fat box overlaps the box, and that pass the test; by index.
template <int D>
template <class Test>
std::vector<ShapeId<D>> WorldState<D>::shapes_in(const Aabb<D>& box, const QueryFilter<D>& filter,
                                                 const Test& test) const {
    std::vector<std::uint32_t> found;
    const auto visit = [&](std::uint32_t shape) {
        if (is_seen(shape, filter) && test(shape)) found.push_back(shape);
    };
    for (const Tree<D>& tree : trees) tree.query(box, visit);
    std::sort(found.begin(), found.end());
    std::vector<ShapeId<D>> result;
    for (const std::uint32_t shape : found) result.push_back(shape_slots.template id<ShapeId<D>>(shape));
    return result;
}

/// The hit, from the frame of the shape's body carried into the world and given its names.
template <int D>
WorldHit<D> WorldState<D>::named(std::uint32_t shape, const CastHit<D>& hit) const {
    const Transform<D> placed = placement_of(shape);
    return {shape_slots.template id<ShapeId<D>>(shape), body_slots.template id<BodyId<D>>(shapes[shape].body),
            hit.fraction, apply(placed, hit.point), rotate(placed.rotation, hit.normal)};
}

}  // namespace detail

namespace {

/// A ray in a world.
template <int D>
struct RayQuery {
    const WorldState<D>& world;
    const Ray<D>& ray;
    const QueryFilter<D>& filter;

    template <class Visitor>
    void operator()(const Visitor& visit) const {
        world.cast_through_trees(ray.origin, ray.translation, Vec<D>{}, visit);
    }
    std::optional<CastHit<D>> cast(std::uint32_t shape) const {
        if (!world.is_seen(shape, filter)) return std::nullopt;
        const Transform<D> placed = world.placement_of(shape);
        return detail::cast_ray(world.shapes[shape].shape(), apply_inverse(placed, ray.origin),
                                unrotate(placed.rotation, ray.translation));
    }
    WorldHit<D> named(const Found<D>& found) const {
        WorldHit<D> hit = world.named(found.shape, found.hit);
        if (hit.fraction == 0) hit.point = ray.origin;
        return hit;
    }
    std::optional<WorldHit<D>> first() const {
        const auto best = first_hit<D>(*this, [&](std::uint32_t shape) { return cast(shape); });
        return best ? std::optional(named(*best)) : std::nullopt;
    }
};

/// A shape that moves in a straight line.
template <int D>
struct ShapeQuery {
    const WorldState<D>& world;
    const Solid<D>& solid;
    Transform<D> placed;
    Vec<D> translation;
    const QueryFilter<D>& filter;

    template <class Visitor>
    void operator()(const Visitor& visit) const {
        const Aabb<D> box = bounds(solid.shape(), placed);
        world.cast_through_trees(0.5 * box.lower + 0.5 * box.upper, translation,
                                 0.5 * box.upper - 0.5 * box.lower, visit);
    }
    std::optional<CastHit<D>> cast(std::uint32_t shape) const {
        if (!world.is_seen(shape, filter)) return std::nullopt;
        const Transform<D> target = world.placement_of(shape);
        return detail::cast_shape(world.shapes[shape].shape(), solid.shape(), relative(target, placed),
                                  unrotate(target.rotation, translation));
    }
};

template <int D>
ShapeQuery<D> checked(const WorldState<D>& world, const Solid<D>& solid, const Transform<D>& placed,
                      const Vec<D>& translation, const QueryFilter<D>& filter) {
    const Transform<D> unit = checked(placed);
    check(translation, "translation");
    return {world, solid, unit, translation, filter};
}

}  // namespace

template <int D>
std::optional<WorldHit<D>> World<D>::cast_ray(const Ray<D>& ray, const QueryFilter<D>& filter) const {
    check(ray);
    state_->prepare_trees_for_queries();
    return RayQuery<D>{*state_, ray, filter}.first();
}

template <int D>
std::vector<WorldHit<D>> World<D>::cast_ray_all(const Ray<D>& ray, const QueryFilter<D>& filter) const {
    check(ray);
    state_->prepare_trees_for_queries();
    const RayQuery<D> query{*state_, ray, filter};
    std::vector<WorldHit<D>> result;
    for (const Found<D>& found : all_hits<D>(query, [&](std::uint32_t shape) { return query.cast(shape); }))
        result.push_back(query.named(found));
    return result;
}

template <int D>
bool World<D>::cast_ray_any(const Ray<D>& ray, const QueryFilter<D>& filter) const {
    check(ray);
    state_->prepare_trees_for_queries();
    const RayQuery<D> query{*state_, ray, filter};
    bool any = false;
    query([&](std::uint32_t shape, double limit) {
        any = any || query.cast(shape).has_value();
        return any ? -1.0 : limit;
    });
    return any;
}

template <int D>
void World<D>::cast_rays(std::span<const Ray<D>> rays, std::span<std::optional<WorldHit<D>>> hits,
                         const QueryFilter<D>& filter, int threads) const {
    const std::shared_ptr<Scheduler> pool = make_thread_pool(threads);
    if (hits.size() != rays.size()) {
        throw Error("hits: " + std::to_string(hits.size()) + " are not as many as the " +
                    std::to_string(rays.size()) + " rays");
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
        try {
            check(rays[i]);
        } catch (const Error& error) {
            throw Error("rays[" + std::to_string(i) + "]." + error.what());
        }
    }
    state_->prepare_trees_for_queries();
    constexpr std::size_t stretch = 256;  // rays
    run_range(pool.get(), rays.size(), stretch, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) hits[i] = RayQuery<D>{*state_, rays[i], filter}.first();
    });
}

template <int D>
std::optional<WorldHit<D>> World<D>::cast_shape(const Solid<D>& solid, const Transform<D>& placed,
                                                const Vec<D>& translation,
                                                const QueryFilter<D>& filter) const {
    const ShapeQuery<D> query = checked(*state_, solid, placed, translation, filter);
    state_->prepare_trees_for_queries();
    const auto best = first_hit<D>(query, [&](std::uint32_t shape) { return query.cast(shape); });
    return best ? std::optional(state_->named(best->shape, best->hit)) : std::nullopt;
}

template <int D>
std::vector<WorldHit<D>> World<D>::cast_shape_all(const Solid<D>& solid, const Transform<D>& placed,
                                                  const Vec<D>& translation,
                                                  const QueryFilter<D>& filter) const {
    const ShapeQuery<D> query = checked(*state_, solid, placed, translation, filter);
    state_->prepare_trees_for_queries();
    std::vector<WorldHit<D>> result;
    for (const Found<D>& found : all_hits<D>(query, [&](std::uint32_t shape) { return query.cast(shape); }))
        result.push_back(state_->named(found.shape, found.hit));
    return result;
}

template <int D>
std::vector<ShapeId<D>> World<D>::overlapping(const Solid<D>& solid, const Transform<D>& placed,
                                              const QueryFilter<D>& filter) const {
    const Transform<D> unit = checked(placed);
    state_->prepare_trees_for_queries();
    return state_->shapes_in(grown_by_rounding(bounds(solid.shape(), unit)), filter,
                             [&](std::uint32_t shape) {
                                 return overlap_shapes(state_->shapes[shape].shape(), solid.shape(),
                                                       relative(state_->placement_of(shape), unit));
                             });
}

template <int D>
std::vector<ShapeId<D>> World<D>::in_box(const Aabb<D>& box, const QueryFilter<D>& filter) const {
    check(box.lower, "box.lower");
    check(box.upper, "box.upper");
    for (int i = 0; i < D; ++i) {
        if (box.upper[i] < box.lower[i]) {
            refuse(component("box.upper", i), box.upper[i],
                   "is less than box.lower, " + to_text(box.lower[i]));
        }
    }
    state_->prepare_trees_for_queries();
    return state_->shapes_in(box, filter, [&](std::uint32_t shape) {
        return overlaps(bounds(state_->shapes[shape].shape(), state_->placement_of(shape)), box);
    });
}

template <int D>
std::vector<ShapeId<D>> World<D>::at_point(const Vec<D>& point, const QueryFilter<D>& filter) const {
    check(point, "point");
    state_->prepare_trees_for_queries();
    return state_->shapes_in(grown_by_rounding(Aabb<D>{point, point}), filter, [&](std::uint32_t shape) {
        return holds(state_->shapes[shape].shape(), apply_inverse(state_->placement_of(shape), point));
    });
}

template <int D>
std::optional<NearestPoint<D>> World<D>::nearest_point(const Vec<D>& point, double max_distance,
                                                       const QueryFilter<D>& filter) const {
    check(point, "point");
    if (!(max_distance >= 0)) refuse("max_distance", max_distance, "is negative or not a number");
    state_->prepare_trees_for_queries();
    const WorldState<D>& w = *state_;
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    Vec<D> nearest{};
    const auto visit = [&](std::uint32_t shape, double limit) {
        if (!w.is_seen(shape, filter)) return limit;
        const Transform<D> placed = w.placement_of(shape);
        const Vec<D> local = apply_inverse(placed, point),
                     found = detail::nearest_point(w.shapes[shape].shape(), local);
        const double distance = length(found - local);
        if (distance > max_distance || distance > least || (distance == least && shape > best)) return limit;
        best = shape;
        least = distance;
        nearest = distance > 0 ? apply(placed, found) : point;
        return std::min(limit, distance * distance);
    };
    const double reach = std::min(max_distance, 1e150);
    double limit = reach * reach;
    for (const Tree<D>& tree : w.trees) limit = tree.approach(point, limit, visit);
    if (!is_finite(least)) return std::nullopt;
    return NearestPoint<D>{w.shape_slots.template id<ShapeId<D>>(best),
                           w.body_slots.template id<BodyId<D>>(w.shapes[best].body), nearest, least};
}

#define CAROM_INSTANTIATE(D)                                                                                \
    template std::optional<WorldHit<D>> World<D>::cast_ray(const Ray<D>&, const QueryFilter<D>&) const;     \
    template std::vector<WorldHit<D>> World<D>::cast_ray_all(const Ray<D>&, const QueryFilter<D>&) const;   \
    template bool World<D>::cast_ray_any(const Ray<D>&, const QueryFilter<D>&) const;                       \
    template void World<D>::cast_rays(std::span<const Ray<D>>, std::span<std::optional<WorldHit<D>>>,       \
                                      const QueryFilter<D>&, int) const;                                    \
    template std::optional<WorldHit<D>> World<D>::cast_shape(const Solid<D>&, const Transform<D>&,          \
                                                             const Vec<D>&, const QueryFilter<D>&) const;   \
    template std::vector<WorldHit<D>> World<D>::cast_shape_all(const Solid<D>&, const Transform<D>&,        \
                                                               const Vec<D>&, const QueryFilter<D>&) const; \
    template std::vector<ShapeId<D>> World<D>::overlapping(const Solid<D>&, const Transform<D>&,            \
                                                           const QueryFilter<D>&) const;                    \
    template std::vector<ShapeId<D>> World<D>::in_box(const Aabb<D>&, const QueryFilter<D>&) const;         \
    template std::vector<ShapeId<D>> World<D>::at_point(const Vec<D>&, const QueryFilter<D>&) const;        \
    template std::optional<NearestPoint<D>> World<D>::nearest_point(const Vec<D>&, double,                  \
                                                                    const QueryFilter<D>&) const;
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom
