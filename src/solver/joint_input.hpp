#pragma once

#include <cstdint>
#include <span>

#include "carom/joints.hpp"
#include "dynamics/body.hpp"
#include "dynamics/joint.hpp"
#include "solver/body_records.hpp"
#include "solver/body_slots.hpp"
#include "solver/joint_rows.hpp"

namespace carom::detail {

/// A step as the joints see it.
template <int D>
struct JointInput {
    std::span<JointRecord<D>> joints;       ///< all; impulses are read and written
    std::span<const std::uint32_t> active;  ///< indices of those that hold a body which moves freely
    std::span<CouplingRecord<D>> couplings;
    std::span<const std::uint32_t> active_couplings;
    std::span<const BodyState<D>> states;
    std::span<const BodyMass<D>> masses;
    const BodySlots& slots;
    RecordView<D> bodies;
    double substep = 0;  ///< length, s
    JointMethod method = JointMethod::automatic;

    std::uint32_t slot_of(std::uint32_t body) const {
        return body == no_body ? BodySlots::still : slots.slot(body);
    }
};

/// Of the joints of a sub-step of this length.
inline JointStep<float> joint_step(double h) {
    constexpr float mended_share = 0.7f;
    constexpr double mending_speed = 4;  // m/s and rad/s
    return {static_cast<float>(h), static_cast<float>(1 / h), mended_share,
            static_cast<float>(mending_speed * h)};
}

}  // namespace carom::detail
