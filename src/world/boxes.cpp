#include <algorithm>
#include <cmath>

#include "core/room.hpp"
#include "geometry/turned_box.hpp"
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
double least_margin(const ShapeModel<D>& model) {
    return model.definition.material.restitution >= lively_restitution ? 0.5 * speculative_distance : 0;
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
    if (!has_new_box[shape]) moved_shapes.push_back(shape);
    has_new_box[shape] |= is_new;
}

/// All that is near the shape counts as if it had just come there: what it is, or with whom it may be a pair,
/// changed.
template <int D>
void WorldState<D>::meet_anew(std::uint32_t shape) {
    mark_moved(shape);
    has_new_box[shape] |= meets_anew;
}

template <int D>
Aabb<D> first_box(const ShapeModel<D>& model, const Transform<D>& placed) {
    return grown(bounds(model.shape, placed), least_margin(model), Vec<D>{});
}

template <int D>
void WorldState<D>::insert_leaf(std::uint32_t shape) {
    ShapeRecord<D>& s = shapes[shape];
    fat_boxes[shape] = first_box(*s.model, frame_of(s.body));
    s.leaf = Tree<D>::none;
    unplanted.push_back(shape);
    some_unplanted.store(true, std::memory_order_relaxed);
    meet_anew(shape);
}

/// Shapes come into the trees together, before anybody looks there: a tree that is built over many at once is
/// better, and far cheaper.
template <int D>
void WorldState<D>::plant(Scheduler* workers) {
    if (unplanted.empty()) return;
    std::array<std::vector<typename Tree<D>::Entry>, 3> entries;
    const std::uint32_t first = shapes[unplanted.front()].body;
    make_room(entries[tree_of[first]], unplanted.size());  // which are often all of a kind
    for (const std::uint32_t shape : unplanted) {
        const bool is_gone = !shape_slots.in_use(shape) || shapes[shape].leaf != Tree<D>::none;
        if (is_gone) continue;  // or it came back and is listed twice
        shapes[shape].leaf = 0;
        entries[tree_of[shapes[shape].body]].push_back({fat_boxes[shape], shape});
    }
    unplanted.clear();
    std::vector<std::int32_t> leaves;
    for (std::size_t kind = 0; kind < trees.size(); ++kind) {
        leaves.clear();
        make_room(leaves, entries[kind].size());
        leaves.resize(entries[kind].size());
        trees[kind].insert_all(entries[kind], leaves, workers);
        for (std::size_t i = 0; i < leaves.size(); ++i) shapes[entries[kind][i].payload].leaf = leaves[i];
    }
    some_unplanted.store(false, std::memory_order_release);
}

/// Brings the tree of what moves up to date with the boxes. A crowd finds its pairs without it, so this waits
/// until somebody asks.
template <int D>
void WorldState<D>::refresh_tree() {
    if (!some_leaves_are_old.load(std::memory_order_relaxed)) return;
    Tree<D>& tree = trees[of_moving];
    const auto box_of = [&](std::uint32_t shape) -> const OuterBox<D>& { return fat_boxes[shape]; };
    new_leaves.clear();
    tree.each_leaf([&](std::int32_t leaf) {
        if (!(tree.box(leaf) == box_of(tree.payload(leaf)))) new_leaves.push_back(leaf);
    });
    if (10 * new_leaves.size() > static_cast<std::size_t>(tree.size())) {
        tree.move_all(new_leaves, box_of);
        // In a crowd that tumbles neighbours do not stay neighbours.
        constexpr double most_growth = 1.5;
        const double cost = tree.cost();
        if (cost > most_growth * cost_when_built) {
            tree.rebuild();
            cost_when_built = tree.cost();
        }
    } else {
        for (const std::int32_t leaf : new_leaves) tree.move(leaf, box_of(tree.payload(leaf)));
    }
    some_leaves_are_old.store(false, std::memory_order_release);
}

/// Several threads may ask at once; the first of them does the work.
template <int D>
void WorldState<D>::prepare_trees_for_queries() {
    if (!some_unplanted.load(std::memory_order_acquire) &&
        !some_leaves_are_old.load(std::memory_order_acquire))
        return;
    const std::lock_guard lock(planting);
    plant(nullptr);
    refresh_tree();
}

template <int D>
void WorldState<D>::remove_leaf(std::uint32_t shape) {
    if (shapes[shape].leaf != Tree<D>::none) trees[tree_of[shapes[shape].body]].remove(shapes[shape].leaf);
    shapes[shape].leaf = Tree<D>::none;
}

template <int D>
void WorldState<D>::set_box(std::uint32_t shape, const Aabb<D>& box) {
    fat_boxes[shape] = box;
    mark_moved(shape);
    some_leaves_are_old.store(true, std::memory_order_relaxed);
}

/// Takes down what is asked of the shapes of the body in each step, so that it lies close together.
template <int D>
void WorldState<D>::measure_extents(std::uint32_t body) {
    const ShortList<ShapeId<D>>& ids = infos[body].shapes;
    only_shape[body] = ids.size() == 1 ? ids[0].index : no_shape;
    if (types[body] == BodyType::fixed) return;
    for (const ShapeId<D>& id : ids) {
        const Shape<D>& shape = shapes[id.index].shape();
        const Aabb<D> box = bounds(shape, Transform<D>{});
        Extent<D>& extent = extents[id.index];
        extent.radius = core_radius(shape);
        extent.middle = 0.5 * (box.lower + box.upper) - masses[body].center;
        for (int i = 0; i < D; ++i)
            extent.half[i] = std::max(0.0, 0.5 * (box.upper[i] - box.lower[i]) - extent.radius);
        // A point that turns by an angle about the centre of mass, at the distance r from it, comes no
        // further than its arc, nor than 2 r. Of a ball only the middle counts.
        const bool is_ball = shape.kind == ShapeKind::ball;
        extent.arm = is_ball ? length(shape.a - masses[body].center) : masses[body].radius;
        extent.to_strike = least_margin(*shapes[id.index].model);
    }
}

/// Is the shape sure to stay in its fat box? As the box of an extent tells, which for some shapes is larger
/// than their own, and so is often enough to know.
template <int D>
bool WorldState<D>::is_in_box(std::uint32_t shape, const Vec<D>& way, double turning, double further) const {
    constexpr double rounding = 1e-12;
    const Extent<D>& extent = extents[shape];
    const BodyState<D>& s = states[company[shape].body];
    const Vec<D> middle = s.position + rotate(s.rotation, extent.middle),
                 reach = reach_of(s.rotation, extent.half);
    const OuterBox<D>& box = fat_boxes[shape];
    bool inside = true;
    for (int i = 0; i < D; ++i) {
        const double most = reach[i] + extent.radius + turning * extent.arm + further;
        const double with_rounding = most + rounding * (std::fabs(middle[i]) + most);
        inside &= box.lower[i] <= middle[i] - with_rounding + std::min(way[i], 0.0) &&
                  middle[i] + with_rounding + std::max(way[i], 0.0) <= box.upper[i];
    }
    return inside;
}

/// Gives fat boxes to the shapes of the body that may leave their own in this step. Returns whether there are
/// any; they are marked by `renewed_now`.
template <int D>
bool WorldState<D>::renew_boxes(std::uint32_t body, double dt, double falling) {
    const BodyState<D>& s = states[body];
    const Vec<D> way = s.velocity * dt;
    const double turning = std::min(std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity)) * dt, 2.0);
    bool any = false;
    each_shape_of(body, [&](std::uint32_t shape) {
        const Extent<D>& extent = extents[shape];
        const double bouncing = extent.to_strike > 0 ? length(way) : 0;
        if (is_in_box(shape, way, turning, falling + bouncing)) return;
        const Aabb<D> tight = bounds(shapes[shape].shape(), frame_of(body));
        const Aabb<D> swept = grown(tight, turning * extent.arm + falling + bouncing, way);
        if (contains(fat_boxes[shape], swept)) return;
        const Vec<D> size = tight.upper - tight.lower;
        double smallest = size.x;
        for (int i = 1; i < D; ++i) smallest = std::min(smallest, size[i]);
        const double margin = std::max(std::min(box_margin, margin_share * smallest), extent.to_strike);
        fat_boxes[shape] = grown(swept, margin, Vec<D>{});
        has_new_box[shape] |= renewed_now;
        any = true;
    });
    return any;
}

/// Gives a fat box to every shape that may leave its own in this step.
template <int D>
void WorldState<D>::refresh_boxes(double dt) {
    const double falling = length(definition.gravity) * dt * dt;
    renewed.resize(awake.size());
    each_awake([&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) renewed[k] = renew_boxes(awake[k], dt, falling);
    });
    moving_shapes.clear();
    for (std::size_t k = 0; k < awake.size(); ++k) {
        each_shape_of(awake[k], [&](std::uint32_t shape) {
            moving_shapes.push_back(shape);
            if (!renewed[k] || !(has_new_box[shape] & renewed_now)) return;
            has_new_box[shape] &= static_cast<std::uint8_t>(~renewed_now);
            mark_moved(shape);
            some_leaves_are_old.store(true, std::memory_order_relaxed);
        });
    }
}

/// Has the body come no further in this step than its velocity at the start told? `turned` is how far its
/// outermost point came by its turn.
template <int D>
bool WorldState<D>::is_as_foreseen(std::size_t place_in_awake, double turned, double dt) const {
    const double falling = length(definition.gravity) * dt * dt;
    const BodyState<D>&from = before[place_in_awake], &to = states[awake[place_in_awake]];
    const Vec<D> way = from.velocity * dt, moved = to.position - from.position;
    bool as_foreseen = true;
    for (int i = 0; i < D; ++i) {
        as_foreseen &= moved[i] - turned >= std::min(way[i], 0.0) - falling &&
                       moved[i] + turned <= std::max(way[i], 0.0) + falling;
    }
    return as_foreseen;
}

/// Boxes are made to hold what a body will do in a step as far as its velocity tells. One that was struck may
/// have left its own since; it gets a new box, so that between steps every box holds its shape.
template <int D>
void WorldState<D>::keep_in_boxes() {
    for (std::size_t k = 0; k < awake.size(); ++k) {
        if (!(outcomes[k] & (went_astray | was_stopped))) continue;
        const Transform<D> placed = frame_of(awake[k]);
        each_shape_of(awake[k], [&](std::uint32_t shape) {
            const Aabb<D> tight = bounds(shapes[shape].shape(), placed);
            if (!contains(fat_boxes[shape], tight)) set_box(shape, tight);
        });
    }
}

#define CAROM_INSTANTIATE(D)                                                        \
    template TreeKind WorldState<D>::tree_for(std::uint32_t) const;                 \
    template void WorldState<D>::change_tree(std::uint32_t, TreeKind);              \
    template void WorldState<D>::mark_moved(std::uint32_t);                         \
    template Aabb<D> first_box(const ShapeModel<D>&, const Transform<D>&);          \
    template void WorldState<D>::insert_leaf(std::uint32_t);                        \
    template void WorldState<D>::remove_leaf(std::uint32_t);                        \
    template void WorldState<D>::plant(Scheduler*);                                 \
    template void WorldState<D>::meet_anew(std::uint32_t);                          \
    template void WorldState<D>::refresh_tree();                                    \
    template void WorldState<D>::prepare_trees_for_queries();                       \
    template void WorldState<D>::refresh_boxes(double);                             \
    template void WorldState<D>::measure_extents(std::uint32_t);                    \
    template bool WorldState<D>::is_as_foreseen(std::size_t, double, double) const; \
    template void WorldState<D>::keep_in_boxes();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
