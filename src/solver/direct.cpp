#include "solver/direct.hpp"

#include <algorithm>
#include <cmath>

namespace carom::detail {

namespace {

constexpr int free_rounds = 3;         ///< in which limits, motors and friction find which of them hold
constexpr int most_rounds = 12;        ///< with those in which they only let go, but for those that end it
constexpr int most_sweeps = 3;         ///< of refinement
constexpr double small_speed = 1e-8;   ///< m/s and rad/s
constexpr int most_turns = 16;         ///< in which directions and velocities agree
constexpr double small_change = 1e-6;  ///< m and rad in a sub-step
constexpr double most_misdirection = 0.1;  ///< beyond which they do not agree

template <int D>
Motion<D, double> widen(const Motion<D, float>& m) {
    return {narrow<double>(m.v), narrow<double>(m.w), narrow<double>(m.moved), narrow<double>(m.turned)};
}
template <int D>
Weight<D, double> widen(const Weight<D, float>& w) {
    return {narrow<double>(w.mass), narrow<double>(w.inertia)};
}

}  // namespace

// ---- A step ----

template <int D>
void DirectSolver<D>::load(const JointInput<D>& input, const Crew& crew) {
    const Part part = crew.part(joints_.size(), 8);
    for (std::size_t k = part.begin; k < part.end; ++k)
        joints_[k].load(input.joints[joints_[k].joint], input.states, input.masses, input.substep);
}

template <int D>
void DirectSolver<D>::store(const JointInput<D>& input, const Crew& crew) const {
    const Part part = crew.part(joints_.size(), 8);
    for (std::size_t k = part.begin; k < part.end; ++k) joints_[k].store(input.joints[joints_[k].joint]);
}

template <int D>
void DirectSolver<D>::gather_members(const Group& group, const RecordView<D>& bodies) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        const Body<D, float> body = gather<float>(bodies, &m.slot);
        m.motion = widen<D>(body.motion);
        m.weight = widen<D>(body.weight);
    }
}

template <int D>
void DirectSolver<D>::scatter_members(const Group& group, const RecordView<D>& bodies, bool moved) const {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        const Member& m = members_[i];
        if (m.slot < bodies.first_movable) continue;
        Body<D, float> body = gather<float>(bodies, &m.slot);
        body.motion = {narrow<float>(m.motion.v), narrow<float>(m.motion.w), narrow<float>(m.motion.moved),
                       narrow<float>(m.motion.turned)};
        scatter_velocity(bodies, &m.slot, body, false);
        if (moved) scatter_way(bodies, &m.slot, body);
    }
}

template <int D>
void DirectSolver<D>::start(const RecordView<D>& bodies, const Crew& crew) {
    const Part part = crew.part(groups_.size());
    for (std::size_t i = part.begin; i < part.end; ++i) {
        const Group& group = groups_[i];
        gather_members(group, bodies);
        for (std::uint32_t k = group.first_body; k < group.last_body; ++k) {
            members_[k].given = {};
            members_[k].given_spin = {};
        }
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
            const Wrench<D, double>& w = joints_[k].wrench;
            Member &a = members_[joints_[k].a], &b = members_[joints_[k].b];
            a.given -= each(a.weight.mass, w.force);
            a.given_spin = a.given_spin - a.weight.inertia * w.on_a;
            b.given += each(b.weight.mass, w.force);
            b.given_spin = b.given_spin + b.weight.inertia * w.on_b;
        }
        for (std::uint32_t k = group.first_body; k < group.last_body; ++k) {
            members_[k].motion.v += members_[k].given;
            members_[k].motion.w = members_[k].motion.w + members_[k].given_spin;
        }
        scatter_members(group, bodies, false);
    }
}

template <int D>
double DirectSolver<D>::speed(const DirectJoint<D>& joint, const Row& row) const {
    const Motion<D, double>&a = members_[joint.a].motion, &b = members_[joint.b].motion;
    return dot(row.end.force, b.v - a.v) + angular_dot(row.end.on_b, b.w) - angular_dot(row.end.on_a, a.w);
}

/// Rows, laid along the directions of this pass, and what the impulses are along them.
template <int D>
template <bool biased>
void DirectSolver<D>::lay(DirectJoint<D>& joint) {
    const std::span<Row> rows = rows_of(joint);
    arms_[static_cast<std::size_t>(&joint - joints_.data())] =
        lay_rows<biased, D>(joint, members_[joint.a].motion, members_[joint.b].motion, step_, rows);
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].impulse = joint.impulses[r];
    if constexpr (D == 3) {
        if (joint.rows().angular != AngularPart::across) return;
        for (int i = 0; i < 2; ++i) {
            Row& row = rows[static_cast<std::size_t>(joint.linear_rows() + i)];
            row.impulse = dot(row.middle.on_b, joint.across_impulse);
        }
    }
}

template <int D>
void DirectSolver<D>::set_impulse(DirectJoint<D>& joint, std::uint32_t row, double impulse) {
    const double change = impulse - rows_[row].impulse;
    const Effect& e = effects_[row];
    Member &a = members_[joint.a], &b = members_[joint.b];
    rows_[row].impulse = impulse;
    a.motion.v -= change * e.push_a;
    a.given -= change * e.push_a;
    a.motion.w = a.motion.w - e.turn_a * change;
    a.given_spin = a.given_spin - e.turn_a * change;
    b.motion.v += change * e.push_b;
    b.given += change * e.push_b;
    b.motion.w = b.motion.w + e.turn_b * change;
    b.given_spin = b.given_spin + e.turn_b * change;
}

/// J M⁻¹ Jᵀ.
template <int D>
void DirectSolver<D>::assemble(const Group& group) {
    matrix_.clear(group.first_joint, group.last_joint);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) weigh(k);
    const std::span<double> values = matrix_.values();
    for (std::uint32_t t = group.first_tie; t < group.last_tie; ++t) {
        const Tie& tie = ties_[t];
        const DirectJoint<D>&row = joints_[tie.row], &column = joints_[tie.column];
        std::uint32_t at = tie.place;
        for (int r = 0; r < row.row_count(); ++r) {
            for (int c = 0; c < column.row_count(); ++c, ++at)
                values[at] += side_product(tie, row.first_row + static_cast<std::uint32_t>(r),
                                           column.first_row + static_cast<std::uint32_t>(c));
        }
    }
}

/// The joint's own block on the diagonal. Springs are as stiff as the masses say, whatever the bodies answer.
template <int D>
void DirectSolver<D>::weigh(std::uint32_t node) {
    const DirectJoint<D>& joint = joints_[node];
    const std::span<Row> rows = rows_of(joint);
    constexpr std::size_t n = DirectJoint<D>::most_rows;
    const Weight<D, double>&wa = members_[joint.a].weight, &wb = members_[joint.b].weight;
    double* to = own_.data() + node * n * n;
    double* alone = alone_.data() + node * n * n;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const int part = joint.part_of(static_cast<int>(r));
        for (std::size_t c = 0; c <= r && joint.is_sprung(part); ++c) {
            if (joint.part_of(static_cast<int>(c)) != part) continue;
            const Side &v = rows[r].middle, &w = rows[c].middle;
            alone[r * n + c] = alone[c * n + r] = dot(w.force, each(wa.mass + wb.mass, v.force)) +
                                                  angular_dot(w.on_a, Angular<D>(wa.inertia * v.on_a)) +
                                                  angular_dot(w.on_b, Angular<D>(wb.inertia * v.on_b));
        }
        const Effect& e = effects_[joints_[node].first_row + r];
        for (std::size_t c = 0; c <= r; ++c) {
            const Side& w = rows[c].middle;
            to[r * n + c] = to[c * n + r] = dot(w.force, e.push_a + e.push_b) +
                                            angular_dot(w.on_a, e.turn_a) + angular_dot(w.on_b, e.turn_b);
        }
    }
}

/// What an impulse along a row of one joint does to that of another through the body that they share.
template <int D>
double DirectSolver<D>::side_product(const Tie& tie, std::uint32_t row, std::uint32_t column) const {
    const Side& w = rows_[row].middle;
    const Effect& e = effects_[column];
    const double sum = dot(w.force, tie.column_is_a ? e.push_a : e.push_b) +
                       angular_dot(tie.row_is_a ? w.on_a : w.on_b, tie.column_is_a ? e.turn_a : e.turn_b);
    return tie.row_is_a == tie.column_is_a ? sum : -sum;
}

/// Writes the blocks on the diagonal: the joint's own, made softer by what is sprung.
template <int D>
void DirectSolver<D>::set_diagonal(std::uint32_t node, bool with_springs) {
    const DirectJoint<D>& joint = joints_[node];
    const int count = joint.row_count();
    double* to = matrix_.values().data() + matrix_.place_of_diagonal(node);
    for (int r = 0; r < count; ++r) {
        const double softness = laws_[joint.first_row + static_cast<std::uint32_t>(r)].softness;
        for (int c = 0; c < count; ++c, ++to) {
            *to = own(node, r, c);
            if (with_springs && softness > 0 && joint.part_of(r) == joint.part_of(c))
                *to += softness * alone(node, r, c);
            if (r == c) *to *= 1 + joint.compliance;
        }
    }
}

// ---- A pass ----

/// What the spring of a row takes of the speed that it wants.
template <int D>
double DirectSolver<D>::softened(std::uint32_t node, std::uint32_t row) const {
    const DirectJoint<D>& joint = joints_[node];
    const int r = static_cast<int>(row - joint.first_row);
    const double firm = joint.compliance * own(node, r, r) * rows_[row].impulse;
    if (laws_[row].softness == 0) return firm;
    double sum = 0;
    for (int c = 0; c < joint.row_count(); ++c) {
        const std::uint32_t other = joint.first_row + static_cast<std::uint32_t>(c);
        if (joint.part_of(c) == joint.part_of(r))
            sum += alone(node, r, c) * (rows_[other].impulse - laws_[other].given);
    }
    return firm + laws_[row].softness * sum;
}

/// Solves the rows that are open, and refines: the matrix has the directions of the middle of the sub-step
/// on both sides.
template <int D>
void DirectSolver<D>::solve_rows(const Group& group) {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double worst = 0;
        each_row(group, [&](std::uint32_t node, std::uint32_t row) {
            const RowLaw& law = laws_[row];
            right_[row] =
                law.open ? law.speed_wanted - speed(joints_[node], rows_[row]) - softened(node, row) : 0;
            worst = std::max(worst, std::fabs(right_[row]));
        });
        if (!(worst > small_speed)) break;
        matrix_.solve(group.first_joint, group.last_joint, right_);
        each_row(group, [&](std::uint32_t node, std::uint32_t row) {
            if (laws_[row].open) set_impulse(joints_[node], row, rows_[row].impulse + right_[row]);
        });
    }
}

/// Moves the bodies so that the errors of position are put right. Springs and limits that are kept to have
/// none.
template <int D>
void DirectSolver<D>::mend(const Group& group) {
    bool as_before = true;
    double errors = 0;
    each_row(group, [&](std::uint32_t node, std::uint32_t row) {
        const DirectJoint<D>& joint = joints_[node];
        const int part = joint.part_of(static_cast<int>(row - joint.first_row));
        const bool holds = part >= 2 ? rows_[row].error != 0 : !joint.is_held(part);
        as_before = as_before && holds == (open_[row] != 0) && laws_[row].softness == 0;
        open_[row] = holds ? 1 : 0;
        right_[row] = holds ? -rows_[row].error : 0;
        errors += std::fabs(right_[row]);
    });
    if (errors == 0) return;
    if (!as_before) {
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_diagonal(k, false);
        matrix_.factorise(group.first_joint, group.last_joint, open_);
    }
    matrix_.solve(group.first_joint, group.last_joint, right_);
    clear_wanted(group);
    each_row(group, [&](std::uint32_t node, std::uint32_t row) {
        Member &a = members_[joints_[node].a], &b = members_[joints_[node].b];
        const Effect& e = effects_[row];
        const double by = right_[row];
        a.wanted -= by * e.push_a;
        a.wanted_spin = a.wanted_spin - e.turn_a * by;
        b.wanted += by * e.push_b;
        b.wanted_spin = b.wanted_spin + e.turn_b * by;
    });
    shift(group, 10 * errors);
}

/// Moves bodies by what they are wanted to go, but none further than `reach`, in m and rad. Where rows
/// nearly depend on one another, a small error would throw bodies far away.
template <int D>
void DirectSolver<D>::shift(const Group& group, double reach) {
    double furthest = 0;
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        const Member& m = members_[i];
        furthest = std::max(furthest, dot(m.wanted, m.wanted) + angular_dot(m.wanted_spin, m.wanted_spin));
    }
    const double share = furthest > reach * reach ? reach / std::sqrt(furthest) : 1;
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        m.motion.moved += share * m.wanted;
        m.motion.turned = m.motion.turned + m.wanted_spin * share;
    }
}

/// Keeps the impulses for the next pass.
template <int D>
void DirectSolver<D>::keep_impulses(DirectJoint<D>& joint) {
    const std::span<Row> rows = rows_of(joint);
    for (std::size_t r = 0; r < rows.size(); ++r) joint.impulses[r] = rows[r].impulse;
    const int first = joint.linear_rows();
    if (joint.angular_rows() == 0 || joint.rows().angular == AngularPart::square) return;
    joint.across_impulse = {};
    for (int i = 0; i < joint.angular_rows(); ++i) {
        const Row& row = rows[static_cast<std::size_t>(first + i)];
        joint.across_impulse = joint.across_impulse + row.middle.on_b * row.impulse;
    }
}

/// Solves the rows as laid, until limits, motors and friction agree on which of them hold. In the end no
/// limit pulls. Where speeds are measured along the directions of the impulses, what was found is then the
/// nearest of all velocities that the limits allow which hold, and has no more energy than the velocities
/// without the joints (as to stand still is allowed, too).
template <int D>
void DirectSolver<D>::solve_as_laid(const Group& group) {
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_effects(joints_[k]);
    assemble(group);
    for (int round = 0;; ++round) {
        const Search search = round < free_rounds   ? Search::free
                              : round < most_rounds ? Search::releasing
                                                    : Search::ending;
        if (!find_laws(group, search) && round > 0) break;
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_diagonal(k, true);
        each_row(group, [&](std::uint32_t, std::uint32_t row) { open_[row] = laws_[row].open ? 1 : 0; });
        matrix_.factorise(group.first_joint, group.last_joint, open_);
        solve_rows(group);
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) split_friction(k);
    }
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) keep_impulses(joints_[k]);
}

/// Where velocities and directions do not come to agree: from the velocities without the joints to the
/// nearest that the rows allow, with impulses and speeds along the same directions. That takes energy away
/// and never gives any.
template <int D>
void DirectSolver<D>::project(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        m.motion.v = m.free;
        m.motion.w = m.free_spin;
        m.given = {};
        m.given_spin = {};
    }
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        DirectJoint<D>& joint = joints_[k];
        joint.impulses = {};
        joint.across_impulse = joint.rubbed = {};
        lay<true>(joint);
        for (Row& row : rows_of(joint)) row.end = row.middle;
        arms_[k] = {};
    }
    stiffen(group);
    solve_as_laid(group);
}

/// The velocities that are found turn the directions along which they were found; so it is done again.
template <int D>
void DirectSolver<D>::solve_group(const Group& group) {
    for (int turn = 0; turn < most_turns; ++turn) {
        for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
            members_[i].laid_velocity = members_[i].motion.v;
            members_[i].laid_spin = members_[i].motion.w;
        }
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
            lay<true>(joints_[k]);
            if (turn == 0) joints_[k].set_offsets(rows_of(joints_[k]));
        }
        stiffen(group);
        if (turn == 0) take_back(group);
        re_aim(group);
        solve_as_laid(group);
        if (misdirection(group) < small_change) break;
    }
    if (!(misdirection(group) < most_misdirection) || gains_energy(group)) project(group);
    mend(group);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        joints_[k].before = joints_[k].wrench;
        joints_[k].wrench = wrench_of(joints_[k]);
    }
}

/// Brings velocities to where the bodies are now, by impulses along the directions that they have there.
template <int D>
void DirectSolver<D>::relax_group(const Group& group) {
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        lay<false>(joints_[k]);
        for (Row& row : rows_of(joints_[k])) row.middle = row.end;
    }
    answer_by_mass(group);
    solve_more(group);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) note_speeds(joints_[k]);
}

/// Adds to the impulses of the sub-step. Where they act along the directions in which speeds are measured,
/// and bodies answer by their mass alone, that gives the nearest velocities that the rows allow, and never
/// more energy, however often it is done.
template <int D>
void DirectSolver<D>::solve_more(const Group& group) {
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k)
        add(joints_[k].wrench, -1.0 * wrench_of(joints_[k]));
    solve_as_laid(group);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k)
        add(joints_[k].wrench, wrench_of(joints_[k]));
}

/// What the impulses of a joint are on its bodies along the directions as laid.
template <int D>
auto DirectSolver<D>::wrench_of(const DirectJoint<D>& joint) const -> Side {
    Side sum{};
    for (int r = 0; r < joint.row_count(); ++r) {
        const Row& row = rows_[joint.first_row + static_cast<std::uint32_t>(r)];
        add(sum, row.impulse * row.middle);
    }
    return sum;
}

/// What the joint has done in this sub-step, and how fast its coordinates are at the end of it.
template <int D>
void DirectSolver<D>::note_speeds(DirectJoint<D>& joint) {
    const std::span<Row> rows = rows_of(joint);
    add(joint.total, joint.wrench);
    for (std::size_t r = 0; r < rows.size(); ++r) joint.before_speed[r] = speed(joint, rows[r]);
}

template <int D>
void DirectSolver<D>::solve(const RecordView<D>& bodies, const Crew& crew) {
    const Part part = crew.part(groups_.size());
    for (std::size_t i = part.begin; i < part.end; ++i) {
        gather_members(groups_[i], bodies);
        solve_group(groups_[i]);
        scatter_members(groups_[i], bodies, true);
    }
}

template <int D>
bool DirectSolver<D>::pick(std::span<const std::uint32_t> slots) {
    constexpr std::uint32_t no_group = ~std::uint32_t{0};
    picked_.clear();
    for (const std::uint32_t slot : slots) {
        if (group_of_[slot] != no_group) picked_.push_back(group_of_[slot]);
    }
    std::ranges::sort(picked_);
    const auto doubles = std::ranges::unique(picked_);
    picked_.erase(doubles.begin(), doubles.end());
    return !picked_.empty();
}

template <int D>
void DirectSolver<D>::settle(const RecordView<D>& bodies, bool before_moving) {
    for (const std::uint32_t i : picked_) {
        const Group& group = groups_[i];
        gather_members(group, bodies);
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
            DirectJoint<D>& joint = joints_[k];
            for (Row& row : rows_of(joint)) row.end = row.middle;
            if (!before_moving) add(joint.total, -1.0 * joint.wrench);
        }
        solve_more(group);
        for (std::uint32_t k = group.first_joint; k < group.last_joint && !before_moving; ++k)
            note_speeds(joints_[k]);
        scatter_members(group, bodies, false);
    }
}

template <int D>
void DirectSolver<D>::relax(const RecordView<D>& bodies, const Crew& crew) {
    const Part part = crew.part(groups_.size());
    for (std::size_t i = part.begin; i < part.end; ++i) {
        gather_members(groups_[i], bodies);
        relax_group(groups_[i]);
        scatter_members(groups_[i], bodies, false);
    }
}

template class DirectSolver<2>;
template class DirectSolver<3>;

}  // namespace carom::detail
