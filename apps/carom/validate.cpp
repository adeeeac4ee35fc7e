#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "carom/error.hpp"
#include "commands.hpp"
#include "io/json_reader.hpp"
#include "io/output_file.hpp"
#include "page/validation_page.hpp"
#include "table.hpp"
#include "validate/case.hpp"

namespace carom::app {
namespace {

struct ValidateOptions {
    std::vector<std::string> names;
    std::string page;
    bool json = false, list = false;
};

/// The cases with these names, in the order of the table; all of them for no names.
std::vector<Case> chosen_cases(const std::vector<std::string>& names) {
    const auto all = validation_cases();
    std::vector<std::string_view> known;
    for (const Case& c : all) known.push_back(c.name);
    for (const std::string& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw Error(fmt::format("validate: \"{}\" is not a case{}; there are {}", name,
                                    io::suggestion(name, known), io::listed(known)));
    std::vector<Case> chosen;
    for (const Case& c : all)
        if (names.empty() || std::find(names.begin(), names.end(), c.name) != names.end())
            chosen.push_back(c);
    return chosen;
}

void print_json(const std::vector<MeasuredCase>& cases) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& [c, results] : cases)
        for (const Result& r : results) {
            nlohmann::ordered_json gold = nullptr;
            if (r.bounds.gold) gold = *r.bounds.gold;
            list.push_back({{"name", c.name},
                            {"what", r.what},
                            {"reference", r.reference},
                            {"result", r.result},
                            {"error", r.error},
                            {"hard", r.bounds.hard},
                            {"gold", gold},
                            {"status", r.status()}});
        }
    fmt::print("{}\n", list.dump(2));
}

void print_table(const std::vector<MeasuredCase>& cases) {
    Table table({{"case"},
                 {"what"},
                 {"reference", true},
                 {"result", true},
                 {"error", true},
                 {"hard", true},
                 {"gold", true},
                 {"status"}});
    for (const auto& [c, results] : cases)
        for (const Result& r : results)
            table.add({std::string(c.name), r.what, fmt::format("{:.9g}", r.reference),
                       fmt::format("{:.9g}", r.result), fmt::format("{:.1e}", r.error),
                       fmt::format("{:.1e}", r.bounds.hard),
                       r.bounds.gold ? fmt::format("{:.1e}", *r.bounds.gold) : "", std::string(r.status())});
    fmt::print("{}", table.text());
}

int validate(const ValidateOptions& options) {
    const std::vector<Case> cases = chosen_cases(options.names);
    if (options.list) {
        for (const Case& c : cases) fmt::print("{:<4} {}\n", c.name, c.description);
        return fine;
    }
    // The file is opened first, so that a path that cannot be written is known at once.
    std::optional<io::OutputFile> page;
    if (!options.page.empty()) page.emplace(options.page, "page");
    std::vector<MeasuredCase> measured;
    for (const Case& c : cases) measured.push_back({c, c.measure()});
    if (page) {
        page->write(validation_page(measured));
        page->finish();
    }

    std::size_t all = 0;
    for (const MeasuredCase& m : measured) all += m.results.size();
    const auto count = [&](std::string_view status) {
        std::ptrdiff_t sum = 0;
        for (const MeasuredCase& m : measured)
            sum += std::count_if(m.results.begin(), m.results.end(),
                                 [&](const Result& r) { return r.status() == status; });
        return sum;
    };
    if (options.json)
        print_json(measured);
    else {
        print_table(measured);
        fmt::print("{} results: {} gold, {} hard, {} failed\n", all, count("gold"), count("hard"),
                   count("fail"));
    }
    return count("fail") == 0 ? fine : failed_check;
}

}  // namespace

void add_validate(CLI::App& program, int& status) {
    CLI::App* command = program.add_subcommand("validate", "Measure physics whose answers are known");
    const auto options = std::make_shared<ValidateOptions>();
    command->add_option("NAME", options->names, "Cases to run; all of them when left out");
    command->add_flag("--list", options->list, "Name the cases and end");
    command->add_flag("--json", options->json, "Print an array of objects");
    command->add_option("--html", options->page, "Write a page to FILE that shows results and figures")
        ->type_name("FILE.html");
    command->callback([options, &status] { status = validate(*options); });
}

}  // namespace carom::app
