#include <fmt/format.h>

#include <memory>

#include "carom/error.hpp"
#include "commands.hpp"

namespace carom::app {

void add_help(CLI::App& program, int& status) {
    CLI::App* command = program.add_subcommand("help", "Say how a command is used");
    const auto topic = std::make_shared<std::string>();
    command->add_option("COMMAND", *topic, "A command; all of them when left out");
    command->callback([&program, &status, topic] {
        const auto named = [&topic](const CLI::App* other) { return other->get_name() == *topic; };
        const std::vector<CLI::App*> found = program.get_subcommands(named);
        if (!topic->empty() && found.empty())
            throw Error(fmt::format("help: \"{}\" is not a command; see carom help", *topic));
        const CLI::App* about = topic->empty() ? &program : found.front();
        // App::help would speak of the command that runs, which is help itself.
        fmt::print("{}",
                   about->get_formatter()->make_help(about, about == &program ? "carom" : "carom " + *topic,
                                                     CLI::AppFormatMode::Normal));
        status = fine;
    });
}

}  // namespace carom::app
