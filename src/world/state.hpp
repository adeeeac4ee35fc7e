#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "carom/world.hpp"
#include "collision/sweep.hpp"
#include "collision/tree.hpp"
#include "core/adjacency.hpp"
#include "core/column.hpp"
#include "core/crew.hpp"
#include "core/gathered.hpp"
#include "core/pair_set.hpp"
#include "core/profiler.hpp"
#include "core/slots.hpp"
#include "dynamics/body.hpp"
#include "dynamics/contact.hpp"
#include "dynamics/contact_cache.hpp"
#include "dynamics/flight.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/joint.hpp"
#include "dynamics/solids.hpp"
#include "geometry/shape.hpp"
#include "solver/apart_store.hpp"
#include "solver/joint_load.hpp"
#include "solver/solver.hpp"
#include "world/records.hpp"

namespace carom::detail {

/// Everything that a world holds: arrays by index. The step reads and writes `states`, `masses`, `contacts`
/// and the trees; the rest is for the user.
template <int D>
struct WorldState {
    WorldDefinition<D> definition;
    std::shared_ptr<Scheduler> scheduler;  ///< or none: then all is done by the calling thread
    std::optional<Profiler> profiler;      ///< if the user wants to know what steps take
    double time = 0;
    double last_step = 0;
    std::uint64_t step_count = 0;

    // Bodies, by index.
    Slots body_slots;
    std::vector<BodyState<D>> states;
    std::vector<BodyMass<D>> masses;
    std::vector<BodyType> types;
    std::vector<BodyInfo<D>> infos;
    Column<Load<D>> applied;                ///< the user's forces for the next step
    std::vector<std::uint32_t> applied_to;  ///< the bodies that have some, among others
    std::vector<std::uint32_t>
        only_shape;                   ///< index of the shape of a body that has one alone, or `no_shape`
    std::vector<BodyId<D>> body_ids;  ///< all that are in use, oldest first
    Blueprint<D> blueprint;
    std::vector<std::uint32_t> movable;  ///< indices of the dynamic and kinematic ones, oldest first

    // Shapes, by index.
    Slots shape_slots;
    std::vector<ShapeRecord<D>> shapes;
    std::vector<Company> company;        ///< by shape
    Column<Extent<D>> extents;           ///< by shape, of those that move
    std::array<Tree<D>, 3> trees;        ///< of shapes, by `TreeKind`
    Column<TreeKind> tree_of;            ///< by body: where its shapes are
    std::vector<OuterBox<D>> fat_boxes;  ///< by shape
    std::vector<OuterBox<D>> met_boxes;  ///< by shape: the fat box of when pairs were last found, or `no_box`
                                         ///< if it is not known to have all pairs of then
    std::vector<std::uint8_t> has_new_box;     ///< by shape: bits of `BoxNews` since pairs were last found
    std::vector<std::uint8_t> renewed;         ///< by place in `awake`: has any of its shapes a new box?
    std::vector<std::uint32_t> moved_shapes;   ///< those that have one
    std::vector<std::uint32_t> moving_shapes;  ///< those of the bodies that move in this step
    std::vector<std::int32_t> new_leaves;      ///< leaves of moving shapes whose boxes are newer
    std::atomic<bool> some_leaves_are_old = false;  ///< in the tree of what moves
    double cost_when_built = 0;                     ///< of that tree
    std::vector<std::uint32_t> unplanted;           ///< shapes that are in no tree yet
    std::atomic<bool> some_unplanted = false;
    std::mutex planting;
    Sweep<D> crowd;
    Gathered<std::uint32_t> parting;  ///< contacts whose boxes parted
    Gathered<PairKey> meeting;        ///< shapes that trees found near one another

    Forces<D> forces;

    // Joints, by index.
    Slots joint_slots;
    std::vector<JointRecord<D>> joints;
    std::vector<JointDefinition<D>> joint_definitions;
    Adjacency bonds;                           ///< the joints by body
    std::vector<JointId<D>> joint_ids;         ///< all that are in use, oldest first
    std::vector<CouplingRecord<D>> couplings;  ///< of the joints that couple others, oldest first

    PairSet pairs;
    std::vector<ContactRecord<D>> contacts;
    std::vector<ContactCache<D>> caches;      ///< by contact: where its points were found
    Adjacency contact_links;                  ///< contacts between `contact_list`s of shapes
    std::vector<std::uint32_t> loose;         ///< contacts that are looked at one by one, or `nowhere`
    LaneShapes<D> lane_shapes;                ///< shapes of contacts that are collided in lanes
    ApartStore<D> apart;                      ///< contacts that are known not to touch
    Column<std::uint32_t> fixed_contacts_of;  ///< by body: how many contacts it has with fixed shapes
    std::vector<SensorPair> sensor_pairs;
    Adjacency sensor_links;                  ///< sensor pairs between shapes
    std::vector<std::uint32_t> placed_anew;  ///< shapes that have sensor pairs which are so
    std::uint32_t bullets = 0;               ///< how many bodies are

    // Results of the last step.
    std::vector<MovedBody<D>> moved_bodies;
    std::vector<BodyId<D>> quarantined;
    EventBuffers<D> events;
    std::vector<ContactEnd<D>>
        dropped_contacts;  ///< that touched when they were dropped, since events were last reported
    std::vector<SensorEnd<D>> dropped_visits;
    PairSet terrain_touched;                    ///< a shape and a terrain that touch by some of its facets
    std::vector<ShapePair<D>> terrain_changes;  ///< such pairs of which a facet began or ended to touch

    // Working space of a step.
    std::vector<std::uint32_t> awake;   ///< the awake dynamic bodies and the moving kinematic ones, by index
    std::vector<std::uint32_t> roused;  ///< bodies that may belong to `awake` by now
    Column<std::uint8_t> moving;        ///< by body index: how it moves in this step
    bool some_locked = false;           ///< has any body ever had a locked axis?
    std::vector<std::uint32_t> regrouped;         ///< bodies that got their second contact with a fixed shape
    std::vector<std::uint32_t> to_place;          ///< contacts that the solver is to take up
    std::vector<std::uint32_t> touch_changes;     ///< contacts that began or ended to touch
    std::vector<std::uint32_t> fast;              ///< bodies that came so far in this step that they may pass
                                                  ///< through something
    std::vector<std::uint32_t> flying;            ///< indices of the dynamic bodies that nothing touches
    std::vector<std::uint32_t> active_joints;     ///< indices of the joints that the solver sees
    std::vector<std::uint32_t> active_couplings;  ///< the same in `couplings`
    std::vector<std::uint32_t> breakable_joints;  ///< those of both that may break, by index
    std::vector<std::uint32_t> path_joints;       ///< those whose place changes with the bodies, by index
    bool joints_are_listed = false;               ///< in these four, as they are now
    std::vector<PairKey> new_pairs;
    Column<Load<D>> loads;
    Column<std::uint8_t> varies;
    std::vector<BodyState<D>> before;    ///< states of `awake` at the start of the step
    std::vector<std::uint8_t> outcomes;  ///< by place in `awake`: of this step, bits of `Outcome`
    Column<std::uint32_t> place;         ///< in `awake` and `before`, by body index, of those that are there
    std::vector<FixedContact> fixed_contacts;      ///< of some bodies, by body, shape and fixed shape
    std::vector<ContactRecord<D>> patches_before;  ///< of shapes that have several, in the last step
    std::vector<std::uint32_t> patch_members;      ///< contacts that lie in one plane
    std::vector<ManifoldPoint<D>> patch_points;
    std::vector<std::uint32_t> to_wake;
    std::vector<Rest> rest;             ///< by place in `awake`
    std::vector<std::uint32_t> island;  ///< bodies that hang together
    std::vector<std::uint32_t> picked;  ///< contacts or sensor pairs that are to be removed, or worked on
    Solver<D> solver;

    // step.cpp: the stages of a step, in the order of `step`.
    void step(double dt);
    void count_work(StepProfile& profile) const;
    void begin_step(double dt);
    void list_moving();
    void list_awake(std::uint32_t body);
    bool keep_states(std::size_t from);
    void sum_forces(double dt);
    void solve_constraints(double dt);
    void fly_free_bodies(double dt);
    void move_kinematic_bodies(double dt);
    void judge_ways(double dt);
    void finish_bodies();
    void quarantine(std::uint32_t body);

    // boxes.cpp: where the shapes are.
    void measure_extents(std::uint32_t body);
    bool is_in_box(std::uint32_t shape, const Vec<D>& way, double turning, double further) const;
    bool renew_boxes(std::uint32_t body, double dt, double falling);
    void refresh_boxes(double dt);
    bool is_as_foreseen(std::size_t place_in_awake, double turned, double dt) const;
    void keep_in_boxes();
    TreeKind tree_for(std::uint32_t body) const;
    void change_tree(std::uint32_t body, TreeKind kind);
    void insert_leaf(std::uint32_t shape);
    void remove_leaf(std::uint32_t shape);
    void set_box(std::uint32_t shape, const Aabb<D>& box);
    void plant(Scheduler* workers);
    void refresh_tree();
    void prepare_trees_for_queries();
    void mark_moved(std::uint32_t shape);
    void meet_anew(std::uint32_t shape);

    // pairs.cpp: who is near whom.
    void drop_pairs();
    void list_parting();
    void ask_trees(bool crowded);
    void find_pairs();
    void take_up_pairs();
    void meet(std::uint32_t shape_a, std::uint32_t shape_b);
    bool may_meet(std::uint32_t shape_a, std::uint32_t shape_b) const;
    void find_facets(std::uint32_t shape_a, std::uint32_t shape_b);
    bool are_near(std::uint32_t contact, std::uint32_t shape_a, std::uint32_t shape_b) const;
    void set_surface(ContactRecord<D>& contact) const;

    // contacts.cpp: what is done about each contact, and where it is kept.
    void add_contact(const PairKey& key);
    void part_from_others();
    void remove_contact(std::size_t contact);
    void remove_picked_contacts();
    void remove_contacts_of(std::uint32_t body);
    void remove_contacts_between(std::uint32_t body, std::uint32_t other);
    void remove_contacts_of_shape(std::uint32_t shape);
    void forget_manifolds_of(std::uint32_t body);
    void loosen(std::uint32_t contact);
    void stop_carrying(std::uint32_t contact);
    void leave_solver(std::uint32_t contact);
    void take_loose();
    void follow_bodies();
    std::optional<Carrying<D>> carrying(std::uint32_t contact);
    bool stays_apart(std::uint32_t contact);
    LanePair<D> lane_pair(const ContactRecord<D>& contact);
    void leave_apart(std::uint32_t contact);
    void place_contacts();
    ContactRecord<D> current(std::uint32_t contact) const;
    ContactRecord<D> current(std::uint32_t contact, ContactCache<D>& cache) const;
    std::uint32_t mover(const ContactRecord<D>& contact) const;

    // narrow_phase.cpp: who touches whom, and where.
    void collide(double dt);
    void update_contact(ContactRecord<D>& contact, ContactCache<D>& cache, double dt) const;
    bool may_be_struck(const ContactRecord<D>& contact) const;
    void meet_struck(ContactRecord<D>& contact, ContactCache<D>& cache, double reach, double dt) const;
    void touch(const ContactRecord<D>& contact, const BodyState<D>& a, const BodyState<D>& b, double reach,
               ContactCache<D>& cache) const;
    void set_points(const ContactCache<D>& cache, const BodyState<D>& a, const BodyState<D>& b, double reach,
                    ContactRecord<D>& contact) const;

    // continuous.cpp: what is fast.
    void meet_ahead(ContactRecord<D>& contact, const ContactCache<D>& cache, double dt) const;
    void list_fast_contacts();
    void list_strays(std::uint32_t body);
    void stop_at_obstacles();
    void stop_bullets();
    void stop_at(std::uint32_t body, std::uint32_t shape, std::uint32_t other, std::uint32_t facet);

    // patches.cpp: flush fixed shapes are one surface.
    void list_patches();
    void list_fixed_contact(std::uint32_t contact);
    void list_fixed_contacts(std::span<const std::uint32_t> bodies);
    void sort_fixed_contacts(std::size_t first);
    template <class Visit>
    void each_fixed_group(const Visit& visit) const;
    void merge_patches();
    void merge_group(std::span<const FixedContact> group, std::span<const ContactRecord<D>> before_step);
    void merge_members(std::uint32_t body, std::span<const ContactRecord<D>> before_step);

    // surfaces.cpp: what is particular about the surfaces that touch.
    void lay_on_fixed_face(Manifold<D>& manifold, const ContactRecord<D>& contact,
                           const Transform<D>& b_in_a) const;
    bool is_artefact_of_seam(const ContactRecord<D>& contact, const BodyState<D>& a, const BodyState<D>& b,
                             const Vec<D>& middle, double separation) const;
    Rotation<D> axes_of(std::uint32_t shape) const;
    void pass_one_way(ContactRecord<D>& contact, bool was_near) const;
    void drag_along(ContactRecord<D>& contact) const;

    // events.cpp: what began, ended and hit.
    void report_contacts();
    void report_terrain();
    std::uint32_t first_touching_facet(const ShapePair<D>& pair) const;
    void report_begin(const ContactRecord<D>& contact);
    void sense();
    bool overlap(std::uint32_t shape_a, std::uint32_t shape_b) const;
    ShapePair<D> names(std::uint32_t shape_a, std::uint32_t shape_b) const;

    // sleep.cpp
    void wake_touched(double dt);
    void wake_islands();
    void wake(std::uint32_t body);
    void wake_all();
    void wake_neighbours(std::uint32_t body);
    void fall_asleep(double dt);
    bool note_rest(std::uint32_t body, double dt);
    bool gather_resting(std::uint32_t body);
    template <class Visit>
    void each_tied(std::uint32_t body, const Visit& visit) const;

    // joints.cpp: what binds bodies.
    void expect_other_joints();
    void list_active_joints();
    void follow_paths(double dt);
    void follow(JointRecord<D>& joint, double dt) const;
    void wake_jointed();
    void break_joints(double dt);
    void remove_joint(std::uint32_t joint);
    void remove_joints_of(std::uint32_t body);
    std::uint32_t index(JointId<D> joint) const;
    const CouplingRecord<D>* coupling_of(std::uint32_t joint) const;
    JointPose<D> joint_pose(std::uint32_t joint) const { return pose_of<D>(joints[joint], states, masses); }
    Load<D> joint_load(std::uint32_t joint, double dt) const;

    // queries.cpp: questions between steps.
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

    /// May anything change between the two bodies in this step?
    bool any_moves(std::uint32_t body_a, std::uint32_t body_b) const {
        return moving[body_a] != stands_still || moving[body_b] != stands_still;
    }
    bool is_awake(std::uint32_t body) const { return infos[body].awake && !infos[body].disabled; }
    /// Is the body awake and free to move, or moved by the user?
    bool is_moving(std::uint32_t body) const {
        if (types[body] == BodyType::dynamic) return is_awake(body);
        return types[body] == BodyType::kinematic &&
               (states[body].velocity != Vec<D>{} || states[body].angular_velocity != Angular<D>{});
    }
    /// Calls `visit(shape)` for each shape of the body.
    template <class Visit>
    void each_shape_of(std::uint32_t body, const Visit& visit) const {
        if (only_shape[body] != no_shape) return visit(only_shape[body]);
        for (const ShapeId<D>& id : infos[body].shapes) visit(id.index);
    }
    static constexpr std::uint32_t no_shape = ~std::uint32_t{0};
    /// Runs `work(begin, end)` over the places of `awake`, a stretch a worker.
    template <class Work>
    void each_awake(Work&& work) {
        constexpr std::size_t worth_a_worker = 512;
        run_range(scheduler.get(), awake.size(), worth_a_worker, work);
    }
    /// The index behind a handle; throws `Error` when it names nothing.
    std::uint32_t index(BodyId<D> body) const;
    std::uint32_t index(ShapeId<D> shape) const;
    Transform<D> frame_of(std::uint32_t body) const { return frame(states[body], masses[body]); }
    Solids<D> solids() const { return {infos, shapes}; }
    /// A shape has its contacts in two lists: those of which one body is fixed, and the others.
    static std::uint32_t contact_list(std::uint32_t shape, bool on_fixed) { return 2 * shape + on_fixed; }
    static std::uint32_t shape_of_list(std::uint32_t list) { return list / 2; }
    /// Calls `visit(contact)` for each contact of the shape, or of the body that is or is not with a fixed
    /// one.
    template <class Visit>
    void each_contact_of_shape(std::uint32_t shape, const Visit& visit) const {
        for (const bool on_fixed : {false, true}) {
            contact_links.each(contact_list(shape, on_fixed),
                               [&](std::uint32_t contact, std::uint32_t) { visit(contact); });
        }
    }
    template <class Visit>
    void each_contact_of(std::uint32_t body, const Visit& visit) const {
        for (const ShapeId<D>& id : infos[body].shapes) each_contact_of_shape(id.index, visit);
    }
    template <class Visit>
    void each_contact_of(std::uint32_t body, bool on_fixed, const Visit& visit) const {
        for (const ShapeId<D>& id : infos[body].shapes) {
            contact_links.each(contact_list(id.index, on_fixed),
                               [&](std::uint32_t contact, std::uint32_t) { visit(contact); });
        }
    }
    void remove_visit(std::size_t sensor_pair);
    void remove_picked_visits();
    void remove_visits_of(std::uint32_t shape);
    void place_visits_anew(std::uint32_t shape);
};

/// The box of a shape that comes into a world, on a body whose frame is at `placed`.
template <int D>
Aabb<D> first_box(const ShapeModel<D>& model, const Transform<D>& placed);

/// Velocity of a body below which, and way within `time_to_sleep` less than which, it counts as at rest.
constexpr double sleep_speed = 0.05;   // m/s
constexpr double sleep_way = 0.001;    // m
constexpr double time_to_sleep = 0.5;  // s

}  // namespace carom::detail
