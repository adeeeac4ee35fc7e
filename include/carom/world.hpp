#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "carom/body.hpp"
#include "carom/collide.hpp"
#include "carom/events.hpp"
#include "carom/forces.hpp"
#include "carom/joints.hpp"
#include "carom/profile.hpp"
#include "carom/queries.hpp"
#include "carom/scheduler.hpp"
#include "carom/sleep.hpp"

namespace carom {

/// How a body that nothing touches moves through a step of length h. Bodies in contact always go through the
/// sub-stepped solver, whose positions are second order for steady forces.
enum class Integrator : std::uint8_t {
    semi_implicit_euler,  ///< v += h a, x += h v; exact (x += h v + ½ h² a) where only constant forces act
    explicit_euler,       ///< x += h v, v += h a: for lessons; gains energy
    verlet,               ///< velocity Verlet: second order, symplectic
    rk4,                  ///< classical Runge–Kutta: fourth order
};

/// How several impacts at once share their impulses.
enum class Impacts : std::uint8_t {
    simultaneous,  ///< together
    sequential,    ///< one after the other
};

/// The settings of a world.
template <int D>
struct WorldDefinition {
    Vec<D> gravity = [] {
        Vec<D> downward{};  // no name that a user's own constant may have
        downward.y = -9.81;
        return downward;
    }();               ///< m/s²
    int substeps = 4;  ///< 1 … 64 solver passes a step
    Integrator integrator = Integrator::semi_implicit_euler;
    Impacts impacts = Impacts::simultaneous;
    JointMethod joints = JointMethod::automatic;
    bool sleep = true;                 ///< bodies at rest may fall asleep
    bool continuous = true;            ///< fast bodies do not pass through fixed ones
    double restitution_threshold = 1;  ///< m/s: slower impacts do not bounce; not negative
    double hit_speed = 1;              ///< m/s: faster impacts are reported as hits; not negative
};

using WorldDefinition2 = WorldDefinition<2>;
using WorldDefinition3 = WorldDefinition<3>;

/// Where a body that moved in the last step is now.
template <int D>
struct MovedBody {
    BodyId<D> body{};
    std::uint64_t user_data = 0;
    Transform<D> transform{};  ///< of the body's frame
};

/// One point of a contact after the step.
template <int D>
struct ContactPoint {
    Vec<D> position{};      ///< m
    double separation = 0;  ///< m; negative where the shapes overlap
    double impulse = 0;     ///< normal impulse that the last step spent here, N·s
    std::uint32_t feature = 0;
};

/// Two shapes that touch after the step.
template <int D>
struct Contact {
    BodyId<D> body_a{}, body_b{};
    ShapeId<D> shape_a{}, shape_b{};
    Vec<D> normal{};            ///< from a towards b, unit
    Vec<D> friction_impulse{};  ///< on b, N·s
    std::array<ContactPoint<D>, Manifold<D>::capacity> points{};
    int count = 0;
};

/// Numbers of a world.
struct Counts {
    int bodies = 0, shapes = 0, forces = 0, joints = 0;
    int awake = 0;     ///< dynamic bodies that are awake
    int contacts = 0;  ///< pairs of shapes that touch or are about to
};

/// Kinetic energy, and potential energy in the world's uniform gravity, in point gravities, in springs and in
/// water; J. The zero of height is the origin, and of depth the surface of the water.
struct Energy {
    double kinetic = 0;
    double potential = 0;
    double total() const { return kinetic + potential; }
};

namespace detail {
template <int D>
struct WorldState;
}

/// A world of rigid bodies. Bodies are added and removed at any time between steps; `step` moves time on.
/// Every function that takes a handle throws `Error` when the handle names nothing, and every function that
/// takes a definition throws `Error` when that cannot be simulated; the world is then as before the call.
///
/// The result of a step depends on the calls alone: the same calls give the same bits on every machine.
/// The number of threads that steps use changes nothing either (see `set_scheduler`).
/// One world is used by one thread at a time; const functions may run on several at once.
template <int D>
class World {
  public:
    /// An empty world. Throws `Error` for settings that cannot be simulated.
    explicit World(const WorldDefinition<D>& definition = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// The settings; `set_gravity` wakes every body.
    const WorldDefinition<D>& definition() const;
    void set_gravity(const Vec<D>& gravity);
    /// Where steps do their work from now on: a pool (`make_thread_pool`), the game's own scheduler, or, as
    /// at first and with null, the thread that calls `step`. Worlds with little to do stay on that one
    /// anyway.
    void set_scheduler(std::shared_ptr<Scheduler> scheduler);
    /// Whether steps note what their stages take; off at first. It changes nothing but the time, by less than
    /// a microsecond a step.
    void set_profiling(bool on);
    /// What the last step took; empty unless it ran with profiling on. Good until the next step.
    const StepProfile& profile() const;

    /// Adds a body with its shapes.
    BodyId<D> add_body(const BodyDefinition<D>& definition);
    /// Adds many bodies that differ in their places alone, as `add_body` would one after the other with these
    /// in place of the definition's: faster, and if one place is refused none is added.
    std::vector<BodyId<D>> add_bodies(const BodyDefinition<D>& definition,
                                      std::span<const Transform<D>> places);
    /// Removes a body, its shapes, its joints, and the force generators that name it.
    void remove_body(BodyId<D> body);
    /// Puts one more shape on a body; its mass properties follow unless they were overridden.
    ShapeId<D> add_shape(BodyId<D> body, const ShapeDefinition<D>& definition);
    /// Takes a shape off its body.
    void remove_shape(ShapeId<D> shape);
    /// Makes the shape another one in its place; the handle stays, and so do impulses where the features are
    /// the same. Mass properties follow unless they were overridden.
    void set_shape(ShapeId<D> shape, const ShapeDefinition<D>& definition);
    /// Switches collision between two bodies off (`false`) or on again. Sensors notice them all the same.
    void set_collision(BodyId<D> a, BodyId<D> b, bool enabled);
    /// Adds a generator of forces.
    ForceId<D> add_force(const ForceDefinition<D>& definition);
    void remove_force(ForceId<D> force);

    /// Adds a joint between bodies as they stand. Unless it says `collide`, they do not touch each other as
    /// long as it is there.
    JointId<D> add_joint(const JointDefinition<D>& definition);
    /// Removes a joint, and the gears and racks that name it.
    void remove_joint(JointId<D> joint);
    /// Changes limits, motors, springs, length, friction and ratio to those of `kind`, which has to be of the
    /// joint's type; anchors and axes stay where they are.
    void set_joint(JointId<D> joint, const decltype(JointDefinition<D>::kind)& kind);
    /// The same for the motor (of a wheel: of its spin), the spring or the limits alone.
    void set_motor(JointId<D> joint, const std::optional<JointMotor>& motor);
    void set_spring(JointId<D> joint, const std::optional<JointSpring>& spring);
    void set_limits(JointId<D> joint, const std::optional<JointLimits>& limits);
    /// Steers a wheel. Only in 3D.
    void set_steering(JointId<D> joint, const std::optional<JointMotor>& steering) requires(D == 3);
    /// Moves the point to which a `TargetJoint` drags, in the world.
    void set_target(JointId<D> joint, const Vec<D>& target);

    /// Does the handle name something that is there?
    bool contains(BodyId<D> body) const;
    bool contains(ShapeId<D> shape) const;
    bool contains(ForceId<D> force) const;
    bool contains(JointId<D> joint) const;

    /// Moves time on by `dt` seconds (positive, at most 1).
    void step(double dt);
    /// Seconds of world time since the start.
    double time() const;
    /// Steps taken since the start.
    std::uint64_t steps() const;

    /// Placement of the body's frame.
    Transform<D> transform(BodyId<D> body) const;
    Vec<D> position(BodyId<D> body) const;
    Rotation<D> rotation(BodyId<D> body) const;
    /// Angle of a body in the plane, whole turns included, rad. Only in 2D.
    double angle(BodyId<D> body) const requires(D == 2);
    /// Centre of mass in the world, m.
    Vec<D> center_of_mass(BodyId<D> body) const;
    /// Velocity of the centre of mass, m/s.
    Vec<D> velocity(BodyId<D> body) const;
    Angular<D> angular_velocity(BodyId<D> body) const;
    /// Velocity of the body's material at a point of the world, m/s.
    Vec<D> velocity_at(BodyId<D> body, const Vec<D>& point) const;
    MassProperties<D> mass_properties(BodyId<D> body) const;
    BodyType type(BodyId<D> body) const;
    bool awake(BodyId<D> body) const;
    /// Why the body is awake, as of the last step. The answer takes time in proportion to the bodies that
    /// hang together with it and to the joints of the world.
    AwakeReason<D> awake_reason(BodyId<D> body) const;
    std::string_view name(BodyId<D> body) const;
    std::uint64_t user_data(BodyId<D> body) const;
    /// The shapes of a body, in the order in which they were added. Like all lists that a world shows, this
    /// one may be looked at until something is added, removed or stepped.
    std::span<const ShapeId<D>> shapes(BodyId<D> body) const;
    const ShapeDefinition<D>& shape(ShapeId<D> shape) const;
    BodyId<D> body_of(ShapeId<D> shape) const;
    /// All bodies, in the order of their places.
    std::span<const BodyId<D>> bodies() const;

    /// Places a body elsewhere at once and wakes what it touched. Its velocity stays.
    void set_transform(BodyId<D> body, const Transform<D>& transform);
    void set_velocity(BodyId<D> body, const Vec<D>& velocity);
    void set_angular_velocity(BodyId<D> body, const Angular<D>& angular_velocity);
    void set_type(BodyId<D> body, BodyType type);
    void set_gravity_scale(BodyId<D> body, double scale);
    void set_damping(BodyId<D> body, double linear, double angular);
    void set_locks(BodyId<D> body, const Locks& locks);
    /// Overrides what the shapes give.
    void set_mass_properties(BodyId<D> body, const MassProperties<D>& properties);
    void set_user_data(BodyId<D> body, std::uint64_t user_data);
    void wake(BodyId<D> body);
    void put_to_sleep(BodyId<D> body);

    /// Adds a force (N) that acts through the next step, at the centre of mass.
    void apply_force(BodyId<D> body, const Vec<D>& force);
    /// Adds a force at a point p of the world; its torque is (p − centre of mass) × force.
    void apply_force(BodyId<D> body, const Vec<D>& force, const Vec<D>& point);
    /// Adds a torque (N·m) that acts through the next step.
    void apply_torque(BodyId<D> body, const Angular<D>& torque);
    /// Changes the velocity at once by impulse / mass; with a point of the world also the spin.
    void apply_impulse(BodyId<D> body, const Vec<D>& impulse);
    void apply_impulse(BodyId<D> body, const Vec<D>& impulse, const Vec<D>& point);
    void apply_angular_impulse(BodyId<D> body, const Angular<D>& impulse);

    /// The bodies that moved in the last step, for a game that copies placements into its own objects.
    std::span<const MovedBody<D>> moved_bodies() const;
    /// The contacts of the last step that carry points, in a reproducible order.
    std::vector<Contact<D>> contacts() const;
    /// What began, ended and hit in the last step.
    std::span<const ContactBegin<D>> contact_begins() const;
    std::span<const ContactEnd<D>> contact_ends() const;
    std::span<const ContactHit<D>> contact_hits() const;
    std::span<const SensorBegin<D>> sensor_begins() const;
    std::span<const SensorEnd<D>> sensor_ends() const;
    /// The shapes that overlapped the sensor at the end of the last step, in the order of their places.
    std::vector<ShapeId<D>> inside(ShapeId<D> sensor) const;
    /// All joints, in the order in which they were added.
    std::span<const JointId<D>> joints() const;
    /// A joint as it was defined, with what was set since.
    const JointDefinition<D>& joint(JointId<D> joint) const;
    /// Its two anchors in the world; those of a gear or rack are the ones of its joints' bodies b.
    std::array<Vec<D>, 2> anchors(JointId<D> joint) const;
    /// Its coordinate (see the types): rad or m. Of a wheel the travel of the suspension.
    double coordinate(JointId<D> joint) const;
    /// The rate of that, rad/s or m/s.
    double coordinate_speed(JointId<D> joint) const;
    /// By how much the anchors, and the angles, differ from what the joint wants, m and rad. Springs want
    /// nothing.
    double linear_error(JointId<D> joint) const;
    double angular_error(JointId<D> joint) const;
    /// Force on b, and torque on b about its anchor, on the average of the last step, N and N·m. Of a pulley,
    /// gear or rack the tension, or the torque or force on body b of its second joint.
    Vec<D> joint_force(JointId<D> joint) const;
    Angular<D> joint_torque(JointId<D> joint) const;
    /// The joints that broke in the last step.
    std::span<const JointBreak<D>> joint_breaks() const;

    /// Bodies whose state turned non-finite in the last step: they were put back to their last finite state
    /// and disabled, and the rest goes on.
    std::span<const BodyId<D>> quarantined() const;

    // Queries see the bodies where they are now. They may run on several threads at once between steps. Where
    // two shapes are hit at the same time, the one with the lower index counts, so that answers depend on
    // what is in the world alone. Coordinates lie within ±1e100 m.

    /// The first shape that the ray meets (see `carom::cast_ray`).
    std::optional<WorldHit<D>> cast_ray(const Ray<D>& ray, const QueryFilter<D>& filter = {}) const;
    /// Every shape that the ray meets, where it enters it, in the order in which it does.
    std::vector<WorldHit<D>> cast_ray_all(const Ray<D>& ray, const QueryFilter<D>& filter = {}) const;
    /// Does the ray meet anything? The fastest of the three.
    bool cast_ray_any(const Ray<D>& ray, const QueryFilter<D>& filter = {}) const;
    /// Many rays at once, shared among as many threads as are asked for (1 … 256): `hits[i]` becomes the
    /// first hit of `rays[i]`. There must be as many `hits` as rays.
    void cast_rays(std::span<const Ray<D>> rays, std::span<std::optional<WorldHit<D>>> hits,
                   const QueryFilter<D>& filter = {}, int threads = 1) const;
    /// The first shape that `solid` touches on its straight way (see `carom::cast_shape`).
    std::optional<WorldHit<D>> cast_shape(const Solid<D>& solid, const Transform<D>& placed,
                                          const Vec<D>& translation, const QueryFilter<D>& filter = {}) const;
    /// Every shape that `solid` touches on its straight way, in the order in which it does.
    std::vector<WorldHit<D>> cast_shape_all(const Solid<D>& solid, const Transform<D>& placed,
                                            const Vec<D>& translation,
                                            const QueryFilter<D>& filter = {}) const;
    /// The shapes that overlap `solid`, by index.
    std::vector<ShapeId<D>> overlapping(const Solid<D>& solid, const Transform<D>& placed,
                                        const QueryFilter<D>& filter = {}) const;
    /// The shapes whose axis-aligned bounds overlap the box, by index.
    std::vector<ShapeId<D>> in_box(const Aabb<D>& box, const QueryFilter<D>& filter = {}) const;
    /// The shapes that hold the point, by index.
    std::vector<ShapeId<D>> at_point(const Vec<D>& point, const QueryFilter<D>& filter = {}) const;
    /// The point of any shape that is nearest to `point`, at most `max_distance` (m) away.
    std::optional<NearestPoint<D>> nearest_point(const Vec<D>& point, double max_distance,
                                                 const QueryFilter<D>& filter = {}) const;

    /// How many of everything there are.
    Counts counts() const;
    /// Energy of all dynamic bodies, J.
    Energy energy() const;
    /// Kinetic and gravitational energy of one body.
    Energy energy(BodyId<D> body) const;
    /// A hash of all that the next step depends on: equal hashes, equal futures.
    std::uint64_t hash() const;

  private:
    std::unique_ptr<detail::WorldState<D>> state_;
};

using World2 = World<2>;
using World3 = World<3>;

}  // namespace carom
