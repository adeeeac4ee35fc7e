#pragma once

#include <string>
#include <vector>

namespace carom::peers {

struct CompareOptions {
    std::vector<std::string> names;  ///< of scenes or cases; all of them when empty
    int repeat = 5;
    int steps = 0;  ///< 0: as many as the scene says
};

// Each prints a table, in Markdown, with a column or row an engine.

/// What a step takes: medians of runs in turns, in processor time.
void compare_times(const CompareOptions& options);
/// How scenes stand after 10 s, or as many steps as are asked for.
void compare_quality(const CompareOptions& options);
/// What the cases of `carom validate` measure.
void compare_cases(const CompareOptions& options);

}  // namespace carom::peers
