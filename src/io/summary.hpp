#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "carom/world.hpp"

namespace carom::io {

/// The median of what was measured (the mean of the two middle ones where the number is even), and the
/// largest; zero where nothing was.
double median(std::vector<double> values);
double largest(const std::vector<double>& values);

/// Sixteen hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// What `carom run` says at its end.
struct RunSummary {
    std::string name;
    int dimension = 0;
    int bodies = 0, shapes = 0, contacts = 0, joints = 0;
    std::uint64_t steps = 0;
    int threads = 1;
    double ms_per_step = 0;  ///< median
    double ms_per_step_worst = 0;
    double energy_start = 0, energy_end = 0;  ///< J
    std::uint64_t hash = 0;
    int awake = 0;                                       ///< dynamic bodies at the end
    std::vector<std::pair<std::string, int>> why_awake;  ///< how many of them for which reason
};

/// What keeps the bodies of a world awake: each reason that there is, and how many bodies it holds for.
template <int D>
std::vector<std::pair<std::string, int>> reasons_awake(const World<D>& world);

/// The summary in a few lines, for a person.
std::string to_text(const RunSummary& summary);

/// The summary with the keys that docs/command-line.md promises.
nlohmann::ordered_json to_json(const RunSummary& summary);

}  // namespace carom::io
