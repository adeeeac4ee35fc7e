#include "validate/cases.hpp"

namespace carom::app {

std::span<const Case> validation_cases() {
    static constexpr Case cases[] = {
        {"A1", "a projectile, by each integrator", projectile},
        {"A2", "a hundred rounds of a Kepler orbit, by each integrator", kepler_orbit},
        {"A3", "a harmonic oscillator, by each integrator", oscillator},
        {"A4", "a symmetric top that no torque disturbs", symmetric_top},
        {"A5", "the tennis racket: an asymmetric body turns over", tennis_racket},
        {"B1", "a cube slides down an incline, or sticks", incline},
        {"B2", "a cube slides to rest, in every direction", slide_to_rest},
        {"B3", "slip goes over into rolling", slip_to_roll},
        {"B4", "rolling down an incline", roll_down},
        {"B6", "a ball bounces", bouncing_ball},
        {"B7", "a rod strikes a smooth floor", rod_strikes},
        {"B8", "impacts at once: Newton's cradle, and what is symmetric stays so", simultaneous_impacts},
        {"B15", "a pyramid 1e7 m from the origin", far_away},
        {"C1", "a pendulum, and a conical one", pendulum},
        {"C2", "a double pendulum", double_pendulum},
        {"C3", "a chain of ten rods, let go from the horizontal", falling_chain},
        {"C5", "simple machines: pulley, gear, spring, lever", simple_machines},
        {"C6", "chains with a heavy end, and a catenary", heavy_end},
        {"D4", "bodies that float: draft, bobbing, the way up", floating_bodies},
    };
    return cases;
}

}  // namespace carom::app
