#pragma once

#include <cstddef>
#include <vector>

namespace carom {

/// What a stage of a step took.
struct StageTime {
    const char* name = "";  ///< as in docs/architecture.md
    double begin = 0;       ///< s, since profiling was switched on
    double seconds = 0;
};

/// What the last step took, stage by stage, and how much there was to do. See `World::set_profiling`.
struct StepProfile {
    double begin = 0;  ///< s, since profiling was switched on
    double seconds = 0;
    std::vector<StageTime> stages{};  ///< in the order in which they ran
    std::size_t awake = 0;            ///< bodies that moved: dynamic and awake, or moved by the user
    std::size_t pairs = 0;            ///< of shapes near each other, or of a shape and a facet
    std::size_t solved = 0;           ///< contacts that the solver had
    std::size_t looked_at = 0;        ///< contacts that were not just carried along with their bodies
    std::size_t largest_colour = 0;   ///< contacts of the colour that has most
    std::size_t without_colour = 0;   ///< contacts that were solved one by one
    int workers = 1;                  ///< that the scheduler has
};

}  // namespace carom
