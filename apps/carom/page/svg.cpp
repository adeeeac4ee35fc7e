#include "page/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom::app {
namespace {

constexpr double width = 560, height = 330;
constexpr double left = 64, right = 16, top = 34, bottom = 48;  // margins
constexpr double row = 17;                                      // of the legend
constexpr std::array<const char*, 6> colours{"#1565c0", "#c62828", "#2e7d32",
                                             "#ef6c00", "#6a1b9a", "#00838f"};
constexpr const char* reference_colour = "#b0bec5";

/// An axis: values between `low` and `high` (logarithms where it is logarithmic) onto pixels.
struct Axis {
    bool logarithmic;
    double low = 1e300, high = -1e300;
    double from = 0, to = 0;

    double scaled(double x) const { return logarithmic ? std::log10(x) : x; }
    bool takes(double x) const { return std::isfinite(x) && (!logarithmic || x > 0); }
    void widen(double x) {
        low = std::min(low, scaled(x));
        high = std::max(high, scaled(x));
    }
    void finish() {
        if (!(low < high)) {
            low -= 0.5;
            high += 0.5;
        }
        const double margin = 0.04 * (high - low);
        low -= margin;
        high += margin;
    }
    double pixel(double x) const { return from + (scaled(x) - low) / (high - low) * (to - from); }

    /// Where the grid has lines: about six round numbers, or powers of ten.
    std::vector<double> ticks() const {
        double step = 1;
        if (logarithmic) {
            step = std::max(1.0, std::ceil((high - low) / 7));
        } else {
            const double wanted = (high - low) / 6, power = std::pow(10, std::floor(std::log10(wanted)));
            step = power * (wanted / power < 1.5   ? 1
                            : wanted / power < 3.5 ? 2
                            : wanted / power < 7.5 ? 5
                                                   : 10);
        }
        std::vector<double> at;
        for (double t = std::ceil(low / step) * step; t <= high; t += step)
            at.push_back(logarithmic ? std::pow(10, t) : std::fabs(t) < 1e-9 * step ? 0 : t);
        return at;
    }
    std::string label(double x) const {
        return logarithmic ? fmt::format("1e{:.0f}", std::log10(x)) : fmt::format("{:.6g}", x);
    }
};

struct Frame {
    Axis x, y;

    explicit Frame(const Figure& figure) : x{figure.log_x}, y{figure.log_y} {
        for (const Series& series : figure.series)
            for (const auto& [px, py] : series.points)
                if (x.takes(px) && y.takes(py)) {
                    x.widen(px);
                    y.widen(py);
                }
        x.finish();
        y.finish();
        x.from = left;
        x.to = width - right;
        y.from = height - bottom;
        y.to = top;
    }
};

std::string text(double x, double y, std::string_view anchor, std::string_view what,
                 std::string_view more = "") {
    return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'{}>{}</text>\n", x, y, anchor, more,
                       escaped(what));
}

std::string grid(const Frame& frame, const Figure& figure) {
    std::string out;
    for (const double t : frame.x.ticks()) {
        const double x = frame.x.pixel(t);
        out += fmt::format("<path class='g' d='M{:.1f} {:.1f}V{:.1f}'/>\n", x, frame.y.from, frame.y.to);
        out += text(x, frame.y.from + 15, "middle", frame.x.label(t));
    }
    for (const double t : frame.y.ticks()) {
        const double y = frame.y.pixel(t);
        out += fmt::format("<path class='g' d='M{:.1f} {:.1f}H{:.1f}'/>\n", frame.x.from, y, frame.x.to);
        out += text(frame.x.from - 6, y + 4, "end", frame.y.label(t));
    }
    out += text((frame.x.from + frame.x.to) / 2, height - 10, "middle", figure.x_label);
    const double middle = (frame.y.from + frame.y.to) / 2;
    out +=
        text(14, middle, "middle", figure.y_label, fmt::format(" transform='rotate(-90 14 {:.1f})'", middle));
    return out;
}

std::string drawn(const Series& series, const Frame& frame, const char* colour) {
    std::string path, dots;
    for (const auto& [x, y] : series.points) {
        if (!frame.x.takes(x) || !frame.y.takes(y)) continue;
        const double px = frame.x.pixel(x), py = frame.y.pixel(y);
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
        dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.2'/>", px, py);
    }
    if (series.style == Series::Style::dots) return fmt::format("<g fill='{}'>{}</g>\n", colour, dots);
    const bool pale = series.style == Series::Style::reference;
    std::string line =
        fmt::format("<path fill='none' stroke='{}' stroke-width='{}' stroke-linejoin='round' d='{}'/>\n",
                    colour, pale ? 5 : 1.6, path);
    // A few points that were measured are marked on their line.
    if (!pale && series.points.size() <= 20) line += fmt::format("<g fill='{}'>{}</g>\n", colour, dots);
    return line;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '\'')
            out += "&#39;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string svg_of(const Figure& figure) {
    const Frame frame(figure);
    std::string lines, references, legend;
    std::size_t next = 0;
    double y = height;
    for (const Series& series : figure.series) {
        const bool pale = series.style == Series::Style::reference;
        const char* colour = pale ? reference_colour : colours[next++ % colours.size()];
        (pale ? references : lines) += drawn(series, frame, colour);
        if (series.name.empty()) continue;
        y += row;
        legend += fmt::format("<rect x='{:.0f}' y='{:.1f}' width='18' height='{}' fill='{}'/>\n", left, y - 7,
                              pale ? 5 : 3, colour);
        legend += text(left + 26, y, "start", series.name);
    }
    return fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' "
        "height='{1:.0f}' "
        "role='img' aria-label='{2}'>\n{3}{4}{5}{6}{7}</svg>\n",
        width, y + 12, escaped(figure.title),
        text(width / 2, 18, "middle", figure.title, " font-weight='bold'"), grid(frame, figure), references,
        lines, legend);
}

std::string error_bar(const Result& result) {
    constexpr double bar = 170, tall = 14;
    const auto place = [](double error) {
        return bar * (std::log10(std::clamp(error, 1e-15, 10.0)) + 15) / 16;
    };
    const double hard = place(result.bounds.hard);
    const double gold = result.bounds.gold ? place(*result.bounds.gold) : 0;
    const double at = std::isnan(result.error) ? bar : place(result.error);
    return fmt::format(
        "<svg width='{0}' height='{1}' viewBox='0 0 {0} {1}' role='img' aria-label='error and bounds'>"
        "<rect width='{0}' height='{1}' fill='#ffcdd2'/><rect width='{2:.1f}' height='{1}' "
        "fill='#e3f2fd'/><rect width='{3:.1f}' height='{1}' fill='#ffecb3'/>"
        "<path d='M{4:.1f} 1V{5}' stroke='#212121' stroke-width='3'/></svg>",
        bar, tall, hard, gold, std::clamp(at, 1.5, bar - 1.5), tall - 1);
}

}  // namespace carom::app
