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
        const auto named = [&topic](const CLI::App* command) { return command->get_name() == *topic; };
        const std::vector<CLI::App*> found = program.get_subcommands(named);
        if (!topic->empty() && found.empty())
            throw Error(fmt::format("help: \"{}\" is not a command; see carom help", *topic));
        const CLI::App* about = topic->empty() ? &program : found.front();
        // A help page begins with what is wanted of the whole program unless it is asked for as a part of it.
        fmt::print("{}", about->help(about == &program ? "" : "carom"));
        status = fine;
    });
}

}  // namespace carom::app
