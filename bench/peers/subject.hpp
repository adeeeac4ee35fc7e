#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "carom/world.hpp"
#include "engine.hpp"

/// What scenes and cases are built in: a world that hands on what it is told to the engine that is under
/// test. A Carom world beside it holds the definitions and is never stepped; what is read is read there, from
/// places and velocities of the engine, so that energies, coordinates and errors mean the same for all.
/// A world with something in it that the engine does not have says "not a number" to every question.
namespace carom::subject {

/// An engine: one of `engines()`. Null makers stand for dimensions that it does not have.
struct EngineKind {
    std::string_view name;
    std::unique_ptr<peers::Engine<2>> (*make_2)(const WorldDefinition<2>&) = nullptr;
    std::unique_ptr<peers::Engine<3>> (*make_3)(const WorldDefinition<3>&) = nullptr;
    bool is_carom = false;

    bool has(int dimension) const { return is_carom || (dimension == 2 ? bool(make_2) : bool(make_3)); }
};

/// Carom first.
std::span<const EngineKind> engines();
/// The engine of all worlds that are made from now on.
void put_to_the_test(const EngineKind& engine);

template <int D>
class World : private carom::World<D> {
    using Base = carom::World<D>;

  public:
    explicit World(const WorldDefinition<D>& definition = {});

    using Base::bodies;
    using Base::body_of;
    using Base::contains;
    using Base::definition;
    using Base::joint;
    using Base::joints;
    using Base::mass_properties;
    using Base::shape;
    using Base::shapes;
    using Base::type;

    void set_gravity(const Vec<D>& gravity);
    BodyId<D> add_body(const BodyDefinition<D>& definition);
    JointId<D> add_joint(const JointDefinition<D>& definition);
    ForceId<D> add_force(const ForceDefinition<D>& definition);
    void remove_body(BodyId<D> body);
    void set_velocity(BodyId<D> body, const Vec<D>& velocity);
    void apply_force(BodyId<D> body, const Vec<D>& force);
    void apply_torque(BodyId<D> body, const Angular<D>& torque);
    void put_to_sleep(BodyId<D> body);
    void step(double dt);

    double time() const { return engine_ ? time_ : Base::time(); }
    Transform<D> transform(BodyId<D> body) const { return told(seen().transform(body)); }
    Vec<D> position(BodyId<D> body) const { return told(seen().position(body)); }
    Rotation<D> rotation(BodyId<D> body) const { return told(seen().rotation(body)); }
    double angle(BodyId<D> body) const requires(D == 2) { return told(seen().angle(body)); }
    Vec<D> center_of_mass(BodyId<D> body) const { return told(seen().center_of_mass(body)); }
    Vec<D> velocity(BodyId<D> body) const { return told(seen().velocity(body)); }
    Angular<D> angular_velocity(BodyId<D> body) const { return told(seen().angular_velocity(body)); }
    double coordinate(JointId<D> joint) const { return told(seen().coordinate(joint)); }
    double coordinate_speed(JointId<D> joint) const { return told(seen().coordinate_speed(joint)); }
    double linear_error(JointId<D> joint) const { return told(seen().linear_error(joint)); }
    std::array<Vec<D>, 2> anchors(JointId<D> joint) const {
        const std::array<Vec<D>, 2> both = seen().anchors(joint);
        return {told(both[0]), told(both[1])};
    }
    Energy energy() const { return told(seen().energy()); }
    Energy energy(BodyId<D> body) const { return told(seen().energy(body)); }
    /// `awake` is what the engine says.
    Counts counts() const;
    /// Engines are not asked for the forces in their joints.
    Vec<D> joint_force(JointId<D> joint) const;

    /// Why the engine cannot do what was asked of it; empty where it can.
    const std::string& refusal() const { return refusal_; }
    /// The places of the engine, in a world of ours.
    const Base& seen() const;

  private:
    bool under_test() const { return engine_ && refusal_.empty(); }
    int index_of(BodyId<D> body) const { return numbers_[body.index]; }
    void attempt(const std::function<void()>& action);
    void push();
    void push(const ForceDefinition<D>& force);
    Vec<D> place_of(const std::optional<BodyId<D>>& body, const Vec<D>& anchor) const;
    Vec<D> velocity_of(const std::optional<BodyId<D>>& body, const Vec<D>& place) const;

    template <class T>
    T told(T value) const {
        if (!engine_ || (refusal_.empty() && !blown_up_)) return value;
        // What blew up is infinitely wrong; what could not be asked is not known.
        const double bad =
            blown_up_ ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
        if constexpr (std::is_same_v<T, double>)
            return bad;
        else if constexpr (std::is_same_v<T, Energy>)
            return {bad, 0};
        else if constexpr (std::is_same_v<T, Transform<D>>)
            return {told(value.position), told(value.rotation)};
        else if constexpr (std::is_same_v<T, Rotation2>)
            return {bad, bad};
        else if constexpr (std::is_same_v<T, Rotation3>)
            return {bad, bad, bad, bad};
        else {
            for (int i = 0; i < D; ++i) value[i] = bad;
            return value;
        }
    }

    std::unique_ptr<peers::Engine<D>> engine_;  ///< none where Carom itself is under test
    std::string refusal_;
    std::vector<int> numbers_;  ///< of bodies in the engine, by index
    std::vector<BodyId<D>> moving_;
    std::vector<ForceDefinition<D>> forces_;
    double time_ = 0;
    mutable bool seen_ = true, blown_up_ = false;
};

using World2 = World<2>;
using World3 = World<3>;

}  // namespace carom::subject
