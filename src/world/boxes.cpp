#include <algorithm>
#include <cmath>

#include "world/meeting.hpp"
#include "world/state.hpp"

// Where the shapes are: each has a box that is larger than it by a margin, in one of three trees.

namespace carom::detail {

namespace {

/// Boxes are made this much fatter than the shape, or this share of its size where that is less, so that a
/// body that hardly moves keeps its box. A crowd pays more for neighbours that do not touch than for new
/// boxes, so this is little.
constexpr double box_margin = 0.05, margin_share = 1.0 / 32;

/// What bounces may turn within a step, or be struck, and then strike what is near.
template <int D>
double least_margin(const ShapeRecord<D>& shape) {
    return shape.definition->material.restitution >= lively_restitution ? 0.5 * speculative_distance : 0;
}

template <int D>
Aabb<D> grown(const Aabb<D>& box, double margin, const Vec<D>& motion) {
    Aabb<D> r;
    for (int i = 0; i < D; ++i) {
        r.lower[i] = box.lower[i] - margin + std::min(motion[i], 0.0);
        r.upper[i] = box.upper[i] + margin + std::max(motion[i], 0.0);
    }
    return r;
}

}  // namespace

/// The tree for the shapes of the body as it is now.
template <int D>
TreeKind WorldState<D>::tree_for(std::uint32_t body) const {
    if (types[body] == BodyType::fixed) return of_fixed;
    return is_moving(body) && !infos[body].disabled ? of_moving : of_resting;
}

/// Puts the shapes of the body into another tree.
template <int D>
void WorldState<D>::change_tree(std::uint32_t body, TreeKind kind) {
    if (tree_of[body] == kind) return;
    for (const ShapeId<D>& id : infos[body].shapes) {
        std::int32_t& leaf = shapes[id.index].leaf;
        if (leaf == Tree<D>::none) continue;
        trees[tree_of[body]].remove(leaf);
        leaf = trees[kind].insert(fat_boxes[id.index], id.index);
    }
    tree_of[body] = kind;
}

template <int D>
void WorldState<D>::mark_moved(std::uint32_t shape) {
    if (has_new_box[shape]) return;
    has_new_box[shape] = 1;
    moved_shapes.push_back(shape);
}

template <int D>
void WorldState<D>::insert_leaf(std::uint32_t shape) {
    ShapeRecord<D>& s = shapes[shape];
    fat_boxes[shape] = grown(bounds(s.shape, frame_of(s.body)), least_margin(s), Vec<D>{});
    s.leaf = Tree<D>::none;
    unplanted.push_back(shape);
    some_unplanted.store(true, std::memory_order_relaxed);
    mark_moved(shape);
}

/// Shapes come into the trees together, before anybody looks there: a tree that is built over many at once is
/// better, and far cheaper.
template <int D>
void WorldState<D>::plant() {
    if (unplanted.empty()) return;
    std::array<std::vector<typename Tree<D>::Entry>, 3> entries;
    for (const std::uint32_t shape : unplanted) {
        const bool is_gone = !shape_slots.in_use(shape) || shapes[shape].leaf != Tree<D>::none;
        if (is_gone) continue;  // or it came back and is listed twice
        shapes[shape].leaf = 0;
        entries[tree_of[shapes[shape].body]].push_back({fat_boxes[shape], shape});
    }
    unplanted.clear();
    std::vector<std::int32_t> leaves;
    for (std::size_t kind = 0; kind < trees.size(); ++kind) {
        leaves.resize(entries[kind].size());
        trees[kind].insert_all(entries[kind], leaves);
        for (std::size_t i = 0; i < leaves.size(); ++i) shapes[entries[kind][i].payload].leaf = leaves[i];
    }
    some_unplanted.store(false, std::memory_order_release);
}

/// Several threads may ask at once; the first of them plants.
template <int D>
void WorldState<D>::plant_for_queries() {
    if (!some_unplanted.load(std::memory_order_acquire)) return;
    const std::lock_guard lock(planting);
    plant();
}

template <int D>
void WorldState<D>::remove_leaf(std::uint32_t shape) {
    if (shapes[shape].leaf != Tree<D>::none) trees[tree_of[shapes[shape].body]].remove(shapes[shape].leaf);
    shapes[shape].leaf = Tree<D>::none;
}

template <int D>
void WorldState<D>::set_box(std::uint32_t shape, const Aabb<D>& box) {
    fat_boxes[shape] = box;
    trees[tree_of[shapes[shape].body]].move(shapes[shape].leaf, fat_boxes[shape]);
    mark_moved(shape);
}

/// Gives a fat box to every shape that may leave its own in this step.
template <int D>
void WorldState<D>::refresh_boxes(double dt) {
    moving_shapes.clear();
    new_leaves.clear();
    const double falling = length(definition.gravity) * dt * dt;
    for (const std::uint32_t body : awake) {
        const Transform<D> placed = frame_of(body);
        const Vec<D> way = states[body].velocity * dt;
        const double spin =
            std::sqrt(angular_dot(states[body].angular_velocity, states[body].angular_velocity));
        for (const ShapeId<D>& id : infos[body].shapes) {
            moving_shapes.push_back(id.index);
            const Shape<D>& shape = shapes[id.index].shape;
            const Aabb<D> tight = bounds(shape, placed);
            // A point that turns by an angle about the centre of mass, at the distance r from it, comes no
            // further than its arc, nor than 2 r. Of a ball only the middle counts.
            const bool is_ball = shape.kind == ShapeKind::ball;
            const double arm = is_ball ? length(shape.a - masses[body].center) : masses[body].radius;
            const double turning = std::min(spin * dt, 2.0) * arm;
            const double to_strike = least_margin(shapes[id.index]);
            const double bouncing = to_strike > 0 ? length(way) : 0;
            const Aabb<D> swept = grown(tight, turning + falling + bouncing, way);
            if (contains(fat_boxes[id.index], swept)) continue;
            const Vec<D> size = tight.upper - tight.lower;
            double smallest = size.x;
            for (int i = 1; i < D; ++i) smallest = std::min(smallest, size[i]);
            const double margin = std::max(std::min(box_margin, margin_share * smallest), to_strike);
            fat_boxes[id.index] = grown(swept, margin, Vec<D>{});
            mark_moved(id.index);
            new_leaves.push_back(shapes[id.index].leaf);
        }
    }
    Tree<D>& tree = trees[of_moving];
    const auto box_of = [&](std::uint32_t shape) -> const OuterBox<D>& { return fat_boxes[shape]; };
    if (10 * new_leaves.size() > static_cast<std::size_t>(tree.size())) {
        tree.move_all(new_leaves, box_of);
    } else {
        for (const std::int32_t leaf : new_leaves) tree.move(leaf, box_of(tree.payload(leaf)));
    }
}

/// Boxes are made to hold what a body will do in a step as far as its velocity tells. One that was struck may
/// have left its own since; it gets a new box, so that between steps every box holds its shape.
template <int D>
void WorldState<D>::keep_in_boxes(double dt) {
    const double falling = length(definition.gravity) * dt * dt;
    for (std::size_t k = 0; k < awake.size(); ++k) {
        const std::uint32_t body = awake[k];
        const BodyState<D>&from = before[k], &to = states[body];
        const Vec<D> way = from.velocity * dt, moved = to.position - from.position;
        const double turned = masses[body].radius * chord_between(from.rotation, to.rotation);
        bool as_foreseen = true;
        for (int i = 0; i < D; ++i) {
            as_foreseen &= moved[i] - turned >= std::min(way[i], 0.0) - falling &&
                           moved[i] + turned <= std::max(way[i], 0.0) + falling;
        }
        if (as_foreseen) continue;
        const Transform<D> placed = frame_of(body);
        for (const ShapeId<D>& id : infos[body].shapes) {
            const Aabb<D> tight = bounds(shapes[id.index].shape, placed);
            if (!contains(fat_boxes[id.index], tight)) set_box(id.index, tight);
        }
    }
}

#define CAROM_INSTANTIATE(D)                                           \
    template TreeKind WorldState<D>::tree_for(std::uint32_t) const;    \
    template void WorldState<D>::change_tree(std::uint32_t, TreeKind); \
    template void WorldState<D>::mark_moved(std::uint32_t);            \
    template void WorldState<D>::insert_leaf(std::uint32_t);           \
    template void WorldState<D>::remove_leaf(std::uint32_t);           \
    template void WorldState<D>::plant();                              \
    template void WorldState<D>::plant_for_queries();                  \
    template void WorldState<D>::refresh_boxes(double);                \
    template void WorldState<D>::keep_in_boxes(double);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
