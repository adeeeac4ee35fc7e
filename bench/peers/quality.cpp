#include "quality.hpp"

#include <algorithm>
#include <set>

#include "carom/collide.hpp"
#include "geometry/shape.hpp"

namespace carom::peers {
namespace {

bool meet(const Filter& a, const Filter& b) {
    if (a.group != 0 && a.group == b.group) return a.group > 0;
    return (a.mask & b.category) && (b.mask & a.category);
}

/// The deepest overlap of two shapes of different bodies that no joint connects.
template <int D>
double deepest_overlap(const World<D>& world) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
    for (const JointId<D> id : world.joints()) {
        const JointDefinition<D>& joint = world.joint(id);
        if (joint.a && !joint.collide) joined.insert(std::minmax(joint.a->index, joint.b.index));
    }
    std::vector<std::pair<ShapeId<D>, Solid<D>>> solids;
    std::vector<std::size_t> solid_of;
    for (const BodyId<D> body : world.bodies())
        for (const ShapeId<D> shape : world.shapes(body)) {
            solid_of.resize(std::max<std::size_t>(solid_of.size(), shape.index + 1));
            solid_of[shape.index] = solids.size();
            solids.emplace_back(shape, world.shape(shape));
        }
    double deepest = 0;
    for (const auto& [shape, solid] : solids) {
        const BodyId<D> body = world.body_of(shape);
        if (world.type(body) != BodyType::dynamic) continue;
        const Transform<D> placed = world.transform(body);
        const Aabb<D> box = detail::bounds(solid.shape(), placed);
        for (const ShapeId<D> other : world.in_box(box)) {
            const BodyId<D> other_body = world.body_of(other);
            const bool twice = world.type(other_body) == BodyType::dynamic && other.index <= shape.index;
            if (twice || other_body == body || !meet(world.shape(shape).filter, world.shape(other).filter) ||
                joined.count(std::minmax(body.index, other_body.index)))
                continue;
            const auto apart =
                separation(solid, placed, solids[solid_of[other.index]].second, world.transform(other_body));
            if (apart) deepest = std::max(deepest, -apart->distance);
        }
    }
    return deepest;
}

}  // namespace

template <int D>
Quality quality(const World<D>& world, const Vec<D>& start_of_last) {
    Quality q;
    q.deepest = deepest_overlap(world);
    double mass = 0;
    for (const BodyId<D> body : world.bodies())
        if (world.type(body) == BodyType::dynamic) mass += world.mass_properties(body).mass;
    q.speed = std::sqrt(2 * world.energy().kinetic / mass);
    Vec<D> way = world.position(world.bodies().back()) - start_of_last;
    q.sunk = -way.y;
    way.y = 0;
    q.aside = length(way);
    return q;
}

template Quality quality(const World<2>&, const Vec<2>&);
template Quality quality(const World<3>&, const Vec<3>&);

}  // namespace carom::peers
