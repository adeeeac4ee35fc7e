#pragma once

namespace carom::detail {

/// Where one point of contact is at the end of the step after it bounced.
struct Rebound {
    bool bounces = false;
    double speed = 0;  ///< of separation, m/s
    double gap = 0;    ///< m
};

/// The flight of one point of contact through a step, with the impact at its own time. The point starts with
/// the gap s₀ and the speed of separation v₀ under the constant relative acceleration a. It meets the surface
/// with vᵢ² = v₀² − 2 a s₀ (energy) at τ = 2 s₀ / (vᵢ − v₀), leaves with u = e vᵢ, and has then time for more
/// bounces while 2u / |a| is less than what is left of the step. So the height of a bounce does not depend on
/// the step, and a bounce with e = 1 keeps the energy. An impact slower than `threshold` does not bounce.
Rebound rebound(double restitution, double gap, double speed, double acceleration, double step,
                double threshold);

}  // namespace carom::detail
