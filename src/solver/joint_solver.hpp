#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/crew.hpp"
#include "solver/couplings.hpp"
#include "solver/joint_input.hpp"
#include "solver/joint_passes.hpp"

namespace carom::detail {

template <int D>
class DirectSolver;
template <int D>
class JointGroups;

/// Joints in the sub-steps of the solver. Those of one colour share no body that can be pushed, and those of
/// one colour and layout lie in blocks of as many lanes as the processor has.
template <int D>
class JointSolver {
  public:
    JointSolver();
    ~JointSolver();

    /// Takes the joints up. When they are not those of the last step, colours them and makes room for their
    /// rows; otherwise rows keep their impulses, which the records do not have then.
    void plan(const JointInput<D>& input);
    /// The next step may have other joints, or joints of other bodies, masses, limits or anchors.
    void expect_others() { is_stale_ = true; }
    bool expects_others() const { return is_stale_; }
    /// Gives the records their impulses, which has to be done before any other takes the place of one.
    void let_go(std::span<JointRecord<D>> joints);
    /// Completes the record of this joint by its impulses.
    void read(std::uint32_t joint, JointRecord<D>& record) const;
    /// So few that they are not worth several workers.
    bool is_small() const;

    // What each worker does; all have to have met before, and have met after it.

    /// Fills the rows and applies the impulses that the joints have kept.
    void prepare(const JointInput<D>& input, const Crew& crew);
    /// One pass at the start of a sub-step, and one after positions were integrated.
    void solve(const RecordView<D>& bodies, const Crew& crew);
    void relax(const RecordView<D>& bodies, const Crew& crew);

    // What the first worker does alone, in the middle of a sub-step.

    /// Picks the joints that are near one of these bodies, so that they may come to agree with contacts that
    /// were hit. Are there any?
    bool pick_near(std::span<const std::uint32_t> slots);
    /// Takes up the rows of the joints that were picked last.
    void begin_settling();
    /// Solves them once more, after `solve` or after `relax`.
    void settle(const RecordView<D>& bodies, bool before_moving);
    void end_settling();

    /// Gives the records of couplings, and of joints that are solved directly, their impulses.
    void store(const JointInput<D>& input, const Crew& crew) const;

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr int colours = 64, overflow = colours;
    static constexpr std::size_t layout_count = layouts<D>.size();

    /// Joints of one colour and layout, from a place on.
    struct Batch {
        int colour = 0;
        std::uint32_t layout = 0;
        std::uint32_t width = 1;
        std::size_t first_place = 0, first_block = 0, blocks = 0;
        std::size_t first_float = 0;
    };
    struct alignas(64) Line {
        std::array<float, 16> floats;
    };

    void colour(const JointInput<D>& input);
    void make_batches(const JointInput<D>& input);
    void mark_blocks(const Batch& batch, const JointInput<D>& input);
    /// `visit(batch, blocks)` for a share of the blocks of each batch. Where bodies are written the workers
    /// wait for one another after each colour, and the first one does the overflow alone.
    template <class Visit>
    void each_share(const Crew& crew, bool writes_bodies, Visit&& visit) const;
    void fill(const JointInput<D>& input, const Batch& batch, const Part& part);
    void load(const JointInput<D>& input, const Batch& batch, std::size_t block);
    const JointProgram<D>& program(const Batch& batch) const;
    JointSpan span(const Batch& batch, const Part& part);
    void list_ties();
    void copy_picked(bool back);
    float* rows(const Batch& batch) { return lines_[0].floats.data() + batch.first_float; }
    const float* rows(const Batch& batch) const { return lines_[0].floats.data() + batch.first_float; }

    JointStep<float> step_{};
    std::uint32_t first_movable_ = 0;  ///< slot
    const JointPrograms<D>* wide_ = nullptr;
    std::vector<std::uint64_t> taken_;            ///< by slot: colours of its joints
    std::vector<std::uint8_t> colour_;            ///< by active joint
    std::vector<Batch> batches_;                  ///< in the order in which they are solved
    std::vector<std::uint32_t> joint_, a_, b_;    ///< by place: joint (or none) and slots of its bodies
    std::vector<std::uint32_t> body_a_, body_b_;  ///< by place: the bodies, by their indices in the world
    std::vector<double> anchors_;                 ///< by place: both, see `JointSites`
    std::vector<std::uint8_t> some_fixed_;        ///< by block
    std::vector<std::uint8_t> in_world_;          ///< by block: has any joint an anchor in the world?
    std::vector<std::uint32_t> place_of_;         ///< by joint, or `none`
    bool is_stale_ = true;                        ///< are joints to be taken up anew?
    bool is_fresh_ = false;                       ///< have they been, and have rows no impulses yet?
    bool holds_ = false;                          ///< have rows impulses that the records do not have?
    std::vector<Line> lines_;

    /// Joints that were picked: of each batch some, close together.
    struct Picked {
        Batch batch;  ///< with places of its own
        const Batch* from = nullptr;
        std::uint32_t first = 0, count = 0;  ///< in `picked_`
    };
    std::vector<std::uint32_t> first_tie_, ties_;  ///< by slot: places of its joints
    bool ties_listed_ = false;                     ///< in this step
    std::vector<std::uint8_t> is_picked_;          ///< by place
    std::vector<std::uint32_t> picked_, near_;     ///< places; slots
    std::vector<Picked> of_batch_;
    std::vector<std::uint32_t> picked_a_, picked_b_;
    std::vector<std::uint8_t> picked_fixed_;
    std::vector<Line> picked_lines_;

    Couplings<D> couplings_;
    std::unique_ptr<JointGroups<D>> groups_;
    std::unique_ptr<DirectSolver<D>> direct_;
};

}  // namespace carom::detail
