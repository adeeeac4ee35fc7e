#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/crew.hpp"
#include "solver/block_matrix.hpp"
#include "solver/direct_rows.hpp"
#include "solver/joint_input.hpp"

namespace carom::detail {

template <int D>
Wrench<D, double> operator*(double factor, const Wrench<D, double>& w) {
    return {factor * w.force, w.on_a * factor, w.on_b * factor};
}
template <int D>
void add(Wrench<D, double>& sum, const Wrench<D, double>& w) {
    sum.force += w.force;
    sum.on_a = sum.on_a + w.on_a;
    sum.on_b = sum.on_b + w.on_b;
}

/// Joints that are solved at once. What hangs together by joints through bodies that can be pushed is a group
/// with a matrix J M⁻¹ Jᵀ, which has a block for each joint and for each two joints of a body. It is
/// factorised in each pass, in double precision. So the joints of a group agree, however long its chains are
/// and however much the masses differ.
template <int D>
class DirectSolver {
  public:
    /// Takes up joints and the bodies that they hold, one group after another: `joints[groups[i]]` is the
    /// first of group i. The structure is kept while these stay the same.
    void plan(const JointInput<D>& input, std::span<const std::uint32_t> joints,
              std::span<const std::uint32_t> group_starts);
    void set_step(double substep);
    bool any() const { return !joints_.empty(); }
    std::size_t size() const { return joints_.size(); }

    // What each worker does; all have to have met before, and have to meet after it.

    /// Takes the joints up as they are at the start of a step.
    void load(const JointInput<D>& input, const Crew& crew);
    /// Applies the impulses that they have kept.
    void start(const RecordView<D>& bodies, const Crew& crew);
    void solve(const RecordView<D>& bodies, const Crew& crew);
    void relax(const RecordView<D>& bodies, const Crew& crew);
    void store(const JointInput<D>& input, const Crew& crew) const;

    // What the first worker does alone.

    /// Picks the groups that hold one of these bodies. Are there any?
    bool pick(std::span<const std::uint32_t> slots);
    /// Solves them once more along the directions of the last pass.
    void settle(const RecordView<D>& bodies, bool before_moving);

  private:
    using Row = DirectRow<D>;
    using Side = Wrench<D, double>;

    /// A body. What turns with it under a load resists turning: a taut chain of light links springs back from
    /// each turn of a link. Where that is fast beside a sub-step it has to be seen ahead, so impulses meet
    /// the body as heavier (`stiffness`, in units of mass and inertia; see `stiffen`).
    struct Member {
        std::uint32_t slot = 0;
        Motion<D, double> motion{};
        Weight<D, double> weight{};
        Vec<D> given{};  ///< change of velocity by the joints in this sub-step
        Angular<D> given_spin{};
        Vec<D> wanted{};  ///< impulse of the joints on it along the directions as laid, or a way to go
        Angular<D> wanted_spin{};
        Vec<D> free{};  ///< velocity without the joints
        Angular<D> free_spin{};
        Vec<D> laid_velocity{};
        Angular<D> laid_spin{};  ///< with which the rows were laid
        Symmetric3<double> stiffness{};
        Inertia<D> turn_stiffness{};
        Symmetric3<double> answer{};  ///< inverse of mass and stiffness
        Inertia<D> turn_answer{};
    };
    struct Group {
        std::uint32_t first_joint = 0, last_joint = 0;
        std::uint32_t first_body = 0, last_body = 0;
        std::uint32_t first_tie = 0, last_tie = 0;
    };
    /// Two joints of a body, and where their block is.
    struct Tie {
        std::uint32_t row = 0, column = 0;  ///< joints
        bool row_is_a = false, column_is_a = false;
        std::uint32_t place = 0;
    };
    /// What a unit of impulse along a row changes of the velocities of its two bodies.
    struct Effect {
        Vec<D> push_a{}, push_b{};
        Angular<D> turn_a{}, turn_b{};
    };

    /// The rows of a part that is held by a spring, as vectors; what a part has not of three directions is
    /// zero.
    struct VectorRows {
        int first = 0, count = 0;
        Symmetric3<double> compliance{}, alone{};
        Vec3 speed{}, impulse{}, offset{};
    };

    /// What rows may do when it is looked anew for which of them hold.
    enum class Search {
        free,       ///< anything
        releasing,  ///< let go, but not take hold
        ending,     ///< the same, and what does not hold stays as it is: so there is an end
    };

    void add_group(const JointInput<D>& input, std::span<const std::uint32_t> joints);
    void tie_joints(Group& group);

    void solve_group(const Group& group);
    void relax_group(const Group& group);
    void solve_more(const Group& group);
    Side wrench_of(const DirectJoint<D>& joint) const;
    void note_speeds(DirectJoint<D>& joint);
    void solve_as_laid(const Group& group);
    void gather_members(const Group& group, const RecordView<D>& bodies);
    void scatter_members(const Group& group, const RecordView<D>& bodies, bool moved) const;
    template <bool biased>
    void lay(DirectJoint<D>& joint);
    void stiffen(const Group& group);
    void answer_by_mass(const Group& group);
    void stiffen_by(const DirectJoint<D>& joint, const JointArms<D>& arms);
    void take_back(const Group& group);
    bool gains_energy(const Group& group);
    bool is_driven(std::uint32_t node, std::uint32_t row) const;
    void project(const Group& group);
    void clear_wanted(const Group& group);
    void sum_wanted(const Group& group);
    void re_aim(const Group& group);
    double misdirection(const Group& group) const;
    void set_effects(const DirectJoint<D>& joint);
    void assemble(const Group& group);
    void weigh(std::uint32_t node);
    double side_product(const Tie& tie, std::uint32_t row, std::uint32_t column) const;
    bool find_laws(const Group& group, Search search);
    bool find_drive_law(std::uint32_t node, int drive, Search search);
    bool find_spring_law(std::uint32_t node, int part, Search search);
    bool set_law(std::uint32_t node, std::uint32_t row, const RowLaw& law, Search search);
    void split_friction(std::uint32_t node);
    VectorRows look_at(std::uint32_t node, int part) const;
    void set_diagonal(std::uint32_t node, bool with_springs);
    double softened(std::uint32_t node, std::uint32_t row) const;
    /// `visit(joint, row)` for all rows of a group.
    template <class Visit>
    void each_row(const Group& group, Visit&& visit) const {
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
            const std::uint32_t first = joints_[k].first_row;
            const auto count = static_cast<std::uint32_t>(joints_[k].row_count());
            for (std::uint32_t row = first; row < first + count; ++row) visit(k, row);
        }
    }
    double own(std::uint32_t node, int row, int column) const { return own_[place(node, row, column)]; }
    double alone(std::uint32_t node, int row, int column) const { return alone_[place(node, row, column)]; }
    static std::size_t place(std::uint32_t node, int row, int column) {
        constexpr std::size_t n = DirectJoint<D>::most_rows;
        return (node * n + static_cast<std::size_t>(row)) * n + static_cast<std::size_t>(column);
    }
    void set_impulse(DirectJoint<D>& joint, std::uint32_t row, double impulse);
    void solve_rows(const Group& group);
    void mend(const Group& group);
    void shift(const Group& group, double reach);
    void keep_impulses(DirectJoint<D>& joint);
    double speed(const DirectJoint<D>& joint, const Row& row) const;
    std::span<Row> rows_of(const DirectJoint<D>& joint) {
        return std::span(rows_).subspan(joint.first_row, static_cast<std::size_t>(joint.row_count()));
    }

    JointStep<double> step_{};
    std::vector<DirectJoint<D>> joints_;  ///< by group, in the order of elimination
    std::vector<Group> groups_;
    std::vector<std::uint32_t> group_of_;  ///< by slot of a body that can be pushed
    std::vector<std::uint32_t> picked_;    ///< groups
    std::vector<Member> members_;  ///< the bodies, by group; one that cannot be pushed may be in several
    std::vector<Tie> ties_;
    BlockMatrix matrix_;
    std::vector<Row> rows_;
    std::vector<Effect> effects_;     ///< by row
    std::vector<JointArms<D>> arms_;  ///< by joint
    std::vector<RowLaw> laws_;
    std::vector<double> own_;  ///< by joint, `most_rows` squared: its block on the diagonal, without springs
    std::vector<double> alone_;  ///< the same of parts with springs, if bodies answer by their mass alone
    std::vector<std::uint8_t> open_;
    std::vector<double> right_;
};

}  // namespace carom::detail
