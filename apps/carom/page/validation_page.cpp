#include "page/validation_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "carom/version.hpp"
#include "page/svg.hpp"

namespace carom::app {
namespace {

constexpr std::string_view head = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Carom: validation</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 76rem; padding: 1rem 1.5rem 4rem; color: #212121; background: #fff; }
h1 { margin-bottom: 0; } h2 { margin: 2.5rem 0 .5rem; border-bottom: 1px solid #cfd8dc; }
table { border-collapse: collapse; font-size: 13px; } td, th { padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: middle; }
td.n { text-align: right; font-variant-numeric: tabular-nums; } th.n { text-align: right; }
.gold { background: #ffecb3; } .hard { background: #e3f2fd; } .fail { background: #ffcdd2; font-weight: bold; }
.gold, .hard, .fail { padding: 0 .5rem; border-radius: .3rem; }
.figures { display: flex; flex-wrap: wrap; gap: 1rem; margin: .5rem 0; }
.figures svg { max-width: 100%; height: auto; } .g { stroke: #eceff1; fill: none; } svg text { font-size: 12px; fill: #37474f; }
nav a { margin-right: .6rem; } details { margin: .3rem 0; } summary { cursor: pointer; }
</style>
)";

std::size_t count(std::span<const MeasuredCase> cases, std::string_view status) {
    std::size_t sum = 0;
    for (const MeasuredCase& c : cases)
        sum += static_cast<std::size_t>(std::count_if(c.results.begin(), c.results.end(),
                                                      [&](const Result& r) { return r.status() == status; }));
    return sum;
}

std::string row(const Result& r) {
    return fmt::format(
        "<tr><td>{}</td><td class='n'>{:.9g}</td><td class='n'>{:.9g}</td><td class='n'>{:.1e}</td>"
        "<td class='n'>{:.1e}</td><td class='n'>{}</td><td>{}</td><td><span class='{}'>{}</span></td></tr>\n",
        escaped(r.what), r.reference, r.result, r.error, r.bounds.hard,
        r.bounds.gold ? fmt::format("{:.1e}", *r.bounds.gold) : "", error_bar(r), r.status(), r.status());
}

std::string section(const MeasuredCase& c) {
    std::string out =
        fmt::format("<h2 id='{0}'>{0} {1}</h2>\n", escaped(c.measured.name), escaped(c.measured.description));
    const auto counted = [&](std::string_view status) { return count(std::span(&c, 1), status); };
    if (c.measured.figures) {
        out += "<div class='figures'>\n";
        for (const Figure& figure : c.measured.figures()) out += svg_of(figure);
        out += "</div>\n";
    }
    // What fails is not folded away.
    out += fmt::format(
        "<details{}><summary>{} results: {} gold, {} hard, {} failed</summary>\n<table>\n"
        "<tr><th>what</th><th class='n'>reference</th><th class='n'>result</th><th class='n'>error</th>"
        "<th class='n'>hard</th><th class='n'>gold</th><th>1e-15 … 10</th><th></th></tr>\n",
        counted("fail") > 0 || c.results.size() <= 12 ? " open" : "", c.results.size(), counted("gold"),
        counted("hard"), counted("fail"));
    for (const Result& r : c.results) out += row(r);
    return out + "</table></details>\n";
}

}  // namespace

std::string validation_page(std::span<const MeasuredCase> cases) {
    std::string out(head);
    std::size_t results = 0;
    for (const MeasuredCase& c : cases) results += c.results.size();
    out += fmt::format(
        "<h1>Carom {}: validation</h1>\n<p>{} results: <span class='gold'>{} gold</span> "
        "<span class='hard'>{} hard</span> <span class='fail'>{} failed</span></p>\n<p>A result has to "
        "be within its hard bound (blue); gold is what the most accurate engine of its class would "
        "reach. The mark in the bar is the error, on a logarithmic scale. In figures the wide pale "
        "line is the reference.</p>\n<nav>",
        version, results, count(cases, "gold"), count(cases, "hard"), count(cases, "fail"));
    for (const MeasuredCase& c : cases)
        out += fmt::format("<a href='#{0}'>{0}</a>", escaped(c.measured.name));
    out += "</nav>\n";
    for (const MeasuredCase& c : cases) out += section(c);
    return out + "</html>\n";
}

}  // namespace carom::app
