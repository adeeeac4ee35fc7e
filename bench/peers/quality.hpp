#pragma once

#include "carom/world.hpp"

namespace carom::peers {

/// How well a scene stands at its end, measured alike for all engines: in a world of ours, from places and
/// velocities alone.
struct Quality {
    double deepest = 0;  ///< deepest overlap of two shapes, m
    double aside = 0;    ///< way of the body that was added last, sideways, m
    double sunk = 0;     ///< and downwards, m
    double speed = 0;    ///< root of the mean square, by mass, of the speeds, turning included, m/s
};

template <int D>
Quality quality(const World<D>& world, const Vec<D>& start_of_last);

}  // namespace carom::peers
