#include "solver/bounce.hpp"

#include <algorithm>
#include <cmath>

namespace carom::detail {

Rebound rebound(double restitution, double gap, double speed, double acceleration, double step,
                double threshold) {
    double time_left = step;
    double impact = -speed;
    if (gap > 0) {
        const double squared = speed * speed - 2 * acceleration * gap;
        if (squared <= 0) return {};  // it turns back before it arrives
        impact = std::sqrt(squared);
        if (impact <= speed) return {};
        const double arrival = 2 * gap / (impact - speed);
        // The solver saw a hit at the very end of the step, perhaps by rounding alone: it is a hit all the
        // same.
        if (arrival > 1.001 * step) return {};
        time_left = std::max(0.0, step - arrival);
    }
    if (impact <= threshold) return {};

    constexpr int most_bounces = 64;
    for (int i = 0; i < most_bounces; ++i) {
        const double leaving = restitution * impact;
        const double flight = acceleration < 0 ? -2 * leaving / acceleration : step;
        if (flight >= time_left) {
            return {true, leaving + acceleration * time_left,
                    time_left * (leaving + 0.5 * acceleration * time_left)};
        }
        time_left -= flight;
        impact = leaving;
        if (impact <= threshold) break;
    }
    return {true, 0, 0};  // it came to rest within the step
}

}  // namespace carom::detail
