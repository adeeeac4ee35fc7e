#include "carom/parts/engine.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

constexpr double per_minute = pi / 30;  // rad/s of 1/min
constexpr double slow = 1;              // m/s: below it the reverse gear goes in and out

void check(const Engine& engine, const Gearbox& gears) {
    if (engine.torque.size() < 2) throw Error("engine.torque: needs at least two points");
    for (std::size_t i = 0; i < engine.torque.size(); ++i) {
        const std::string name = component("engine.torque", static_cast<int>(i));
        require_positive(engine.torque[i][0], name);
        require_not_negative(engine.torque[i][1], name);
        if (i > 0 && !(engine.torque[i][0] > engine.torque[i - 1][0]))
            refuse(name, engine.torque[i][0], "is not above the speed before");
    }
    require_positive(engine.idle, "engine.idle");
    require_not_negative(engine.braking, "engine.braking");
    if (gears.ratios.empty()) throw Error("gearbox.ratios: there are none");
    for (std::size_t i = 0; i < gears.ratios.size(); ++i) {
        const std::string name = component("gearbox.ratios", static_cast<int>(i));
        require_positive(gears.ratios[i], name);
        if (i > 0 && gears.ratios[i] >= gears.ratios[i - 1])
            refuse(name, gears.ratios[i], "is not below the ratio before");
    }
    require_positive(gears.reverse, "gearbox.reverse");
    require_positive(gears.final_drive, "gearbox.final_drive");
    require_positive(gears.efficiency, "gearbox.efficiency");
    require_in(gears.efficiency, 0, 1, "gearbox.efficiency");
    require_positive(gears.shift_down, "gearbox.shift_down");
    if (!(gears.shift_up > gears.shift_down))
        refuse("gearbox.shift_up", gears.shift_up, "is not above shift_down");
    require_not_negative(gears.shift_time, "gearbox.shift_time");
}

}  // namespace

Drivetrain::Drivetrain(const Engine& engine, const Gearbox& gears) : engine_(engine), gears_(gears) {
    check(engine, gears);
    engine_speed_ = engine.idle;
}

/// Turns of the engine for one of the driven wheels; negative in reverse.
double Drivetrain::ratio() const {
    return gears_.final_drive *
           (gear_ < 0 ? -gears_.reverse : gears_.ratios[static_cast<std::size_t>(gear_ - 1)]);
}

double Drivetrain::fastest() const { return engine_.torque.back()[0] * per_minute / std::fabs(ratio()); }

void Drivetrain::update(double axle, double speed, bool reverse, double dt) {
    engine_speed_ = std::max(engine_.idle, axle * ratio() / per_minute);
    shifting_ = std::max(0.0, shifting_ - dt);
    const int before = gear_;
    if (reverse != (gear_ < 0)) {
        if (std::fabs(speed) < slow) gear_ = reverse ? -1 : 1;
    } else if (gear_ > 0 && shifting_ == 0) {
        if (engine_speed_ > gears_.shift_up && gear_ < static_cast<int>(gears_.ratios.size())) ++gear_;
        if (engine_speed_ < gears_.shift_down && gear_ > 1) --gear_;
    }
    if (gear_ != before) shifting_ = gears_.shift_time;
}

double Drivetrain::torque(double throttle) const {
    if (shifting_ > 0) return 0;
    const auto& curve = engine_.torque;
    const double most = curve.back()[0], at = std::clamp(engine_speed_, curve.front()[0], most);
    std::size_t i = 1;
    while (i + 1 < curve.size() && at > curve[i][0]) ++i;
    const double share = (at - curve[i - 1][0]) / (curve[i][0] - curve[i - 1][0]);
    const double full = curve[i - 1][1] + share * (curve[i][1] - curve[i - 1][1]);
    const double over_idle = std::max(0.0, engine_speed_ - engine_.idle) / most;
    const double shaft = throttle * full - (1 - throttle) * engine_.braking * over_idle;
    return shaft * ratio() * gears_.efficiency;
}

}  // namespace carom
