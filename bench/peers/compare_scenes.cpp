#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdio>

#include "carom/error.hpp"
#include "compare.hpp"
#include "io/summary.hpp"
#include "quality.hpp"
#include "scenes/bench_scenes.hpp"
#include "subject.hpp"

namespace carom::peers {
namespace {

using bench::BenchScene;
using bench::BenchWorld;
using subject::EngineKind;

int dimension_of(const BenchScene& scene) { return scene.make.index() == 0 ? 2 : 3; }

bool has_people(const BenchScene& scene) {
    return scene.name.starts_with("rain") || scene.name.starts_with("ragdolls");
}

std::vector<BenchScene> chosen(const std::vector<std::string>& names) {
    std::vector<BenchScene> scenes;
    for (const BenchScene& scene : bench::bench_scenes())
        if ((names.empty() && !has_people(scene)) ||
            std::find(names.begin(), names.end(), scene.name) != names.end())
            scenes.push_back(scene);
    if (scenes.empty()) throw Error("no scene of these names; carom bench --list names them");
    return scenes;
}

/// All engines run on one thread each, so that this is not disturbed by what else the machine does.
double processor_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// ms a step, or why the engine cannot run the scene.
struct Timed {
    double ms = 0;
    std::string refusal{};
};

template <int D>
Timed time_once(BenchWorld<D> (*make)(), const BenchScene& scene, int steps) {
    BenchWorld<D> bench = make();
    const auto step = [&](int index) {
        if (bench.before_step) bench.before_step(bench.world, index);
        bench.world.step(bench::step_length);
    };
    const int untimed = scene.first_step_timed ? 0 : 1;
    for (int i = 0; i < untimed; ++i) step(i);
    const double start = processor_ms();
    for (int i = untimed; i < steps && bench.world.refusal().empty(); ++i) step(i);
    return {(processor_ms() - start) / (steps - untimed), bench.world.refusal()};
}

template <int D>
std::string judge(BenchWorld<D> (*make)(), int steps) {
    BenchWorld<D> bench = make();
    const Vec<D> start = bench.world.position(bench.world.bodies().back());
    for (int i = 0; i < steps && bench.world.refusal().empty(); ++i) {
        if (bench.before_step) bench.before_step(bench.world, i);
        bench.world.step(bench::step_length);
    }
    if (!bench.world.refusal().empty()) return fmt::format(" – ({}) | | | |", bench.world.refusal());
    if (!std::isfinite(bench.world.energy().total())) return " blew up | | | |";
    const Quality q = quality<D>(bench.world.seen(), start);
    return fmt::format(" {:.4f} | {:.4f} | {:.4f} | {:.4f} |", q.deepest, q.aside, q.sunk, q.speed);
}

}  // namespace

void compare_times(const CompareOptions& options) {
    fmt::print("| scene | steps |");
    for (const EngineKind& engine : subject::engines()) fmt::print(" {} |", engine.name);
    fmt::print("\n| --- | --- |");
    for (std::size_t i = 0; i < subject::engines().size(); ++i) fmt::print(" --- |");
    fmt::print("\n");
    for (const BenchScene& scene : chosen(options.names)) {
        const int steps = options.steps > 0 ? options.steps : scene.steps;
        std::vector<std::vector<double>> times(subject::engines().size());
        std::vector<std::string> refusals(times.size());
        for (int turn = 0; turn < options.repeat; ++turn)
            for (std::size_t e = 0; e < times.size(); ++e) {
                const EngineKind& engine = subject::engines()[e];
                if (!engine.has(dimension_of(scene)) || !refusals[e].empty()) continue;
                subject::put_to_the_test(engine);
                const Timed timed =
                    std::visit([&](auto make) { return time_once(make, scene, steps); }, scene.make);
                refusals[e] = timed.refusal;
                times[e].push_back(timed.ms);
            }
        fmt::print("| {} | {} |", scene.name, steps);
        for (std::size_t e = 0; e < times.size(); ++e)
            if (!refusals[e].empty())
                fmt::print(" – ({}) |", refusals[e]);
            else if (times[e].empty())
                fmt::print(" |");
            else
                fmt::print(" {:.3f} |", io::median(times[e]));
        fmt::print("\n");
        std::fflush(stdout);
    }
}

void compare_quality(const CompareOptions& options) {
    fmt::print(
        "| scene | engine | deepest overlap (m) | last body: aside (m) | sunk (m) | speed left (m/s) |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (const BenchScene& scene : chosen(options.names))
        for (const EngineKind& engine : subject::engines()) {
            if (!engine.has(dimension_of(scene))) continue;
            subject::put_to_the_test(engine);
            const int steps = options.steps > 0 ? options.steps : 600;
            fmt::print("| {} | {} |{}\n", scene.name, engine.name,
                       std::visit([&](auto make) { return judge(make, steps); }, scene.make));
            std::fflush(stdout);
        }
}

}  // namespace carom::peers
