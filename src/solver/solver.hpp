#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carom/body.hpp"
#include "dynamics/body.hpp"
#include "dynamics/contact.hpp"
#include "solver/blocks.hpp"
#include "solver/bounce.hpp"
#include "solver/colours.hpp"
#include "solver/joint_solver.hpp"
#include "solver/lane_store.hpp"
#include "solver/passes.hpp"

namespace carom::detail {

/// One step as the solver sees it.
template <int D>
struct SolverInput {
    std::span<BodyState<D>> states;  ///< of all bodies; those in contact or on joints are moved on
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
    std::span<JointRecord<D>> joints{};              ///< all; impulses are read and written
    std::span<const std::uint32_t> active_joints{};  ///< indices of those that hold a body which moves freely
};

/// Moves the bodies that are in contact, or held by joints, through one step. An object of it keeps its buffers from step to
/// step, so that a steady step allocates nothing; it holds no state that matters to the result.
template <int D>
class Solver {
  public:
    void run(const SolverInput<D>& input);

  private:
    using Rows = ContactRows<D, float>;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// A contact that carried no impulse when the step began. It is settled in the sub-step in which it first
    /// does, and in the next as well if that was a blow, as then its impulse is not needed any more.
    struct Unsettled {
        enum class Stage : std::uint8_t { waits, begins, was_hit, ends };
        std::uint32_t place;
        Stage stage = Stage::waits;
    };
    /// Contacts that are solved with one lane width: all that have a colour in the widest lanes, and the
    /// overflow of the colouring one by one.
    struct Section {
        ContactBlocks<D> blocks;
        std::vector<std::uint32_t> contacts;       ///< by place: which of the active ones, or `none`
        std::vector<std::uint32_t> colour_starts;  ///< places
        std::vector<Unsettled> unsettled;          ///< contacts that have just begun, or are yet to
        std::vector<std::uint32_t> struck;         ///< places of those that carry an impulse in this sub-step
        ContactBlocks<D> settling;                 ///< copies of the struck ones, close together
        std::vector<std::uint32_t> sources;  ///< by place in `settling`: where the copy is from, or `none`
    };
    /// A point that may bounce, as it was at the start of the step.
    struct Impact {
        std::uint32_t section, place, point;
        float restitution;
        float speed;         ///< of separation, m/s
        float acceleration;  ///< of separation, by outer forces and steady constraints, m/s²
    };

    // solver.cpp
    void set_lengths(const SolverInput<D>& input);
    template <class Pass>
    void each_section(Pass&& pass);
    void step_through(int substeps);

    // load.cpp: from the world's records to lanes.
    void gather_bodies(const SolverInput<D>& input);
    void find_slots(const SolverInput<D>& input);
    void load_body(const SolverInput<D>& input, std::uint32_t slot);
    void prepare_joints(const SolverInput<D>& input);
    void deal_contacts(const SolverInput<D>& input);
    void fill_section(const SolverInput<D>& input, Section& section);
    void fill_block(const SolverInput<D>& input, Section& section, std::size_t block);
    static void prefetch_record(const SolverInput<D>& input, const Section& section, std::size_t place);
    void note_impacts(const Section& section, std::size_t place, const ContactRecord<D>& record);
    static bool carries_impulse(const LaneStore<Rows>& rows, std::size_t place);
    static float speed_taken(const LaneStore<Rows>& rows, std::size_t place);
    void store(const SolverInput<D>& input);
    void store_contact(const Section& section, std::size_t place, ContactRecord<D>& record) const;

    // settle.cpp: contacts that begin.
    bool find_struck();
    void note_blows();
    void forget_last_blows();
    void copy_struck(Section& section);
    void return_struck(Section& section);
    template <bool biased>
    void settle_struck();
    void sum_struck();
    void mark_struck_bodies();

    // restitution.cpp
    void find_impacts(const SolverInput<D>& input);
    void bounce(const SolverInput<D>& input);
    void bounce(const Impact& impact, const Rebound& rebound);

    BodySpan<D> body_span() { return {view_, drives_.data(), drives_.blocks_for(bodies_.size())}; }

    float h_ = 0;  ///< length of a sub-step
    SubStep<float> sub_{};
    const Passes<D>* passes_ = nullptr;  ///< of the widest lanes

    std::vector<std::uint32_t> slot_of_;  ///< by body index; 0: none
    std::vector<std::uint32_t> bodies_;   ///< body index by slot; slot 0 stands for all that stands still
    RecordView<D> view_;
    std::vector<float> records_, free_axes_;
    LaneStore<Drive<D, float>> drives_;  ///< by slot

    std::vector<SlotPair> pairs_;  ///< by active contact
    Colours colours_;
    JointSolver<D> joints_;
    std::array<Section, 2> sections_;
    std::vector<float> sums_;  ///< like `records_`, with what the impulses make as velocities
    bool sums_begun_ = false;  ///< in this step: else the rest of `sums_` is not that of `records_`
    std::vector<std::uint8_t> is_struck_;      ///< by slot: has it a contact that is struck?
    std::vector<std::uint32_t> struck_slots_;  ///< those that have
    std::vector<std::pair<BlockSpan<D>, std::size_t>>
        wanted_;                   ///< blocks with such contacts, and their widths
    std::vector<Impact> impacts_;  ///< points with restitution
};

}  // namespace carom::detail
