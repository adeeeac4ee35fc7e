#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace carom::app {

/// A line of a figure. The reference is drawn thick and pale, beneath what was measured.
struct Series {
    enum class Style { line, reference, dots };
    std::string name;
    Style style = Style::line;
    std::vector<std::pair<double, double>> points{};
};

/// What a case looks like: results against their reference.
struct Figure {
    std::string title, x_label, y_label;
    bool log_x = false, log_y = false;
    std::vector<Series> series{};
};

/// A reference as a function, drawn at 200 places.
inline Series reference(std::string name, double from, double to, const std::function<double(double)>& f) {
    Series s{std::move(name), Series::Style::reference};
    for (int i = 0; i <= 200; ++i) {
        const double x = from + (to - from) * i / 200;
        s.points.emplace_back(x, f(x));
    }
    return s;
}

/// The order of a method by its errors at the largest and the smallest step: the slope in a figure whose two
/// axes are logarithmic.
double measured_order(const Series& errors);

// The figures of each case that has some; each function lives in the file of its subject.
std::vector<Figure> projectile_figures();
std::vector<Figure> orbit_figures();
std::vector<Figure> oscillator_figures();
std::vector<Figure> racket_figures();
std::vector<Figure> incline_figures();
std::vector<Figure> slide_figures();
std::vector<Figure> roll_figures();
std::vector<Figure> bounce_figures();
std::vector<Figure> cradle_figures();
std::vector<Figure> pendulum_figures();
std::vector<Figure> double_pendulum_figures();
std::vector<Figure> machine_figures();
std::vector<Figure> buoyancy_figures();

}  // namespace carom::app
