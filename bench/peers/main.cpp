#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "compare.hpp"

int main(int count, char** arguments) {
    using namespace carom::peers;
    CLI::App program{"The scenes of carom bench and the cases of carom validate on several engines"};
    program.require_subcommand(1);
    CompareOptions options;
    const auto add = [&](const char* name, const char* what, void (*compare)(const CompareOptions&)) {
        CLI::App* command = program.add_subcommand(name, what);
        command->add_option("NAME", options.names, "Scenes or cases; all of them when left out");
        command->callback([&options, compare] { compare(options); });
        return command;
    };
    CLI::App* times = add("times", "Processor time of a step, ms: median of runs in turns", compare_times);
    times->add_option("--repeat", options.repeat, "How often each is run")->capture_default_str();
    CLI::App* quality = add("quality", "How scenes stand after 10 s", compare_quality);
    for (CLI::App* command : {times, quality})
        command->add_option("--steps", options.steps, "Steps to run instead of the usual number");
    add("cases", "Errors in the cases of carom validate", compare_cases);
    try {
        program.parse(count, arguments);
    } catch (const CLI::ParseError& error) {
        return program.exit(error);
    } catch (const std::exception& error) {
        fmt::print(stderr, "carom_peers: {}\n", error.what());
        return 2;
    }
    return 0;
}
