#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "carom/error.hpp"
#include "commands.hpp"
#include "io/json_reader.hpp"
#include "io/summary.hpp"
#include "scenes/bench_scenes.hpp"
#include "table.hpp"

namespace carom::app {
namespace {

using bench::BenchScene;
using bench::BenchWorld;

struct BenchOptions {
    std::vector<std::string> names;
    std::vector<int> threads{1};
    int repeat = 3;
    int steps = 0;  ///< 0: as many as the scene says
    bool json = false, list = false, stages = false, scaling = false;
};

/// One run of a scene, or several of the same.
struct BenchResult {
    std::string_view name;
    int dimension = 0;
    Counts counts{};
    int steps = 0;
    int threads = 1;
    std::vector<double> ms_per_step{};  ///< of each run
    std::uint64_t hash = 0;
    bool reproducible = true;  ///< all runs ended in the same state
    StepProfile sums{};        ///< over the steps of all runs, where stages are asked for
    int profiled = 0;          ///< steps in these sums
};

/// Adds what one step took to the sums of all.
void add_profile(const StepProfile& step, BenchResult& result) {
    StepProfile& sums = result.sums;
    ++result.profiled;
    sums.stages.resize(step.stages.size());
    for (std::size_t i = 0; i < step.stages.size(); ++i) {
        sums.stages[i].name = step.stages[i].name;
        sums.stages[i].seconds += step.stages[i].seconds;
    }
    sums.awake += step.awake;
    sums.pairs += step.pairs;
    sums.solved += step.solved;
    sums.looked_at += step.looked_at;
}

/// Times the steps as one interval, with what the scene does between them, but for the first `untimed` ones.
template <int D>
void run_once(BenchWorld<D> bench, int untimed, bool stages, BenchResult& result) {
    using Clock = std::chrono::steady_clock;
    if (result.threads > 1) bench.world.set_scheduler(make_thread_pool(result.threads));
    const auto step = [&](int index) {
        if (bench.before_step) bench.before_step(bench.world, index);
        bench.world.step(bench::step_length);
    };
    for (int i = 0; i < untimed; ++i) step(i);
    bench.world.set_profiling(stages);
    const auto start = Clock::now();
    for (int i = untimed; i < result.steps; ++i) {
        step(i);
        if (stages) add_profile(bench.world.profile(), result);
    }
    const std::chrono::duration<double, std::milli> taken = Clock::now() - start;

    result.ms_per_step.push_back(taken.count() / (result.steps - untimed));
    result.counts = bench.world.counts();
    const std::uint64_t hash = bench.world.hash();
    if (result.ms_per_step.size() > 1 && hash != result.hash) result.reproducible = false;
    result.hash = hash;
}

BenchResult measure(const BenchScene& scene, int threads, const BenchOptions& options) {
    BenchResult result;
    result.name = scene.name;
    result.dimension = scene.make.index() == 0 ? 2 : 3;
    result.steps = options.steps > 0 ? options.steps : scene.steps;
    result.threads = threads;
    // All scenes but those taken from a program that counts its first step leave that one out.
    const int untimed = scene.first_step_timed ? 0 : 1;
    for (int i = 0; i < options.repeat; ++i)
        std::visit([&](const auto& make) { run_once(make(), untimed, options.stages, result); }, scene.make);
    return result;
}

/// The same walls of ten boxes, from 10² to 10⁶ boxes.
std::vector<BenchResult> measure_scaling(const BenchOptions& options) {
    constexpr int bodies[] = {100, 300, 1000, 3000, 10'000, 30'000, 100'000, 300'000, 1'000'000};
    constexpr int bodies_and_steps = 2'000'000, untimed = 3;
    std::vector<BenchResult> results;
    for (const int threads : options.threads)
        for (const int dimension : {2, 3})
            for (const int n : bodies) {
                BenchResult& result = results.emplace_back();
                result.name = dimension == 2 ? "small_pyramids_2" : "small_pyramids_3";
                result.dimension = dimension;
                result.threads = threads;
                result.steps = options.steps > 0 ? options.steps : std::clamp(bodies_and_steps / n, 8, 2000);
                for (int i = 0; i < options.repeat; ++i)
                    if (dimension == 2)
                        run_once(bench::small_pyramids<2>(n), untimed, options.stages, result);
                    else
                        run_once(bench::small_pyramids<3>(n), untimed, options.stages, result);
            }
    return results;
}

double best(const BenchResult& r) { return *std::min_element(r.ms_per_step.begin(), r.ms_per_step.end()); }

void print_json(const std::vector<BenchResult>& results) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const BenchResult& r : results)
        list.push_back({{"name", r.name},
                        {"dimension", r.dimension},
                        {"bodies", r.counts.bodies},
                        {"contacts", r.counts.contacts},
                        {"joints", r.counts.joints},
                        {"steps", r.steps},
                        {"threads", r.threads},
                        {"ms_per_step", io::median(r.ms_per_step)},
                        {"ms_per_step_best", best(r)},
                        {"hash", io::hash_text(r.hash)}});
    fmt::print("{}\n", list.dump(2));
}

void print_table(const std::vector<BenchResult>& results) {
    Table table({{"name"},
                 {"dimension", true},
                 {"bodies", true},
                 {"contacts", true},
                 {"joints", true},
                 {"steps", true},
                 {"threads", true},
                 {"ms/step", true},
                 {"best", true},
                 {"hash"}});
    for (const BenchResult& r : results)
        table.add({std::string(r.name), fmt::format("{}", r.dimension), fmt::format("{}", r.counts.bodies),
                   fmt::format("{}", r.counts.contacts), fmt::format("{}", r.counts.joints),
                   fmt::format("{}", r.steps), fmt::format("{}", r.threads),
                   fmt::format("{:.3f}", io::median(r.ms_per_step)), fmt::format("{:.3f}", best(r)),
                   io::hash_text(r.hash)});
    fmt::print("{}", table.text());
}

/// What the stages of a step took, and how much there was to do, on average.
void print_stages(const BenchResult& r) {
    const auto mean = [&](auto sum) { return static_cast<double>(sum) / r.profiled; };
    fmt::print(
        "\n{}, a step: {:.0f} bodies awake, {:.0f} pairs, {:.0f} solved, {:.0f} looked at one by one\n",
        r.name, mean(r.sums.awake), mean(r.sums.pairs), mean(r.sums.solved), mean(r.sums.looked_at));
    double whole = 0;
    for (const StageTime& stage : r.sums.stages) whole += stage.seconds;
    Table table({{"stage"}, {"ms", true}, {"share", true}});
    for (const StageTime& stage : r.sums.stages)
        table.add({stage.name, fmt::format("{:.3f}", mean(stage.seconds * 1000)),
                   fmt::format("{:.1f} %", 100 * stage.seconds / whole)});
    fmt::print("{}", table.text());
}

std::vector<BenchScene> chosen_scenes(const std::vector<std::string>& names) {
    const auto all = bench::bench_scenes();
    if (names.empty()) return {all.begin(), all.end()};
    std::vector<std::string_view> known;
    for (const BenchScene& scene : all) known.push_back(scene.name);
    std::vector<BenchScene> chosen;
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end())
            throw Error(fmt::format("bench: \"{}\" is not a benchmark scene{}; there are {}", name,
                                    io::suggestion(name, known), io::listed(known)));
        chosen.push_back(all[static_cast<std::size_t>(found - known.begin())]);
    }
    return chosen;
}

std::vector<BenchResult> measure_all(const std::vector<BenchScene>& scenes, const BenchOptions& options) {
    std::vector<BenchResult> results;
    for (const BenchScene& scene : scenes)
        for (const int threads : options.threads) results.push_back(measure(scene, threads, options));
    return results;
}

int run_benchmarks(const BenchOptions& options) {
    const std::vector<BenchScene> scenes = chosen_scenes(options.names);
    if (options.list) {
        for (const BenchScene& scene : scenes) fmt::print("{}\n", scene.name);
        return fine;
    }
    const std::vector<BenchResult> results =
        options.scaling ? measure_scaling(options) : measure_all(scenes, options);
    int status = fine;
    for (const BenchResult& r : results) {
        if (r.reproducible) continue;
        fmt::print(stderr, "carom: {}: equal runs ended differently\n", r.name);
        status = failed_check;
    }
    options.json ? print_json(results) : print_table(results);
    if (!options.stages || options.json) return status;
    for (const BenchResult& r : results) print_stages(r);
    return status;
}

}  // namespace

void add_bench(CLI::App& program, int& status) {
    CLI::App* command = program.add_subcommand("bench", "Time the built-in benchmark scenes");
    const auto options = std::make_shared<BenchOptions>();
    command->add_option("NAME", options->names, "Scenes to run; all of them when left out");
    command->add_option("--threads", options->threads, "Threads to use, a row for each")
        ->type_name("1,2")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(1, 256).description(""));
    command->add_option("--repeat", options->repeat, "How often each is run")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000).description(""));
    command->add_option("--steps", options->steps, "Steps to run; the scene's own number when left out")
        ->check(CLI::Range(2, 1'000'000).description(""));
    command->add_flag("--list", options->list, "Name the scenes and end");
    command->add_flag("--json", options->json, "Print an array of objects");
    command->add_flag("--scaling", options->scaling,
                      "Instead of the scenes: small pyramids of 100 to 1000000 boxes in all");
    command->add_flag("--stages", options->stages, "Also print what the stages of a step take");
    command->callback([options, &status] { status = run_benchmarks(*options); });
}

}  // namespace carom::app
