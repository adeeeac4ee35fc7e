#include <algorithm>
#include <cmath>

#include "solver/direct.hpp"
#include "solver/prepare.hpp"

// How bodies that are solved directly answer to impulses, and what the impulses that they have make of them.

namespace carom::detail {

namespace {

constexpr double most_gain = 3e-3;  ///< of kinetic energy, by rows that drive nothing

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

// What changes a velocity by v, where the inverse of the mass or inertia is w.

template <int D>
Vec<D> momentum(const Vec<D>& w, const Vec<D>& v) {
    Vec<D> impulse{};
    for (int i = 0; i < D; ++i) impulse[i] = w[i] > 0 ? v[i] / w[i] : 0;
    return impulse;
}
double momentum(double w, double v) { return w > 0 ? v / w : 0; }
Vec3 momentum(const Symmetric3<double>& w, const Vec3& v) {
    if (is_positive_definite(w)) return inverse(w) * v;
    return trace(w) > 0 ? 1 / trace(w) * v : Vec3{};
}

template <int D>
Vec<D> share(const Vec<D>& w, const Symmetric3<double>& answer, const Vec<D>& v) {
    return times(answer, momentum(w, v));
}
double share(double w, double answer, double v) { return answer * momentum(w, v); }
Vec3 share(const Symmetric3<double>& w, const Symmetric3<double>& answer, const Vec3& v) {
    if (is_positive_definite(w)) return answer * (inverse(w) * v);
    return trace(w) > 0 ? trace(answer) / trace(w) * v : Vec3{};
}

}  // namespace

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

/// Lets bodies answer as they are.
template <int D>
void DirectSolver<D>::answer_by_mass(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        Member& m = members_[i];
        m.answer = inverse_with(m.weight.mass, {});
        m.turn_answer = m.weight.inertia;
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
        m.free = m.motion.v;
        m.free_spin = m.motion.w;
    }
}

template <int D>
void DirectSolver<D>::clear_wanted(const Group& group) {
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        members_[i].wanted = {};
        members_[i].wanted_spin = {};
    }
}

/// Sums up what the impulses of the joints are on the bodies along the directions as laid.
template <int D>
void DirectSolver<D>::sum_wanted(const Group& group) {
    clear_wanted(group);
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        Member &a = members_[joints_[k].a], &b = members_[joints_[k].b];
        const Side w = wrench_of(joints_[k]);
        a.wanted -= w.force;
        a.wanted_spin = a.wanted_spin - w.on_a;
        b.wanted += w.force;
        b.wanted_spin = b.wanted_spin + w.on_b;
    }
}

/// What the joints have given the bodies becomes what their impulses are along the directions as laid.
template <int D>
void DirectSolver<D>::re_aim(const Group& group) {
    sum_wanted(group);
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

/// By how much bodies go and turn in a sub-step otherwise than as the rows were laid, at most; m and rad.
template <int D>
double DirectSolver<D>::misdirection(const Group& group) const {
    double most = 0;
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        const Angular<D> change = members_[i].motion.w - members_[i].laid_spin;
        const Vec<D> way = members_[i].motion.v - members_[i].laid_velocity;
        most = std::max(most, angular_dot(change, change) + dot(way, way));
    }
    return step_.h * std::sqrt(most);
}

/// Is it a motor that holds the row at its speed?
template <int D>
bool DirectSolver<D>::is_driven(std::uint32_t node, std::uint32_t row) const {
    const DirectJoint<D>& joint = joints_[node];
    const int part = joint.part_of(static_cast<int>(row - joint.first_row));
    if (part < 2 || laws_[row].speed_wanted == 0) return false;
    const DriveBase<D, float>& drive = joint.drives[static_cast<std::size_t>(part - 2)];
    return drive.motor_most > 0 && laws_[row].speed_wanted == drive.motor_speed;
}

/// Was there energy from nowhere? What an impulse does is its product with the mean of the speeds along its
/// direction before and after. Nothing is to come from rows that drive nothing, nor from what bodies were
/// given otherwise than the impulses say, as long as directions were not found.
template <int D>
bool DirectSolver<D>::gains_energy(const Group& group) {
    double gained = 0, kinetic = 0;
    each_row(group, [&](std::uint32_t node, std::uint32_t row) {
        if (!laws_[row].is_firm() || is_driven(node, row)) return;
        const Member &a = members_[joints_[node].a], &b = members_[joints_[node].b];
        const Side& w = rows_[row].middle;
        const double twice = dot(w.force, (b.motion.v + b.free) - (a.motion.v + a.free)) +
                             angular_dot(w.on_b, Angular<D>(b.motion.w + b.free_spin)) -
                             angular_dot(w.on_a, Angular<D>(a.motion.w + a.free_spin));
        gained += 0.5 * rows_[row].impulse * twice;
    });
    sum_wanted(group);
    for (std::uint32_t i = group.first_body; i < group.last_body; ++i) {
        const Member& m = members_[i];
        const Vec<D> astray = m.given - each(m.weight.mass, m.wanted);
        const Angular<D> astray_spin = m.given_spin - m.weight.inertia * m.wanted_spin;
        gained +=
            0.5 * dot(momentum(m.weight.mass, astray), m.motion.v + m.free) +
            0.5 * angular_dot(momentum(m.weight.inertia, astray_spin), Angular<D>(m.motion.w + m.free_spin));
        kinetic += 0.5 * dot(momentum(m.weight.mass, m.free), m.free) +
                   0.5 * angular_dot(momentum(m.weight.inertia, m.free_spin), m.free_spin);
    }
    return !(gained <= most_gain * kinetic);
}

#define CAROM_INSTANTIATE(D)                                           \
    template void DirectSolver<D>::set_effects(const DirectJoint<D>&); \
    template void DirectSolver<D>::stiffen(const Group&);              \
    template void DirectSolver<D>::answer_by_mass(const Group&);       \
    template void DirectSolver<D>::take_back(const Group&);            \
    template void DirectSolver<D>::clear_wanted(const Group&);         \
    template void DirectSolver<D>::re_aim(const Group&);               \
    template double DirectSolver<D>::misdirection(const Group&) const; \
    template bool DirectSolver<D>::gains_energy(const Group&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
