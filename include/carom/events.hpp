#pragma once

#include "carom/body.hpp"
#include "carom/ids.hpp"
#include "carom/vec.hpp"

namespace carom {

// What happened in the last step, as buffers that the world fills while it steps; they stay as they are until
// the next step. Their order depends on nothing but what happened. A shape that was removed is named by its
// old handle, which `World::contains` refuses.

/// Two shapes, and the bodies that carry them. In a contact, the normal points from a to b.
template <int D>
struct ShapePair {
    BodyId<D> body_a{}, body_b{};
    ShapeId<D> shape_a{}, shape_b{};

    friend bool operator==(const ShapePair&, const ShapePair&) = default;
};

/// Two shapes touch that did not touch before the step.
template <int D>
struct ContactBegin : ShapePair<D> {
    Vec<D> point{};   ///< in the world, m
    Vec<D> normal{};  ///< unit
};

/// Two shapes touch no longer, or one of them was removed.
template <int D>
struct ContactEnd : ShapePair<D> {};

/// Two shapes came together faster than `WorldDefinition::hit_speed`.
template <int D>
struct ContactHit : ShapePair<D> {
    Vec<D> point{};             ///< where they met hardest, in the world, m
    Vec<D> normal{};            ///< unit
    double approach_speed = 0;  ///< along the normal, at the point, before the impact, m/s
    double impulse = 0;         ///< of the whole contact along the normal in this step, N·s
    double energy_lost = 0;     ///< work that this contact took from the two bodies in this step, J
};

/// A shape came to overlap a sensor (`shape_a` is the sensor's).
template <int D>
struct SensorBegin : ShapePair<D> {};

/// A shape overlaps a sensor no longer, or one of the two was removed.
template <int D>
struct SensorEnd : ShapePair<D> {};

}  // namespace carom
