#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "carom/error.hpp"
#include "compare.hpp"
#include "engine.hpp"
#include "refusals.hpp"
#include "subject.hpp"
#include "validate/case.hpp"

namespace carom::peers {
namespace {

using app::Case;
using app::Result;

/// Takes out what was not measured: results of a dimension that the engine does not have; and, where a world
/// of the case held what it does not have, those that are exactly right or wrong, as a largest or least value
/// is that passed over what is not a number.
void take_out_unknown(std::vector<Result>& results, const subject::EngineKind& engine) {
    for (Result& r : results) {
        const int dimension = r.what.starts_with("2D") ? 2 : 3;
        const bool exact = r.error == 0 || r.error == 1;
        if (!engine.has(dimension) || (exact && subject::refused(dimension)))
            r.error = std::numeric_limits<double>::quiet_NaN();
    }
}

/// What an engine made of one result.
std::string cell(const Result& result) {
    if (std::isnan(result.error)) return "–";
    if (std::isinf(result.error)) return "blew up";
    const std::string error = fmt::format("{:.1e}", result.error);
    const std::string_view status = result.status();
    if (status == "gold") return fmt::format("**{}**", error);
    return status == "hard" ? error : fmt::format("*{}*", error);
}

}  // namespace

void compare_cases(const CompareOptions& options) {
    std::vector<Case> cases;
    for (const Case& c : app::validation_cases())
        if (options.names.empty() ||
            std::find(options.names.begin(), options.names.end(), c.name) != options.names.end())
            cases.push_back(c);
    if (cases.empty()) throw Error("no case of these names; carom validate --list names them");
    fmt::print("| case | what |");
    for (const auto& engine : subject::engines()) fmt::print(" {} |", engine.name);
    fmt::print("\n| --- | --- |");
    for (std::size_t i = 0; i < subject::engines().size(); ++i) fmt::print(" --- |");
    fmt::print("\n");
    for (const Case& c : cases) {
        std::vector<std::vector<Result>> results;
        for (const auto& engine : subject::engines()) {
            subject::put_to_the_test(engine);
            subject::forget_refusals();
            try {
                results.push_back(c.measure());
                take_out_unknown(results.back(), engine);
            } catch (const Unsupported&) {
                results.emplace_back();
            } catch (const Error&) {  // of places that are not a number
                results.emplace_back();
            }
        }
        for (std::size_t i = 0; i < results[0].size(); ++i) {
            const auto known = [&](const std::vector<Result>& of_engine) {
                return i < of_engine.size() && !std::isnan(of_engine[i].error);
            };
            // What no other engine can be asked says nothing here.
            if (std::none_of(results.begin() + 1, results.end(), known)) continue;
            fmt::print("| {} | {} |", c.name, results[0][i].what);
            for (const auto& of_engine : results)
                fmt::print(" {} |", i < of_engine.size() ? cell(of_engine[i]) : "–");
            fmt::print("\n");
        }
        std::fflush(stdout);
    }
}

}  // namespace carom::peers
