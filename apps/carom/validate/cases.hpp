#pragma once

#include "validate/case.hpp"

namespace carom::app {

// One function a case; each lives in the file of its subject.
std::vector<Result> projectile();
std::vector<Result> kepler_orbit();
std::vector<Result> oscillator();
std::vector<Result> symmetric_top();
std::vector<Result> tennis_racket();
std::vector<Result> incline();
std::vector<Result> slide_to_rest();
std::vector<Result> slip_to_roll();
std::vector<Result> roll_down();
std::vector<Result> bouncing_ball();
std::vector<Result> rod_strikes();
std::vector<Result> simultaneous_impacts();
std::vector<Result> far_away();
std::vector<Result> pendulum();
std::vector<Result> double_pendulum();
std::vector<Result> falling_chain();
std::vector<Result> simple_machines();
std::vector<Result> heavy_end();
std::vector<Result> floating_bodies();
std::vector<Result> pulled_slab();
std::vector<Result> rocking_blocks();
std::vector<Result> dominoes();
std::vector<Result> masonry_arch();
std::vector<Result> heap_of_balls();
std::vector<Result> crank_and_slider();
std::vector<Result> spinning_tops();

}  // namespace carom::app
