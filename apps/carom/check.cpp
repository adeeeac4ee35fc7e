#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "io/scene_check.hpp"

namespace carom::app {
namespace {

int check(const std::string& path) {
    const std::vector<io::Suspicion> found = io::check_scene(io::load_scene(path));
    for (const io::Suspicion& suspicion : found)
        fmt::print("{}: {}: {}\n", path, suspicion.place, suspicion.what);
    if (found.empty()) {
        fmt::print("{}: nothing suspicious\n", path);
        return fine;
    }
    fmt::print("{} suspicious {}\n", found.size(), found.size() == 1 ? "place" : "places");
    return failed_check;
}

}  // namespace

void add_check(CLI::App& program, int& status) {
    CLI::App* command = program.add_subcommand(
        "check", "Say what is suspicious in a scene: units, sizes, masses, overlaps, speeds, springs");
    const auto scene = std::make_shared<std::string>();
    command->add_option("SCENE", *scene, "Scene file (JSON)")->required();
    command->callback([scene, &status] { status = check(*scene); });
}

}  // namespace carom::app
