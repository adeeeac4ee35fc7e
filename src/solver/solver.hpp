#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carom/body.hpp"
#include "dynamics/body.hpp"
#include "dynamics/contact.hpp"
#include "solver/bounce.hpp"
#include "solver/rows.hpp"

namespace carom::detail {

/// One step as the solver sees it.
template <int D>
struct SolverInput {
    std::span<BodyState<D>> states;  ///< of all bodies; those in contact are moved on
    std::span<const BodyMass<D>> masses;
    std::span<const BodyType> types;
    std::span<const std::uint8_t>
        moving;                      ///< awake dynamic bodies and moving kinematic ones; others stand still
    std::span<const Load<D>> loads;  ///< at the start of the step
    std::span<ContactRecord<D>> contacts;   ///< all; impulses are read and written
    std::span<const std::uint32_t> active;  ///< indices of the contacts that carry points
    double step = 0;
    int substeps = 4;
    double restitution_threshold = 1;
};

/// Moves the bodies that are in contact through one step. An object of it keeps its buffers from step to
/// step, so that a steady step allocates nothing; it holds no state that matters to the result.
template <int D>
class Solver {
  public:
    void run(const SolverInput<D>& input);

  private:
    using Rows = ContactRows<D, float>;
    using Body = Motion<D, float>;

    /// What drives a body through the sub-steps.
    struct Drive {
        Vec<D, float> acceleration{};  ///< by outer forces
        Angular<D, float> spin_acceleration{};
        Vec<D, float> warm{};  ///< velocity that the constraints gave in the sub-step before
        Angular<D, float> warm_spin{};
        Vec<D, float> change{};  ///< whole change of velocity in the sub-step before
        Angular<D, float> spin_change{};
        Vec<D, float> start{};  ///< velocity at the start of this sub-step, after damping
        Angular<D, float> start_spin{};
        Vec<D, float> lost{},
            lost_before{};  ///< what rounding cut off the velocity, now and before this sub-step
        Angular<D, float> lost_spin{}, lost_spin_before{};
        float damping = 1, spin_damping = 1;  ///< factors of a sub-step
    };

    struct Pair {
        std::uint32_t a, b;  ///< slots; slot 0 stands for all that stands still
    };
    /// A point that may bounce, as it was at the start of the step.
    struct Impact {
        std::uint32_t row, point;
        float restitution;
        float speed;         ///< of separation, m/s
        float acceleration;  ///< of separation, by outer forces and steady constraints, m/s²
    };

    void gather_bodies(const SolverInput<D>& input);
    std::uint32_t slot(const SolverInput<D>& input, std::uint32_t body);
    void load_body(const SolverInput<D>& input, std::uint32_t body, Body& motion, Weight<D, float>& weight,
                   Drive& drive) const;
    void prepare(const SolverInput<D>& input);
    void prepare_contact(const ContactRecord<D>& record, Rows& rows, std::uint32_t a, std::uint32_t b) const;
    void begin_warm();
    void look_ahead();
    void find_impacts(const SolverInput<D>& input);
    Body& motion(std::uint32_t slot, Body& still);
    void integrate_velocities();
    template <bool biased>
    void solve();
    void push_velocity(Body& motion, Drive& drive, const Vec<D, float>& by, const Angular<D, float>& spin_by);
    void find_struck();
    void sum_struck();
    template <bool biased>
    void settle_struck();
    void integrate_positions();
    void finish_substep();
    void bounce(const SolverInput<D>& input);
    void bounce(const Impact& impact, const Rebound& rebound);
    void store(const SolverInput<D>& input);

    float h_ = 0;  ///< length of a sub-step
    SubStep<float> sub_{};
    Softness<float> soft_{}, soft_fixed_{};
    std::vector<std::uint32_t> slot_of_;  ///< by body index; 0: none
    std::vector<std::uint32_t> bodies_;   ///< body index by slot; the first is unused
    std::vector<Body> motions_, kept_;
    std::vector<Weight<D, float>> weights_;
    std::vector<Drive> drives_;
    std::vector<Pair> pairs_;
    std::vector<Rows> rows_;
    std::vector<std::uint8_t> settled_;        ///< by row: has it carried an impulse?
    std::vector<std::uint32_t> struck_;        ///< rows that carry their first impulse in this sub-step
    std::vector<std::uint8_t> struck_bodies_;  ///< by slot: has it such a row?
    std::vector<Impact> impacts_;              ///< points with restitution
};

}  // namespace carom::detail
