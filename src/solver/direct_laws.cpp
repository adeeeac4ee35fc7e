#include <cmath>

#include "solver/direct.hpp"
#include "solver/prepare.hpp"

// What limits, motors, springs and friction ask of the joints that are solved directly. Each of them says an
// impulse that falls as the speed grows. A row is solved with the piece of that law on which it would end up
// if its joint stood alone, until no row changes its piece: Newton's method for what is smooth in pieces.

namespace carom::detail {

template <int D>
bool DirectSolver<D>::set_law(std::uint32_t node, std::uint32_t row, const RowLaw& law, Search search) {
    RowLaw& old = laws_[row];
    if (search != Search::free && law.is_firm() && !old.is_firm()) return false;
    if (search == Search::ending && !old.is_firm()) return false;
    // Friction that slides turns a little with every round; that is followed without solving all again.
    const double moved = std::fabs(old.given - law.given);
    const bool changed = old.open != law.open || old.softness != law.softness ||
                         old.speed_wanted != law.speed_wanted ||
                         moved > 0.02 * (std::fabs(old.given) + std::fabs(law.given));
    old = law;
    if (!law.open) set_impulse(joints_[node], row, law.given);
    return changed;
}

/// Returns whether any row is to be solved otherwise than before.
template <int D>
bool DirectSolver<D>::find_laws(const Group& group, Search search) {
    bool changed = false;
    for (std::uint32_t k = group.first_joint; k < group.last_joint; ++k) {
        const DirectJoint<D>& joint = joints_[k];
        for (int part = 0; part < 2; ++part) {
            if (joint.is_held(part) && find_spring_law(k, part, search)) changed = true;
        }
        for (int i = 0; i < joint.rows().drive_count; ++i) {
            if (find_drive_law(k, i, search)) changed = true;
        }
    }
    return changed;
}

template <int D>
bool DirectSolver<D>::find_drive_law(std::uint32_t node, int drive, Search search) {
    const DirectJoint<D>& joint = joints_[node];
    const int r = joint.first_drive() + drive;
    const std::uint32_t row = joint.first_row + static_cast<std::uint32_t>(r);
    const DriveLaw law = drive_law(joint, drive, rows_[row].coordinate, step_);
    const RowLaw& old = laws_[row];
    const auto piece = [&](const DriveLaw& of) {
        return of.piece_at(speed(joint, rows_[row]), rows_[row].impulse, own(node, r, r), alone(node, r, r));
    };
    RowLaw next = piece(law);
    // A limit that pulls lets go, even where that impulse would carry the joint beyond the other one.
    if (search != Search::free && !law.two_way && old.is_firm() && next.is_firm() &&
        next.speed_wanted != old.speed_wanted)
        next = piece(law.let_go());
    return set_law(node, row, next, search);
}

template <int D>
auto DirectSolver<D>::look_at(std::uint32_t node, int part) const -> VectorRows {
    const DirectJoint<D>& joint = joints_[node];
    VectorRows v;
    v.first = part == 0 ? 0 : joint.linear_rows();
    v.count = part == 0 ? joint.linear_rows() : joint.angular_rows();
    const auto block = [&](auto&& element) -> Symmetric3<double> {
        const auto k = [&](int r, int c) {
            if (r < v.count && c < v.count) return element(v.first + r, v.first + c);
            return r == c ? 1.0 : 0.0;
        };
        return {k(0, 0), k(1, 1), k(2, 2), k(0, 1), k(0, 2), k(1, 2)};
    };
    v.compliance = block([&](int r, int c) { return own(node, r, c); });
    v.alone = block([&](int r, int c) { return alone(node, r, c); });
    for (int i = 0; i < v.count; ++i) {
        const Row& row = rows_[joint.first_row + static_cast<std::uint32_t>(v.first + i)];
        v.speed[i] = speed(joint, row);
        v.impulse[i] = row.impulse;
        v.offset[i] = joint.offset[static_cast<std::size_t>(v.first + i)];
    }
    return v;
}

namespace {

Vec3 as_vector(const Vec3& v) { return v; }
Vec3 as_vector(double v) { return {v, 0, 0}; }
void take(const Vec3& from, Vec3& to) { to = from; }
void take(const Vec3& from, double& to) { to = from.x; }

}  // namespace

/// A spring, and in turns friction, of limited size.
template <int D>
bool DirectSolver<D>::find_spring_law(std::uint32_t node, int part, Search search) {
    DirectJoint<D>& joint = joints_[node];
    const VectorRows v = look_at(node, part);
    const SpringRow<float>& spring = joint.spring_of(part);
    const double keep = spring.keep, most = spring.most;
    const Vec3 rubbed = part == 1 ? as_vector(joint.rubbed) : Vec3{}, old = v.impulse - rubbed;
    Vec3 whole{};
    if (keep > 0)
        whole = inverse_or_zero(v.compliance + v.alone * ((1 - keep) / keep)) *
                (v.compliance * old - v.offset - v.speed);
    const Vec3 next = cut_to(whole, most);
    const bool is_elastic = keep > 0 && dot(whole, whole) <= most * most;
    bool sticks = false;
    Vec3 rub{};
    if (part == 1 && joint.friction > 0) {
        // What turns the other way tries first whether it sticks (see `DriveLaw::piece_at`).
        const Vec3 wanted =
            rubbed - 0.01 * (inverse_or_zero(v.compliance) * (v.speed + v.compliance * (next - old)));
        rub = cut_to(wanted, joint.friction);
        sticks = dot(wanted, wanted) <= joint.friction * joint.friction;
        take(rub, joint.rubbed);
    }
    bool changed = false;
    for (int i = 0; i < v.count; ++i) {
        RowLaw law;
        if (!sticks) {
            law.open = is_elastic;
            law.softness = is_elastic ? (1 - keep) / keep : 0;
            law.speed_wanted = is_elastic ? -v.offset[i] : 0;
            law.given = is_elastic ? rub[i] : rub[i] + next[i];
        }
        const std::uint32_t row = joint.first_row + static_cast<std::uint32_t>(v.first + i);
        if (set_law(node, row, law, search)) changed = true;
    }
    return changed;
}

/// Where friction holds the turn, what the spring does not do is its part.
template <int D>
void DirectSolver<D>::split_friction(std::uint32_t node) {
    DirectJoint<D>& joint = joints_[node];
    if (!joint.is_held(1) || joint.friction == 0) return;
    const RowLaw& law = laws_[joint.first_row + static_cast<std::uint32_t>(joint.linear_rows())];
    if (!law.open || law.softness != 0) return;
    const VectorRows v = look_at(node, 1);
    const double keep = joint.angular_spring.keep;
    const Vec3 sprung = -keep / (1 - keep) * (inverse_or_zero(v.alone) * v.offset);
    take(v.impulse - cut_to(sprung, static_cast<double>(joint.angular_spring.most)), joint.rubbed);
}

#define CAROM_INSTANTIATE(D)                                        \
    template bool DirectSolver<D>::find_laws(const Group&, Search); \
    template void DirectSolver<D>::split_friction(std::uint32_t);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
