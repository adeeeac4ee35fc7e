#include "io/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace carom::io {

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

double largest(const std::vector<double>& values) {
    return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

template <int D>
std::vector<std::pair<std::string, int>> reasons_awake(const World<D>& world) {
    constexpr std::pair<Wakefulness, const char*> words[] = {{Wakefulness::moving, "moving"},
                                                             {Wakefulness::driven, "driven by motors"},
                                                             {Wakefulness::settling, "settling"},
                                                             {Wakefulness::neighbour, "held by neighbours"},
                                                             {Wakefulness::sleep_off, "not let sleep"}};
    std::array<int, std::size(words) + 1> counts{};
    for (const BodyId<D> body : world.bodies())
        ++counts[static_cast<std::size_t>(world.awake_reason(body).why)];
    std::vector<std::pair<std::string, int>> reasons;
    for (const auto& [why, word] : words)
        if (const int count = counts[static_cast<std::size_t>(why)]; count > 0)
            reasons.emplace_back(word, count);
    return reasons;
}

template std::vector<std::pair<std::string, int>> reasons_awake(const World<2>&);
template std::vector<std::pair<std::string, int>> reasons_awake(const World<3>&);

std::string to_text(const RunSummary& s) {
    std::string reasons;
    for (const auto& [word, count] : s.why_awake)
        reasons += fmt::format("{} {} {}", reasons.empty() ? ":" : ",", count, word);
    return fmt::format(
        "{} ({}D)\n"
        "  bodies {}, shapes {}, contacts {}, joints {}\n"
        "  steps {}, ms/step {:.3f} (median), {:.3f} (worst)\n"
        "  energy {:.6g} J at the start, {:.6g} J at the end\n"
        "  awake {}{}\n"
        "  hash {}\n",
        s.name, s.dimension, s.bodies, s.shapes, s.contacts, s.joints, s.steps, s.ms_per_step,
        s.ms_per_step_worst, s.energy_start, s.energy_end, s.awake, reasons, hash_text(s.hash));
}

nlohmann::ordered_json to_json(const RunSummary& s) {
    return {{"name", s.name},
            {"dimension", s.dimension},
            {"bodies", s.bodies},
            {"shapes", s.shapes},
            {"contacts", s.contacts},
            {"joints", s.joints},
            {"steps", s.steps},
            {"threads", s.threads},
            {"ms_per_step", s.ms_per_step},
            {"ms_per_step_worst", s.ms_per_step_worst},
            {"energy_start", s.energy_start},
            {"energy_end", s.energy_end},
            {"hash", hash_text(s.hash)}};
}

}  // namespace carom::io
