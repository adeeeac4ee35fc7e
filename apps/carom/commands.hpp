#pragma once

#include <CLI/CLI.hpp>

namespace carom::app {

/// What the program returns.
enum ExitStatus : int {
    fine = 0,
    failed_check = 1,
    bad_input = 2,
};

// Each adds one command to the program; when that command runs, it leaves its exit status in `status`.
void add_run(CLI::App& program, int& status);
void add_bench(CLI::App& program, int& status);
void add_validate(CLI::App& program, int& status);
void add_check(CLI::App& program, int& status);
void add_help(CLI::App& program, int& status);

}  // namespace carom::app
