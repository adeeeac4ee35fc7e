#pragma once

#include <memory>
#include <stdexcept>

#include "carom/world.hpp"

namespace carom::peers {

/// What an engine cannot be asked for.
struct Unsupported : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Where a body is (its frame), and how it moves (its centre of mass).
template <int D>
struct BodyState {
    Transform<D> placed{};
    Vec<D> velocity{};
    Angular<D> spin{};
};

/// Another physics engine, as far as scenes and cases need it. Bodies are numbered in the order in which they
/// were added, from 0. What an engine does not have it refuses with `Unsupported`.
template <int D>
class Engine {
  public:
    virtual ~Engine() = default;

    virtual void set_gravity(const Vec<D>& gravity) = 0;
    /// Mass properties are those that the definition gives, worked out.
    virtual void add_body(const BodyDefinition<D>& definition, const MassProperties<D>& mass) = 0;
    /// Joins body `b` to `a`, or to the world where `a` is negative.
    virtual void add_joint(const JointDefinition<D>& definition, int a, int b) = 0;
    virtual void set_velocity(int body, const Vec<D>& velocity, const Angular<D>& spin) = 0;
    /// Acts through the next step, at the centre of mass.
    virtual void apply_force(int body, const Vec<D>& force, const Angular<D>& torque) = 0;
    virtual void put_to_sleep(int body) = 0;
    virtual bool awake(int body) const = 0;
    virtual BodyState<D> state(int body) const = 0;
    virtual void step(double dt) = 0;
};

/// A friction or restitution of two shapes, as Carom combines them: engines whose rule is the product get the
/// roots.
inline double shared_friction(double a, double b) { return std::sqrt(a * b); }
inline double shared_restitution(double a, double b) { return a > b ? a : b; }

// Each engine with the settings with which it comes.
std::unique_ptr<Engine<2>> make_box2d(const WorldDefinition<2>& definition);
std::unique_ptr<Engine<2>> make_chipmunk(const WorldDefinition<2>& definition);
std::unique_ptr<Engine<3>> make_bullet(const WorldDefinition<3>& definition);
std::unique_ptr<Engine<3>> make_ode(const WorldDefinition<3>& definition);

}  // namespace carom::peers
