#pragma once

#include <cstdint>
#include <vector>

#include "carom/world.hpp"
#include "collision/tree.hpp"
#include "core/pair_set.hpp"
#include "core/slots.hpp"
#include "dynamics/body.hpp"
#include "dynamics/contact.hpp"
#include "dynamics/flight.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/islands.hpp"
#include "geometry/shape.hpp"
#include "solver/solver.hpp"

namespace carom::detail {

/// A shape that lives in the world.
template <int D>
struct ShapeRecord {
    Shape<D> shape;
    ShapeDefinition<D> definition;
    std::uint32_t body = 0;
    std::int32_t leaf = Tree<D>::none;  ///< in the tree of fixed or of moving things, by the body's type
    bool in_fixed_tree = false;
    bool moved = false;  ///< its fat box changed since pairs were last found
};

/// Everything that a world holds: arrays by index. The step reads and writes `states`, `masses`, `contacts`
/// and the trees; the rest is for the user.
template <int D>
struct WorldState {
    WorldDefinition<D> definition;
    double time = 0;
    double last_step = 0;
    std::uint64_t step_count = 0;

    // Bodies, by index.
    Slots body_slots;
    std::vector<BodyState<D>> states;
    std::vector<BodyMass<D>> masses;
    std::vector<BodyType> types;
    std::vector<BodyInfo<D>> infos;
    std::vector<Load<D>> applied;        ///< the user's forces for the next step
    std::vector<BodyId<D>> body_ids;     ///< all that are in use, oldest first
    std::vector<std::uint32_t> movable;  ///< indices of the dynamic and kinematic ones, oldest first

    // Shapes, by index.
    Slots shape_slots;
    std::vector<ShapeRecord<D>> shapes;
    Tree<D> fixed_tree, moving_tree;
    std::vector<std::uint32_t> moved_shapes;

    Forces<D> forces;

    PairSet pairs;
    std::vector<ContactRecord<D>> contacts;

    // Results of the last step.
    std::vector<MovedBody<D>> moved_bodies;
    std::vector<BodyId<D>> quarantined;

    // Working space of a step.
    std::vector<std::uint32_t> awake;   ///< indices of the awake dynamic bodies and the moving kinematic ones
    std::vector<std::uint8_t> moving;   ///< by body index: is it in `awake`?
    std::vector<std::uint32_t> active;  ///< indices of the contacts that the solver sees
    std::vector<std::uint32_t> flying;  ///< indices of the dynamic bodies that nothing touches
    std::vector<std::uint64_t> new_pairs;
    std::vector<Load<D>> loads;
    std::vector<std::uint8_t> varies;
    std::vector<std::uint8_t> touched;
    std::vector<BodyState<D>> before;  ///< states of `awake` at the start of the step
    std::vector<std::uint32_t> to_wake;
    Islands islands;
    Solver<D> solver;

    // step.cpp: the stages of a step, in the order of `step`.
    void step(double dt);
    void begin_step(double dt);
    void sum_forces();
    void solve_contacts(double dt);
    void fly_free_bodies(double dt);
    void move_kinematic_bodies(double dt);
    void finish_bodies();
    void quarantine(std::uint32_t body);

    // pairs.cpp: who is near whom.
    void refresh_boxes(double dt);
    void find_pairs();
    void drop_pairs();
    void insert_leaf(std::uint32_t shape);
    void remove_leaf(std::uint32_t shape);
    void mark_moved(std::uint32_t shape);
    bool may_collide(std::uint32_t shape_a, std::uint32_t shape_b) const;
    const Aabb<D>& fat_box(const ShapeRecord<D>& shape) const;

    // narrow_phase.cpp: who touches whom, and where.
    void collide(double dt);
    void update_contact(ContactRecord<D>& contact, double dt) const;
    void touch(ContactRecord<D>& contact, const BodyState<D>& a, const BodyState<D>& b, double reach) const;
    void meet_ahead(ContactRecord<D>& contact, double dt) const;

    // sleep.cpp
    void wake_touched(double dt);
    void wake_islands();
    void wake(std::uint32_t body);
    void wake_all();
    void wake_neighbours(std::uint32_t body);
    void fall_asleep(double dt);
    void join_islands();

    // queries.cpp: questions between steps.
    void keep_in_boxes(double dt);
    bool is_seen(std::uint32_t shape, const QueryFilter<D>& filter) const;
    Transform<D> placement_of(std::uint32_t shape) const { return frame_of(shapes[shape].body); }
    WorldHit<D> named(std::uint32_t shape, const CastHit<D>& hit) const;
    template <class Visitor>
    void cast_through_trees(const Vec<D>& origin, const Vec<D>& translation, const Vec<D>& half,
                            Visitor&& visit) const;
    template <class Test>
    std::vector<ShapeId<D>> shapes_in(const Aabb<D>& box, const QueryFilter<D>& filter,
                                      const Test& test) const;

    // mass.cpp
    void update_mass(std::uint32_t body);

    bool is_awake(std::uint32_t body) const { return infos[body].awake && !infos[body].disabled; }
    /// Is the body awake and free to move, or moved by the user?
    bool is_moving(std::uint32_t body) const {
        if (types[body] == BodyType::dynamic) return is_awake(body);
        return types[body] == BodyType::kinematic &&
               (states[body].velocity != Vec<D>{} || states[body].angular_velocity != Angular<D>{});
    }
    /// The index behind a handle; throws `Error` when it names nothing.
    std::uint32_t index(BodyId<D> body) const;
    std::uint32_t index(ShapeId<D> shape) const;
    Transform<D> frame_of(std::uint32_t body) const { return frame(states[body], masses[body]); }
    void remove_contacts_of(std::uint32_t body);
    void remove_contact(std::size_t contact);
};

/// Velocity of a body below which, and way within `time_to_sleep` less than which, it counts as at rest.
constexpr double sleep_speed = 0.05;   // m/s
constexpr double sleep_way = 0.001;    // m
constexpr double time_to_sleep = 0.5;  // s

}  // namespace carom::detail
