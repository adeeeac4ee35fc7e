#pragma once

#include <cstdint>

#include "carom/ids.hpp"

namespace carom {

/// What keeps a body awake.
enum class Wakefulness : std::uint8_t {
    none,       ///< nothing: it sleeps, is not dynamic, or is in quarantine
    sleep_off,  ///< the settings of the world or the body do not let it sleep
    driven,     ///< it moves, and a motor that has a speed or a target acts on it
    moving,     ///< its centre and its turning make it faster than 0.05 m/s
    settling,   ///< it is slow, but has been, within 1 mm of one place, for less than half a second
    neighbour,  ///< it is at rest itself, but hangs together with a body that is not
};

/// Why a body is awake (see `World::awake_reason`).
template <int D>
struct AwakeReason {
    Wakefulness why = Wakefulness::none;
    /// The body that keeps this `neighbour` awake: the nearest, by contacts, joints and springs.
    BodyId<D> because_of{};
};

}  // namespace carom
