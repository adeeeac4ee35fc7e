#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <variant>

#include "subject.hpp"

namespace carom::bench {

using subject::World;
using subject::World2;
using subject::World3;

/// Length of a step in every benchmark scene, s.
constexpr double step_length = 1.0 / 60;

/// A world to be timed, and what the scene does to it before each step (counted from 0).
template <int D>
struct BenchWorld {
    World<D> world;
    std::function<void(World<D>&, int step)> before_step{};
};

/// A scene that engines are compared by. docs/command-line.md says what is in each.
struct BenchScene {
    std::string_view name;
    int steps;  ///< the first of them untimed, unless `first_step_timed`
    std::variant<BenchWorld<2> (*)(), BenchWorld<3> (*)()> make;
    bool first_step_timed = false;
};

/// All scenes, in the order in which they run.
std::span<const BenchScene> bench_scenes();

/// Walls of ten boxes on one floor, four in the lowest row, without sleep: as many boxes as are asked for, up
/// to a multiple of ten. For how the time of a step grows with the number of bodies.
template <int D>
BenchWorld<D> small_pyramids(int bodies);

}  // namespace carom::bench
