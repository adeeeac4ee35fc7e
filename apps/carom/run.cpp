#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "io/chrome_trace.hpp"
#include "io/output_file.hpp"
#include "io/progress.hpp"
#include "io/record.hpp"
#include "io/replay.hpp"
#include "io/replay_template.hpp"
#include "io/scene.hpp"
#include "io/summary.hpp"
#include "io/trace.hpp"

namespace carom::app {
namespace {

struct RunOptions {
    std::string scene;
    int steps = 600;
    int threads = 1;
    std::string trace, replay, profile;
    std::vector<std::string> trace_bodies;
    bool json = false, quiet = false;
};

/// What a run writes beside its summary.
template <int D>
class Outputs {
  public:
    Outputs(const RunOptions& options, const io::Scene& scene, const io::SceneWorld<D>& built) {
        // Files are opened before the run, so that a path that cannot be written is known at once.
        if (!options.trace.empty()) trace_.emplace(options.trace, built, options.trace_bodies);
        if (!options.profile.empty()) profile_.emplace(options.profile);
        if (options.replay.empty()) return;
        replay_file_.emplace(options.replay, "replay");
        recorder_.emplace(scene, built);
    }

    void take(const World<D>& world) {
        if (trace_) trace_->write_step(world);
        if (recorder_) recorder_->record_frame(world);
        if (profile_ && world.steps() > 0) profile_->write_step(world.profile());
    }

    void finish() {
        if (trace_) trace_->finish();
        if (profile_) profile_->finish();
        if (!recorder_) return;
        replay_file_->write(io::replay_html(recorder_->replay(), io::replay_template()));
        replay_file_->finish();
    }

  private:
    std::optional<io::Trace<D>> trace_;
    std::optional<io::OutputFile> replay_file_;
    std::optional<io::Recorder<D>> recorder_;
    std::optional<io::ChromeTrace> profile_;
};

template <int D>
void warn_of_quarantined(const World<D>& world) {
    for (const BodyId<D> body : world.quarantined())
        fmt::print(stderr,
                   "carom: step {}: \"{}\" left the finite numbers and was taken out of the simulation\n",
                   world.steps(), io::body_label(world.name(body), body.index));
}

template <int D>
io::RunSummary simulate(const RunOptions& options, const io::Scene& scene) {
    using Clock = std::chrono::steady_clock;
    io::SceneWorld<D> built = io::build<D>(scene);
    World<D>& world = built.world;
    if (options.threads > 1) world.set_scheduler(make_thread_pool(options.threads));
    world.set_profiling(!options.profile.empty());
    Outputs<D> outputs(options, scene, built);

    io::RunSummary summary;
    summary.name = scene.name;
    summary.dimension = D;
    summary.threads = options.threads;
    summary.energy_start = world.energy().total();
    outputs.take(world);

    std::vector<double> times;
    {
        const auto steps = static_cast<std::uint64_t>(options.steps);
        io::Progress progress(stderr, !options.quiet && io::is_terminal(stderr), steps);
        for (std::uint64_t step = 0; step < steps; ++step) {
            const auto start = Clock::now();
            world.step(scene.step);
            times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
            outputs.take(world);
            warn_of_quarantined(world);
            progress.update(step + 1);
        }
    }
    outputs.finish();

    const Counts counts = world.counts();
    summary.bodies = counts.bodies;
    summary.shapes = counts.shapes;
    summary.contacts = counts.contacts;
    summary.joints = counts.joints;
    summary.steps = world.steps();
    summary.ms_per_step = io::median(times);
    summary.ms_per_step_worst = io::largest(times);
    summary.energy_end = world.energy().total();
    summary.hash = world.hash();
    summary.awake = counts.awake;
    if (!options.json && !options.quiet) summary.why_awake = io::reasons_awake(world);
    return summary;
}

void run(const RunOptions& options) {
    const io::Scene scene = io::load_scene(options.scene);
    const io::RunSummary summary =
        scene.dimension() == 2 ? simulate<2>(options, scene) : simulate<3>(options, scene);
    if (options.json)
        fmt::print("{}\n", to_json(summary).dump(2));
    else if (!options.quiet)
        fmt::print("{}", to_text(summary));
}

}  // namespace

void add_run(CLI::App& program, int& status) {
    CLI::App* command = program.add_subcommand("run", "Simulate a scene and print a summary");
    const auto options = std::make_shared<RunOptions>();
    command->add_option("SCENE", options->scene, "Scene file (JSON)")->required();
    command->add_option("--steps", options->steps, "How many steps")
        ->capture_default_str()
        ->check(CLI::Range(0, 100'000'000).description(""));
    command->add_option("--threads", options->threads, "Threads to use")
        ->capture_default_str()
        ->check(CLI::Range(1, 256).description(""));
    command->add_option("--trace", options->trace, "Write a row a body a step to FILE, comma-separated")
        ->type_name("FILE.csv");
    command
        ->add_option("--trace-bodies", options->trace_bodies,
                     "Only these bodies in the trace: names, or #index")
        ->type_name("A,B")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->needs("--trace");
    command
        ->add_option("--profile", options->profile,
                     "Write what the stages of each step took to FILE, for ui.perfetto.dev")
        ->type_name("FILE.json");
    command->add_option("--replay", options->replay, "Write a page to FILE that plays the run in a browser")
        ->type_name("FILE.html");
    command->add_flag("--json", options->json, "Print the summary as JSON");
    command->add_flag("--quiet", options->quiet, "Print no summary (but --json) and no progress");
    command->callback([options, &status] {
        run(*options);
        status = fine;
    });
}

}  // namespace carom::app
