#include "solver/direct.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace carom::detail {

namespace {

/// Compliance of the rows, in parts of their own: where rows say what others say as well, they share the
/// impulse. That cannot be in a tree.
constexpr double compliance_in_tree = 1e-10, compliance_in_loops = 1e-6;
constexpr int free_rounds = 3;         ///< in which limits, motors and friction find which of them hold
constexpr int most_rounds = 12;        ///< with those in which they only let go
constexpr int most_sweeps = 4;         ///< of refinement
constexpr double small_speed = 1e-10;  ///< m/s and rad/s
constexpr int most_turns = 4;          ///< in which directions and velocities agree
constexpr double small_change = 1e-5;  ///< rad and m in a sub-step

template <int D>
Motion<D, double> widen(const Motion<D, float>& m) {
    return {narrow<double>(m.v), narrow<double>(m.w), narrow<double>(m.moved), narrow<double>(m.turned)};
}
template <int D>
Weight<D, double> widen(const Weight<D, float>& w) {
    return {narrow<double>(w.mass), narrow<double>(w.inertia)};
}

template <int D>
Wrench<D, double> operator*(double factor, const Wrench<D, double>& w) {
    return {factor * w.force, w.on_a * factor, w.on_b * factor};
}

Vec<2> times(const Symmetric3<double>& m, const Vec<2>& v) {
    return {m.xx * v.x + m.xy * v.y, m.xy * v.x + m.yy * v.y};
}
Vec<3> times(const Symmetric3<double>& m, const Vec<3>& v) { return m * v; }

// With stiffness G beside a mass or inertia M, of which the inverse W is known: W' = (M + G)⁻¹, and W' M v
// for what is left of a change v. Locked axes have no inverse; what is stiff about others is then left out
// there.

Symmetric3<double> inverse_with(const Vec<2>& w, const Symmetric3<double>& g) {
    const double x = std::sqrt(w.x), y = std::sqrt(w.y);
    const double xx = 1 + x * g.xx * x, yy = 1 + y * g.yy * y, xy = x * g.xy * y, d = xx * yy - xy * xy;
    return {x * yy * x / d, y * xx * y / d, 0, -x * xy * y / d, 0, 0};
}
Symmetric3<double> inverse_with(const Vec<3>& w, const Symmetric3<double>& g) {
    const double x = std::sqrt(w.x), y = std::sqrt(w.y), z = std::sqrt(w.z);
    const Symmetric3<double> i = inverse(Symmetric3<double>{
        1 + x * g.xx * x, 1 + y * g.yy * y, 1 + z * g.zz * z, x * g.xy * y, x * g.xz * z, y * g.yz * z});
    return {x * i.xx * x, y * i.yy * y, z * i.zz * z, x * i.xy * y, x * i.xz * z, y * i.yz * z};
}
double inverse_with(double w, double g) { return w / (1 + w * g); }
Symmetric3<double> inverse_with(const Symmetric3<double>& w, const Symmetric3<double>& g) {
    if (trace(g) == 0) return w;
    if (is_positive_definite(w)) return inverse(inverse(w) + g);
    return w * (1 / (1 + trace(g) * trace(w)));
}

template <int D>
Vec<D> share(const Vec<D>& w, const Symmetric3<double>& answer, const Vec<D>& v) {
    Vec<D> impulse{};
    for (int i = 0; i < D; ++i) impulse[i] = w[i] > 0 ? v[i] / w[i] : 0;
    return times(answer, impulse);
}
double share(double w, double answer, double v) { return w > 0 ? answer / w * v : 0; }
Vec3 share(const Symmetric3<double>& w, const Symmetric3<double>& answer, const Vec3& v) {
    if (is_positive_definite(w)) return answer * (inverse(w) * v);
    return trace(w) > 0 ? trace(answer) / trace(w) * v : Vec3{};
}

template <int D>
void add(Wrench<D, double>& sum, const Wrench<D, double>& w) {
    sum.force += w.force;
    sum.on_a = sum.on_a + w.on_a;
    sum.on_b = sum.on_b + w.on_b;
}

}  // namespace

// ---- Structure ----

template <int D>
void DirectSolver<D>::set_step(double substep) {
    const JointStep<float> step = joint_step(substep);
    step_ = {substep, 1 / substep, step.share, step.most_way};
}

template <int D>
void DirectSolver<D>::plan(const JointInput<D>& input, std::span<const std::uint32_t> joints,
                           std::span<const std::uint32_t> group_starts) {
    joints_.clear();
    groups_.clear();
    members_.clear();
    ties_.clear();
    for (std::size_t i = 0; i < group_starts.size(); ++i) {
        const std::size_t end = i + 1 < group_starts.size() ? group_starts[i + 1] : joints.size();
        add_group(input, joints.subspan(group_starts[i], end - group_starts[i]));
    }
    std::vector<std::uint8_t> sizes;
    std::vector<NodePair> pairs;
    for (const DirectJoint<D>& j : joints_) sizes.push_back(static_cast<std::uint8_t>(j.row_count()));
    for (const Tie& tie : ties_) pairs.push_back({tie.row, tie.column});
    matrix_.plan(sizes, pairs);
    for (Tie& tie : ties_) tie.place = matrix_.place({tie.row, tie.column});
    for (std::uint32_t k = 0; k < joints_.size(); ++k) joints_[k].first_row = matrix_.first_row(k);
    rows_.assign(matrix_.rows(), {});
    effects_.assign(matrix_.rows(), {});
    laws_.assign(matrix_.rows(), {});
    open_.assign(matrix_.rows(), 1);
    constexpr std::size_t n = DirectJoint<D>::most_rows;
    own_.assign(joints_.size() * n * n, 0);
    arms_.assign(joints_.size(), {});
    right_.assign(matrix_.rows(), 0);
}

template <int D>
void DirectSolver<D>::add_group(const JointInput<D>& input, std::span<const std::uint32_t> joints) {
    Group group;
    group.first_joint = static_cast<std::uint32_t>(joints_.size());
    group.first_body = static_cast<std::uint32_t>(members_.size());
    std::map<std::uint32_t, std::vector<std::uint32_t>> joints_of;  // by slot, of bodies that can be pushed
    std::map<std::uint32_t, std::uint32_t> member_of;
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
        const JointRecord<D>& joint = input.joints[joints[i]];
        for (const std::uint32_t slot : {input.slot_of(joint.body_a), input.slot_of(joint.body_b)}) {
            if (member_of.emplace(slot, static_cast<std::uint32_t>(members_.size())).second)
                members_.push_back({slot});
            if (slot >= input.bodies.first_movable) joints_of[slot].push_back(i);
        }
    }
    std::vector<NodePair> edges;
    for (const auto& [slot, list] : joints_of) {
        for (std::size_t p = 0; p < list.size(); ++p) {
            for (std::size_t q = 0; q < p; ++q) {
                if (list[p] != list[q]) edges.push_back({list[p], list[q]});
            }
        }
    }
    for (const std::uint32_t i : elimination_order(static_cast<std::uint32_t>(joints.size()), edges)) {
        const JointRecord<D>& record = input.joints[joints[i]];
        DirectJoint<D> joint;
        joint.joint = joints[i];
        joint.layout = record.layout;
        joint.a = member_of[input.slot_of(record.body_a)];
        joint.b = member_of[input.slot_of(record.body_b)];
        joints_.push_back(joint);
    }
    group.last_joint = static_cast<std::uint32_t>(joints_.size());
    group.last_body = static_cast<std::uint32_t>(members_.size());
    group.first_tie = static_cast<std::uint32_t>(ties_.size());
    std::vector<std::vector<NodePair>> by_body(members_.size() - group.first_body);  // joint, is it body a?
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        for (const bool is_a : {true, false}) {
            const std::uint32_t body = is_a ? joints_[k].a : joints_[k].b;
            if (members_[body].slot < input.bodies.first_movable) continue;
            auto& list = by_body[body - group.first_body];
            for (const NodePair& other : list) {
                if (other.row != k) ties_.push_back({k, other.row, is_a, other.column != 0, 0});
            }
            list.push_back({k, is_a});
        }
    }
    group.last_tie = static_cast<std::uint32_t>(ties_.size());
    groups_.push_back(group);
    // Each joint of a tree brings a body of its own along; those to what stands still count as one body.
    const std::size_t still = group.last_body - group.first_body - joints_of.size();
    const bool is_tree = joints.size() < joints_of.size() + std::min<std::size_t>(still, 1);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k)
        joints_[k].compliance = is_tree ? compliance_in_tree : compliance_in_loops;
}

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

/// What a unit of impulse does to the bodies.
template <int D>
void DirectSolver<D>::set_effects(const DirectJoint<D>& joint) {
    const Member &a = members_[joint.a], &b = members_[joint.b];
    const std::span<Row> rows = rows_of(joint);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Side& w = rows[r].middle;
        effects_[joint.first_row + r] = {times(a.answer, w.force), times(b.answer, w.force),
                                         a.turn_answer * w.on_a, b.turn_answer * w.on_b};
    }
}

/// How the forces of a joint change when its bodies turn and move within the sub-step, by the directions of
/// its middle: for a force F at an arm r, half the length of the sub-step times ½ (r · F + |r| |F|) across r,
/// which is the derivative where both are parallel, and never negative. A rod under tension is turned by its
/// ends as well, which counts double, as each of them sees the other one stand still.
template <int D>
void DirectSolver<D>::stiffen_by(const DirectJoint<D>& joint, const JointArms<D>& arms) {
    Member &a = members_[joint.a], &b = members_[joint.b];
    const double half = 0.5 * step_.h;
    const auto turn = [&](Member& m, const Vec<D>& arm, double by) {
        const double squared = dot(arm, arm);
        if (squared == 0) return;
        if constexpr (D == 2) {
            m.turn_stiffness += by;
        } else {
            m.turn_stiffness = m.turn_stiffness + (diagonal(by, by, by) - outer_square(arm) * (by / squared));
        }
    };
    const auto load = [&](const Vec<D>& force, const Vec<D>& arm_a) {
        const double size = length(force);
        turn(a, arm_a, 0.5 * half * (length(arm_a) * size - dot(arm_a, force)));
        turn(b, arms.b, 0.5 * half * (length(arms.b) * size + dot(arms.b, force)));
    };
    const std::span<const Row> rows = rows_of(joint);
    Vec<D> force{};
    for (int r = 0; r < joint.row_count(); ++r) {
        const Row& row = rows[static_cast<std::size_t>(r)];
        const int drive = r - joint.first_drive();
        if (drive < 0 || joint.rows().drives[static_cast<std::size_t>(drive)] != DriveKind::stretch) {
            force += row.impulse * row.middle.force;
            continue;
        }
        load(row.impulse * row.middle.force, arms.a);
        const double way = length(arms.gap);
        if (!(row.impulse < 0 && way > 1e-6)) continue;
        const double by = 2 * half * -row.impulse / way;
        for (Member* m : {&a, &b}) {
            const Vec<D>& n = row.middle.force;
            if constexpr (D == 2) {
                m->stiffness = m->stiffness +
                               Symmetric3<double>{by * n.y * n.y, by * n.x * n.x, 0, -by * n.x * n.y, 0, 0};
            } else {
                m->stiffness = m->stiffness + (diagonal(by, by, by) - outer_square(n) * by);
            }
        }
        turn(a, arms.a, by * dot(arms.a, arms.a));
        turn(b, arms.b, by * dot(arms.b, arms.b));
    }
    load(force, arms.a + arms.gap);
}

/// How bodies answer to impulses, with the stiffness that their loads give them ("geometric stiffness",
/// Tournier et al. 2015, of which each body keeps its own part, Andrews et al. 2017). It changes the way to
/// the solution alone: rows are laid along the directions of the middle of the sub-step, which the new
/// velocities say.
template <int D>
void DirectSolver<D>::stiffen(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        members_[i].stiffness = {};
        members_[i].turn_stiffness = {};
    }
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) stiffen_by(joints_[k], arms_[k]);
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        m.answer = inverse_with(m.weight.mass, m.stiffness);
        m.turn_answer = inverse_with(m.weight.inertia, m.turn_stiffness);
    }
}

/// Takes back what the joints gave the bodies in the sub-step before. It was good to say where they go; but
/// what is so stiff that the directions are not found would keep it, and be driven by it.
template <int D>
void DirectSolver<D>::take_back(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        m.motion.v -= m.given;
        m.motion.w = m.motion.w - m.given_spin;
        m.given = {};
        m.given_spin = {};
    }
}

/// What the joints have given the bodies becomes what their impulses are along the directions as laid.
template <int D>
void DirectSolver<D>::re_aim(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        members_[i].wanted = {};
        members_[i].wanted_spin = {};
    }
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        Member &a = members_[joints_[k].a], &b = members_[joints_[k].b];
        Wrench<D, double> w{};
        for (const Row& row : rows_of(joints_[k])) add(w, row.impulse * row.middle);
        a.wanted -= w.force;
        a.wanted_spin = a.wanted_spin - w.on_a;
        b.wanted += w.force;
        b.wanted_spin = b.wanted_spin + w.on_b;
    }
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        const Vec<D> change = share(m.weight.mass, m.answer, each(m.weight.mass, m.wanted) - m.given);
        const Angular<D> spin = share(m.weight.inertia, m.turn_answer,
                                      Angular<D>(m.weight.inertia * m.wanted_spin - m.given_spin));
        m.motion.v += change;
        m.given += change;
        m.motion.w = m.motion.w + spin;
        m.given_spin = m.given_spin + spin;
    }
}

/// Do the directions as laid differ from those that the velocities say now?
template <int D>
bool DirectSolver<D>::has_turned(const Group& group) const {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        const Angular<D> change = members_[i].motion.w - members_[i].laid_spin;
        const Vec<D> way = members_[i].motion.v - members_[i].laid_velocity;
        const double squared = angular_dot(change, change) + dot(way, way);
        if (step_.h * step_.h * squared > small_change * small_change) return true;
    }
    return false;
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

/// The joint's own block on the diagonal.
template <int D>
void DirectSolver<D>::weigh(std::uint32_t node) {
    const std::span<Row> rows = rows_of(joints_[node]);
    constexpr std::size_t n = DirectJoint<D>::most_rows;
    double* to = own_.data() + node * n * n;
    for (std::size_t r = 0; r < rows.size(); ++r) {
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
            if (with_springs && joint.part_of(r) == joint.part_of(c)) *to *= 1 + softness;
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
            sum += own(node, r, c) * (rows_[other].impulse - laws_[other].given);
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
    each_row(group, [&](std::uint32_t node, std::uint32_t row) {
        const DirectJoint<D>& joint = joints_[node];
        const int part = joint.part_of(static_cast<int>(row - joint.first_row));
        const bool holds = part >= 2 ? rows_[row].error != 0 : !joint.is_held(part);
        as_before = as_before && holds == (open_[row] != 0) && laws_[row].softness == 0;
        open_[row] = holds ? 1 : 0;
        right_[row] = holds ? -rows_[row].error : 0;
    });
    if (!as_before) {
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_diagonal(k, false);
        matrix_.factorise(group.first_joint, group.last_joint, open_);
    }
    matrix_.solve(group.first_joint, group.last_joint, right_);
    each_row(group, [&](std::uint32_t node, std::uint32_t row) {
        Motion<D, double>&a = members_[joints_[node].a].motion, &b = members_[joints_[node].b].motion;
        const Effect& e = effects_[row];
        const double by = right_[row];
        a.moved -= by * e.push_a;
        a.turned = a.turned - e.turn_a * by;
        b.moved += by * e.push_b;
        b.turned = b.turned + e.turn_b * by;
    });
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

/// Solves the rows as laid, until limits, motors and friction agree on which of them hold.
template <int D>
void DirectSolver<D>::solve_as_laid(const Group& group) {
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_effects(joints_[k]);
    assemble(group);
    for (int round = 0; round < most_rounds; ++round) {
        const bool changed = find_laws(group, round >= free_rounds);
        if (round > 0 && !changed) break;
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) set_diagonal(k, true);
        each_row(group, [&](std::uint32_t, std::uint32_t row) { open_[row] = laws_[row].open ? 1 : 0; });
        matrix_.factorise(group.first_joint, group.last_joint, open_);
        solve_rows(group);
        for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) split_friction(k);
    }
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) keep_impulses(joints_[k]);
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
        if (!has_turned(group)) break;
    }
    mend(group);
}

template <int D>
void DirectSolver<D>::relax_group(const Group& group) {
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) lay<false>(joints_[k]);
    solve_as_laid(group);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        DirectJoint<D>& joint = joints_[k];
        const std::span<Row> rows = rows_of(joint);
        joint.before = joint.wrench;
        joint.wrench = {};
        for (const Row& row : rows) add(joint.wrench, row.impulse * row.middle);
        add(joint.total, joint.wrench);
        for (std::size_t r = 0; r < rows.size(); ++r) joint.before_speed[r] = speed(joint, rows[r]);
    }
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
