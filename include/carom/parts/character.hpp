#pragma once

#include <optional>

#include "carom/world.hpp"

namespace carom {

/// How a character is built and what it can do.
template <int D>
struct CharacterDefinition {
    Vec<D> position{};  ///< of its lowest point, m
    Vec<D> up = [] {
        Vec<D> y{};
        y.y = 1;
        return y;
    }();                  ///< any length but zero
    double height = 1.8;  ///< m, more than twice the radius
    double radius = 0.3;  ///< m, positive
    double max_slope =
        0.8;  ///< rad, 0 … π/2: it stands and walks on what is less steep, and slides off other
    double step_height =
        0.35;                 ///< m, not negative: it climbs steps up to this, and stays on stairs going down
    double mass = 80;         ///< kg, positive: with it it weighs on what it stands on
    double push_force = 500;  ///< N, not negative: with which it pushes bodies out of its way
    double gravity = 9.81;    ///< m/s², against `up`, not negative
    double margin = 0.01;     ///< m, positive, less than the radius: distance that it keeps from things
    QueryFilter<D> filter{};  ///< what it meets
    Filter shape_filter{};    ///< of its own shape, for what meets it
};

/// A capsule that a player or a program moves: it walks over slopes and stairs, slides along walls, rides on
/// platforms, pushes what is light enough, and passes through nothing at any speed.
///
/// It is a kinematic body. Before each step of the world `move` looks how far it can come in that step, and
/// gives the body the velocity that takes it there.
template <int D>
class Character {
  public:
    /// Adds the body to the world. Throws `Error` that names the field.
    Character(World<D>& world, const CharacterDefinition<D>& definition);

    /// Wants to move with `velocity` (m/s; only the part across `up` counts while it is on the ground or in
    /// the air) through the next step of `dt` seconds. To be followed by world.step(dt).
    void move(World<D>& world, const Vec<D>& velocity, double dt);
    /// Leaves the ground with this speed (m/s) at the next move, if it stands on it then.
    void jump(double speed);
    /// Puts its lowest point elsewhere at once, at rest.
    void place(World<D>& world, const Vec<D>& position);

    /// The kinematic body that it is in the world.
    BodyId<D> body() const { return body_; }
    /// Its lowest point, m.
    Vec<D> position(const World<D>& world) const;
    /// What it stands on, or nothing while it is in the air or slides.
    std::optional<BodyId<D>> ground() const { return ground_; }
    bool on_ground() const { return ground_.has_value(); }
    /// Of what it stands on; `up` in the air.
    Vec<D> ground_normal() const { return ground_normal_; }
    /// Upwards, m/s; 0 on the ground.
    double vertical_speed() const { return vertical_speed_; }

  private:
    /// A way that is cut short by what stands in it.
    struct Way {
        Vec<D> done{};
        std::optional<WorldHit<D>> hit{};
    };
    Way advance(const World<D>& world, const Vec<D>& from, const Vec<D>& way,
                std::optional<BodyId<D>> passes = {}) const;
    void stand_on(const WorldHit<D>& hit);
    bool is_walkable(const Vec<D>& normal) const;
    bool carries(const World<D>& world, const WorldHit<D>& hit, const Vec<D>& at) const;
    Vec<D> pushed_out(const World<D>& world, Vec<D> at) const;
    Vec<D> walk(World<D>& world, Vec<D> at, Vec<D> way, double dt) const;
    std::optional<Vec<D>> climb(const World<D>& world, const Vec<D>& at, const Vec<D>& way) const;
    Vec<D> settle(World<D>& world, const Vec<D>& at);
    Vec<D> fall(World<D>& world, Vec<D> at, double dt);
    void push(World<D>& world, const WorldHit<D>& hit, const Vec<D>& way, double dt) const;

    CharacterDefinition<D> definition_;
    Solid<D> solid_;
    BodyId<D> body_{};
    std::optional<BodyId<D>> ground_{};
    Vec<D> ground_point_{}, ground_normal_{};
    std::optional<Vec<D>> slope_{};  ///< normal of what it slides down
    double vertical_speed_ = 0, jump_speed_ = 0;
    double least_rise_ = 0;  ///< of the normal of what it can walk on, along up
};

using Character2 = Character<2>;
using Character3 = Character<3>;

}  // namespace carom
