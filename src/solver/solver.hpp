#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "carom/body.hpp"
#include "carom/joints.hpp"
#include "dynamics/body.hpp"
#include "dynamics/contact.hpp"
#include "solver/blocks.hpp"
#include "solver/body_slots.hpp"
#include "solver/bounce.hpp"
#include "solver/colours.hpp"
#include "solver/contact_store.hpp"
#include "solver/impacts.hpp"
#include "solver/joint_solver.hpp"
#include "solver/passes.hpp"

namespace carom::detail {

/// One step as the solver sees it.
template <int D>
struct SolverInput {
    std::span<BodyState<D>> states;  ///< of all bodies; those in contact or on joints are moved on
    std::span<const BodyMass<D>> masses;
    std::span<const Load<D>> loads;  ///< at the start of the step
    Scheduler* scheduler = nullptr;  ///< or none: then all is done by the calling thread
    bool some_locked = false;        ///< does any body have a locked axis along which it cannot be pushed?
    double step = 0;
    int substeps = 4;
    double restitution_threshold = 1;
    bool impacts_together = true;  ///< else one after the other, at the end of the step
    JointMethod joint_method = JointMethod::automatic;
    std::span<JointRecord<D>> joints{};  ///< all; impulses are read, and written when they are let go
    std::span<const std::uint32_t> active_joints{};  ///< indices of those that hold a body which moves freely
    std::span<CouplingRecord<D>> couplings{};        ///< the same for these
    std::span<const std::uint32_t> active_couplings{};
};

/// Moves the bodies that are in contact or on joints through one step. It keeps the contacts from step to
/// step, in lanes and by colour: what does not change is neither loaded nor stored.
template <int D>
class Solver {
  public:
    Solver();

    // Bodies. -------------------------------------------------------------------------------------------

    /// Follows which bodies move: the awake dynamic and the moving kinematic ones. Returns whether any began
    /// or ceased to. Calls `let_go(contact)` for each contact of such a body; it has to be removed, and may
    /// be added again afterwards.
    template <class LetGo>
    bool follow(std::span<const std::uint32_t> awake, std::span<const BodyType> types, LetGo&& let_go) {
        if (!slots_.follow(awake, types)) return false;
        joints_.expect_others();
        for (Section& s : sections_) {
            for (std::size_t i = s.contacts.size(); i-- > 0;) {
                if (slots_.changed(s.contacts.body_a(i)) || slots_.changed(s.contacts.body_b(i)))
                    let_go(s.contacts.contact(i));
            }
        }
        view_.first_movable = slots_.first_movable();
        touching_.resize(slots_.size(), 0);
        return true;
    }
    /// Did `follow` find that this body began or ceased to move when it was last called?
    bool changed(std::uint32_t body) const { return slots_.changed(body); }
    /// Has the body a contact here, or had it a joint in the last `run`?
    bool moves(std::uint32_t body) const { return is_loaded(slots_.slot(body)); }

    /// Joints change that the solver has taken up, or come, go, or get bodies with other masses: see
    /// `JointSolver::let_go`.
    void let_joints_go(std::span<JointRecord<D>> joints) {
        joints_.let_go(joints);
        joints_.expect_others();
    }
    /// Completes the record of a joint by what the solver knows.
    void read_joint(std::uint32_t joint, JointRecord<D>& record) const { joints_.read(joint, record); }

    // Contacts, by their number in the world. -----------------------------------------------------------

    std::size_t contacts() const { return count_; }
    std::size_t largest_colour() const {
        std::size_t most = 0;
        for (int c = 0; c < Colours::count; ++c) most = std::max(most, sections_[c].contacts.size());
        return most;
    }
    /// How many contacts found no colour.
    std::size_t without_colour() const { return sections_[Colours::overflow].contacts.size(); }
    /// Takes up a contact of which a body can be pushed. With `carrying`, `refresh` keeps it up to date from
    /// then on; without, it is to be written before each step.
    void add(std::uint32_t contact, ContactRecord<D>& record, const Carrying<D>* carrying);
    void write(const ContactRecord<D>& record, const Carrying<D>* carrying);
    /// Completes the record by what the solver knows. `cache` is what it was last written with, and is
    /// brought up to date, too.
    void read(ContactCache<D>& cache, ContactRecord<D>& record) const;
    bool is_carried(const ContactRecord<D>& record) const;
    /// Returns the contact whose place is now that of the removed one, or `none`.
    std::uint32_t remove(ContactRecord<D>& record);
    /// The contact has another number now.
    void rename(const ContactRecord<D>& record, std::uint32_t contact);

    /// Keeps the contacts up to date with their bodies. Calls `look(contact)` for each that has to be looked
    /// at: its manifold is no longer good and not for lanes, or it is not carried along.
    template <class Look>
    void refresh(std::span<const BodyState<D>> states, const LaneShapes<D>& shapes, float reach,
                 Scheduler* scheduler, Look&& look) {
        const PoseView<D> poses{reinterpret_cast<const double*>(states.data())};
        each_part(scheduler, [&](const Passes<D>& passes, const BlockSpan<D>& span) {
            passes.refresh(span, poses, shapes.data(), reach);
        });
        each_used([&](Section& s) { each_found(s, look); });
    }

    void run(const SolverInput<D>& input);

    /// Calls `changed(contact)` for each contact that has begun or ended to touch.
    template <class Changed>
    void report(Scheduler* scheduler, Changed&& changed) {
        each_part(scheduler, [](const Passes<D>& passes, const BlockSpan<D>& span) { passes.touch(span); });
        each_used([&](Section& s) { each_found(s, changed); });
    }

    static constexpr std::uint32_t none = ~std::uint32_t{0};

  private:
    using Rows = ContactRows<D, float>;

    /// The contacts of one colour; those of the overflow are solved one by one.
    struct Section {
        ContactStore<D> contacts;
        std::vector<std::uint32_t> waiting;    ///< by block, a bit a lane: those without an impulse so far
        std::vector<std::uint32_t> begun;      ///< those that got their first impulse in this sub-step
        std::vector<std::uint32_t> hit;        ///< those for which that was a blow, in the sub-step before
        std::vector<std::uint32_t> struck;     ///< both: to be settled in this sub-step
        ContactBlocks<D> settling;             ///< copies of the struck ones, close together
        std::vector<std::uint8_t> has_struck;  ///< by block: has it contacts of struck bodies?
        std::vector<std::uint64_t> groups;     ///< by block: which `group_bit`s its bodies have
    };
    /// A point that may bounce, as it was at the start of the step.
    struct Impact {
        std::uint32_t contact;
        std::uint32_t section, index, point;
        float restitution;
        float speed;         ///< of separation, m/s
        float acceleration;  ///< of separation, by outer forces and steady constraints, m/s²
    };

    // solver.cpp
    const Passes<D>& passes_of(const Section& section) const { return section.contacts.passes(); }
    void set_lengths(const SolverInput<D>& input);
    void mark_jointed(const SolverInput<D>& input);
    void work(const SolverInput<D>& input, const Crew& crew);
    void step_through(const SolverInput<D>& input, const Crew& crew);
    bool is_small() const { return count_ < 256; }  ///< so that it is not worth several workers
    /// Lists the sections that have contacts, for `each_used`, which is called often.
    void list_used() {
        used_.clear();
        for (Section& section : sections_) {
            if (!section.contacts.empty()) used_.push_back(&section);
        }
    }
    template <class Visit>
    void each_used(Visit&& visit) {
        for (Section* section : used_) visit(*section);
    }
    /// `visit(passes, blocks)` for a share of the blocks of each section: the workers pass through them side
    /// by side, and where bodies are written they wait for one another after each colour.
    template <class Visit>
    void each_share(const Crew& crew, bool writes_bodies, Visit&& visit) {
        constexpr std::size_t least_blocks = 4;
        for (Section* used : used_) {
            Section& s = *used;
            const bool one_by_one = writes_bodies && &s == &sections_[Colours::overflow];
            const Part part = one_by_one ? Part{0, crew.is_first() ? s.contacts.blocks() : 0}
                                         : crew.part(s.contacts.blocks(), least_blocks);
            if (part.size() > 0) visit(passes_of(s), s.contacts.span(part.begin, part.size()));
            if (writes_bodies) crew.meet();
        }
    }
    /// The same with no step around it, and without writing bodies.
    template <class Visit>
    void each_part(Scheduler* scheduler, Visit&& visit) {
        list_used();
        run_crew(scheduler, is_small(), [&](const Crew& crew) { each_share(crew, false, visit); });
    }
    /// `visit(bodies)` for a share of the bodies.
    template <class Visit>
    void each_body_share(const Crew& crew, Visit&& visit) {
        const Part part = crew.part(drives_.blocks_for(slots_.size()), 4);
        if (part.size() > 0) visit(BodySpan<D>{view_, drives_.data(), part});
        crew.meet();
    }
    /// `visit(contact)` for what the last pass found.
    template <class Visit>
    static void each_found(const Section& s, Visit&& visit) {
        each_bit(
            s, [&](std::size_t block) { return s.contacts.found(block); },
            [&](std::uint32_t index) {
                if (index < s.contacts.size()) visit(s.contacts.contact(index));
            });
    }
    /// `visit(index)` for each bit that is set in `bits(block)`.
    template <class Bits, class Visit>
    static void each_bit(const Section& s, Bits&& bits, Visit&& visit) {
        for (std::size_t block = 0; block < s.contacts.blocks(); ++block) {
            for (std::uint32_t left = bits(block); left != 0; left &= left - 1)
                visit(static_cast<std::uint32_t>(block * s.contacts.width()) +
                      static_cast<std::uint32_t>(std::countr_zero(left)));
        }
    }

    // load.cpp: bodies and contacts made ready for a step, and the bodies' states after it.
    void make_room();
    bool is_loaded(std::uint32_t slot) const {
        return slot != BodySlots::still && slot < slots_.size() && slots_.body(slot) != BodySlots::none &&
               (touching_[slot] > 0 || jointed_[slot] != 0);
    }
    Part share_of_blocks(const Crew& crew) const;
    BodySource<D> source(const SolverInput<D>& input);
    void load_bodies(const SolverInput<D>& input, const Crew& crew);
    void load_body(const SolverInput<D>& input, std::uint32_t slot);
    void set_free_axes(const SolverInput<D>& input);
    void prepare_contacts(const Crew& crew);
    JointInput<D> joint_input(const SolverInput<D>& input) const {
        return {input.joints,
                input.active_joints,
                input.couplings,
                input.active_couplings,
                input.states,
                input.masses,
                slots_,
                view_,
                input.step / input.substeps,
                input.joint_method};
    }
    void store_bodies(const SolverInput<D>& input, const Crew& crew);
    void store_body(const SolverInput<D>& input, std::uint32_t slot) const;

    // settle.cpp: contacts that begin.
    void find_struck();
    void note_blows();
    void forget_last_blows();
    template <bool biased>
    void settle(const Crew& crew);
    void copy_struck(Section& section, const Part& places);
    void return_struck(Section& section, const Part& places);
    template <bool biased>
    void settle_struck(const Crew& crew);
    template <class Visit>
    void each_settling(const Crew& crew, bool writes_bodies, Visit&& visit);
    bool pick_struck_joints();
    void mark_struck_bodies();
    void find_struck_blocks(const Crew& crew);
    /// Bodies are told apart by groups of slots, so that most blocks need one look.
    static std::uint64_t group_bit(std::uint32_t slot) { return std::uint64_t{1} << (slot / 64 % 64); }
    void sum_struck();
    static float speed_taken(const LaneStore<Rows>& rows, std::size_t index);

    // restitution.cpp
    void expect_impacts(const SolverInput<D>& input);
    ImpactView<D> impact_view(const SolverInput<D>& input);
    void note_impacts();
    void find_impacts();
    void bounce(const SolverInput<D>& input);
    void bounce(const Impact& impact, const Rebound& rebound);

    float h_ = 0;  ///< length of a sub-step
    SubStep<float> sub_{};
    const Passes<D>* passes_;  ///< of the widest lanes

    BodySlots slots_;
    std::vector<std::uint32_t> touching_ = std::vector<std::uint32_t>(8, 0);  ///< by slot: how many contacts
    std::vector<std::uint8_t> jointed_;                                       ///< by slot: has it a joint?
    RecordView<D> view_;
    std::vector<float> records_, free_axes_;
    std::vector<std::uint32_t> source_;  ///< by slot: its body, if it is loaded
    std::vector<float> present_;         ///< by slot: 1 if that is moved in lanes, else 0
    LaneStore<Drive<D, float>> drives_;  ///< by slot

    std::size_t count_ = 0;  ///< of contacts
    Colours colours_;
    JointSolver<D> joints_;
    std::array<Section, Colours::count + 1> sections_;
    std::vector<Section*> used_;               ///< those that have contacts
    std::vector<float> sums_;                  ///< like `records_`, with what the impulses make as velocities
    std::vector<std::uint8_t> is_struck_;      ///< by slot: has it a contact that is struck?
    std::vector<std::uint32_t> struck_slots_;  ///< those that have
    std::vector<std::pair<BlockSpan<D>, const Passes<D>*>> wanted_;  ///< blocks with contacts of these
    bool some_struck_ = false;                                       ///< in this sub-step
    bool many_struck_ = false;   ///< so many that they are worth all workers
    bool groups_known_ = false;  ///< in this step
    std::uint64_t struck_groups_ = 0;
    bool some_joints_struck_ = false;            ///< in this sub-step
    std::vector<std::uint32_t> struck_jointed_;  ///< slots of struck bodies that have joints
    std::vector<Impact> impacts_;                ///< points with restitution
    ImpactSolver<D> impact_solver_;
    std::vector<ContactStore<D>*> stores_;  ///< of all sections
    bool some_impacts_ = false;             ///< may anything bounce in this step, and are impacts together?
};

}  // namespace carom::detail
