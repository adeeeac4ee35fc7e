#include "validate/cases.hpp"

namespace carom::app {

std::span<const Case> validation_cases() {
    static constexpr Case cases[] = {
        {"A1", "a projectile, by each integrator", projectile, projectile_figures},
        {"A2", "a hundred rounds of a Kepler orbit, by each integrator", kepler_orbit, orbit_figures},
        {"A3", "a harmonic oscillator, by each integrator", oscillator, oscillator_figures},
        {"A4", "a symmetric top that no torque disturbs", symmetric_top},
        {"A5", "the tennis racket: an asymmetric body turns over", tennis_racket, racket_figures},
        {"B1", "a cube slides down an incline, or sticks", incline, incline_figures},
        {"B2", "a cube slides to rest, in every direction", slide_to_rest, slide_figures},
        {"B3", "slip goes over into rolling", slip_to_roll, roll_figures},
        {"B4", "rolling down an incline", roll_down},
        {"B6", "a ball bounces", bouncing_ball, bounce_figures},
        {"B7", "a rod strikes a smooth floor", rod_strikes},
        {"B8", "impacts at once: Newton's cradle, and what is symmetric stays so", simultaneous_impacts,
         cradle_figures},
        {"B15", "a pyramid 1e7 m from the origin", far_away},
        {"C1", "a pendulum, and a conical one", pendulum, pendulum_figures},
        {"C2", "a double pendulum", double_pendulum, double_pendulum_figures},
        {"C3", "a chain of ten rods, let go from the horizontal", falling_chain},
        {"C5", "simple machines: pulley, gear, spring, lever", simple_machines, machine_figures},
        {"C6", "chains with a heavy end, and a catenary", heavy_end},
        {"D4", "bodies that float: draft, bobbing, the way up", floating_bodies, buoyancy_figures},
        {"E1", "a slab is pulled under rolling balls", pulled_slab},
        {"E2", "a block rocks from corner to corner", rocking_blocks},
        {"E3", "dominoes", dominoes},
        {"E4", "an arch of stones: how thin it may be", masonry_arch},
        {"E5", "216 balls in a box", heap_of_balls},
        {"E6", "crank and slider: a mechanism with a loop", crank_and_slider},
        {"E7", "tops that precess, on a pivot and on a floor", spinning_tops},
    };
    return cases;
}

}  // namespace carom::app
