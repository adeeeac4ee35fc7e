#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/body.hpp"
#include "core/short_list.hpp"
#include "math/dim.hpp"

namespace carom::detail {

/// Where a body is and how it moves. All `double`, so that a free flight is exact to rounding and far away
/// is as good as near.
template <int D>
struct BodyState {
    Vec<D> position{};  ///< centre of mass in the world
    Rotation<D> rotation{};
    Vec<D> velocity{};
    Angular<D> angular_velocity{};
    double turns = 0;  ///< 2D: whole turns that `rotation` does not show
};

/// What a body's motion depends on beside its state.
template <int D>
struct BodyMass {
    double mass = 0;          ///< 0 unless dynamic
    double inverse_mass = 0;  ///< 0 unless dynamic
    Vec<D> center{};          ///< centre of mass in the body's frame
    Inertia<D> inertia{};     ///< in the body's frame, about the centre of mass
    Inertia<D> inverse_inertia{};
    double radius = 0;         ///< of a ball about the centre of mass that holds every shape
    double core_radius = 0;    ///< of the smallest ball that no wall may pass (see world/continuous.cpp)
    double cross_section = 0;  ///< of a ball of the same measure as the shapes (see `Wind`)
    double gravity_scale = 1;
    double linear_damping = 0;
    double angular_damping = 0;
    Locks locks{};
    bool isotropic = true;  ///< the inertia is the same about every axis: rotation does not precess
};

/// Force and torque (about the centre of mass) that act on a body through a step.
template <int D>
struct Load {
    Vec<D> force{};
    Angular<D> torque{};
};

/// What the user gave in place of what the shapes say.
template <int D>
struct MassOverrides {
    std::optional<double> mass{};
    std::optional<Vec<D>> center_of_mass{};
    std::optional<Inertia<D>> inertia{};
};

/// What few bodies have.
template <int D>
struct BodyExtras {
    std::vector<std::uint32_t> ignored;  ///< indices of the bodies with which it does not collide, ascending
    std::vector<std::uint32_t> jointed;  ///< the same because of joints: once for each
    std::string name;
    std::optional<MassOverrides<D>> overrides;
};

/// What else the world knows of a body.
template <int D>
struct BodyInfo {
    bool awake = true;
    bool can_sleep = true;
    bool bullet = false;
    bool disabled = false;  ///< quarantined: it stays where it is and nothing touches it
    double rest_time = 0;   ///< how long it has been slow and in its place, s
    Transform<D> rest{};    ///< that place: centre of mass and rotation when the rest began
    ShortList<ShapeId<D>> shapes;
    std::uint64_t user_data = 0;
    std::unique_ptr<BodyExtras<D>> extras;  ///< nothing where there are none

    /// To read.
    const BodyExtras<D>& seen() const {
        static const BodyExtras<D> none;
        return extras ? *extras : none;
    }
    /// To write.
    BodyExtras<D>& own() {
        if (!extras) extras = std::make_unique<BodyExtras<D>>();
        return *extras;
    }
};

/// Placement of the body's frame.
template <int D>
Transform<D> frame(const BodyState<D>& state, const BodyMass<D>& mass) {
    return {state.position - rotate(state.rotation, mass.center), state.rotation};
}

/// Inverse inertia tensor in the world's axes, zero about the locked ones.
template <int D>
Inertia<D> world_inverse_inertia(const BodyMass<D>& mass, const Rotation<D>& rotation);

/// The vector with its locked components set to zero.
template <int D>
Vec<D> free_components(const Locks& locks, Vec<D> v) {
    if (locks.x) v.x = 0;
    if (locks.y) v.y = 0;
    if constexpr (D == 3) {
        if (locks.z) v.z = 0;
    }
    return v;
}
template <int D>
Angular<D> free_spin(const Locks& locks, Angular<D> w) {
    if constexpr (D == 2) {
        return locks.rz ? 0.0 : w;
    } else {
        return {locks.rx ? 0.0 : w.x, locks.ry ? 0.0 : w.y, locks.rz ? 0.0 : w.z};
    }
}

/// Turns the state by the rotation vector `angle` (2D: an angle), counting whole turns in 2D.
template <int D>
void turn(BodyState<D>& state, const Angular<D>& angle);

/// The angle with whole turns.
double whole_angle(const BodyState<2>& state);

/// Kinetic energy, J.
template <int D>
double kinetic_energy(const BodyState<D>& state, const BodyMass<D>& mass);

}  // namespace carom::detail
