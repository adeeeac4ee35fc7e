#include "dynamics/body.hpp"

#include <cmath>

#include "math/trig.hpp"

namespace carom::detail {

namespace {

/// The inverse of the part of a positive definite tensor that belongs to the free axes; zero elsewhere.
/// A locked axis is one about which the body has infinite inertia: its row and column leave the system.
Symmetric3<double> inverse_of_free_part(const Symmetric3<double>& i, const Locks& locks) {
    const bool x = !locks.rx, y = !locks.ry, z = !locks.rz;
    if (x && y && z) return inverse(i);
    if (x && y) {
        const double det = i.xx * i.yy - i.xy * i.xy;
        return {i.yy / det, i.xx / det, 0, -i.xy / det, 0, 0};
    }
    if (x && z) {
        const double det = i.xx * i.zz - i.xz * i.xz;
        return {i.zz / det, 0, i.xx / det, 0, -i.xz / det, 0};
    }
    if (y && z) {
        const double det = i.yy * i.zz - i.yz * i.yz;
        return {0, i.zz / det, i.yy / det, 0, 0, -i.yz / det};
    }
    return {x ? 1 / i.xx : 0, y ? 1 / i.yy : 0, z ? 1 / i.zz : 0, 0, 0, 0};
}

}  // namespace

template <>
Inertia<2> world_inverse_inertia<2>(const BodyMass<2>& mass, const Rotation<2>&) {
    return mass.locks.rz ? 0.0 : mass.inverse_inertia;
}

template <>
Inertia<3> world_inverse_inertia<3>(const BodyMass<3>& mass, const Rotation<3>& rotation) {
    if (mass.inverse_mass == 0) return {};
    const bool free = !(mass.locks.rx || mass.locks.ry || mass.locks.rz);
    if (free) return mass.isotropic ? mass.inverse_inertia : rotated(mass.inverse_inertia, rotation);
    return inverse_of_free_part(rotated(mass.inertia, rotation), mass.locks);
}

template <>
void turn<2>(BodyState<2>& state, const double& angle) {
    const Rotation2 before = state.rotation;
    const Rotation2 after = normalized(exp_rotation<2>(angle) * before);
    state.rotation = after;
    if (std::fabs(angle) < pi) {
        // Less than half a turn: where the cut at ±π was crossed, the angle in (−π, π] jumped by more than π.
        // ±(1 − cos) grows with that angle, and a difference of π is a difference of 2 of it.
        const auto along = [](const Rotation2& q) { return q.s < 0 ? q.c - 1 : 1 - q.c; };
        const double jump = along(before) - along(after);
        if (std::fabs(jump) > 1 && (jump > 0) == (angle > 0)) state.turns += angle > 0 ? 1 : -1;
    } else {
        const double exact = whole_angle({{}, before, {}, 0, state.turns}) + angle;
        state.turns = std::floor((exact - after.angle()) / (2 * pi) + 0.5);
    }
}

template <>
void turn<3>(BodyState<3>& state, const Vec3& angle) {
    state.rotation = normalized(exp_rotation<3>(angle) * state.rotation);
}

double whole_angle(const BodyState<2>& state) { return state.rotation.angle() + 2 * pi * state.turns; }

template <int D>
double kinetic_energy(const BodyState<D>& state, const BodyMass<D>& mass) {
    const Angular<D> w = state.angular_velocity;
    return 0.5 * (mass.mass * length_squared(state.velocity) +
                  angular_dot(w, rotated(mass.inertia, state.rotation) * w));
}

template double kinetic_energy(const BodyState<2>&, const BodyMass<2>&);
template double kinetic_energy(const BodyState<3>&, const BodyMass<3>&);

}  // namespace carom::detail
