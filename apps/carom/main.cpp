#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "carom/error.hpp"
#include "carom/version.hpp"
#include "commands.hpp"

namespace carom::app {
namespace {

int complain(std::string_view message) {
    fmt::print(stderr, "carom: {}\n", message);
    return bad_input;
}

/// What was printed may still wait in a buffer, and a full disk shows only when that is written.
int with_output_written(int status) {
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
    return complain(fmt::format("the output cannot be written: {}", std::generic_category().message(errno)));
}

int run_program(int count, char** arguments) {
    CLI::App program("Carom: rigid-body physics for games, in 2D and in 3D", "carom");
    program.set_version_flag("--version", fmt::format("carom {}", version));
    program.require_subcommand(0, 1);
    int status = fine;
    add_run(program, status);
    add_validate(program, status);
    add_check(program, status);
    add_bench(program, status);
    add_help(program, status);
    program.footer("Exit status: 0 fine, 1 a failed check, 2 bad input.");
    try {
        program.parse(count, arguments);
        if (program.get_subcommands().empty()) return complain("a command is missing; see carom help");
        return with_output_written(status);
    } catch (const CLI::Success& asked) {  // --help, --version
        return with_output_written(program.exit(asked));
    } catch (const CLI::ParseError& error) {
        return complain(fmt::format("{}\nSee carom help.", error.what()));
    } catch (const Error& error) {
        return complain(error.what());
    } catch (const std::bad_alloc&) {
        return complain("there is not enough memory for this");
    } catch (const std::exception& error) {  // of the standard library, for example a closed output
        return complain(error.what());
    }
}

}  // namespace
}  // namespace carom::app

int main(int count, char** arguments) { return carom::app::run_program(count, arguments); }
