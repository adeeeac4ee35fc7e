#pragma once

#include <chrono>

#include "carom/profile.hpp"

namespace carom::detail {

/// Keeps the times of the stages of a step; allocates in the first step only.
class Profiler {
  public:
    StepProfile profile;

    void begin_step() {
        profile.stages.clear();
        profile.begin = last_ = now();
    }
    /// The stage began when the one before it ended.
    void end_stage(const char* name) {
        const double end = now();
        profile.stages.push_back({name, last_, end - last_});
        last_ = end;
    }
    void end_step() { profile.seconds = last_ - profile.begin; }

  private:
    using Clock = std::chrono::steady_clock;

    double now() const { return std::chrono::duration<double>(Clock::now() - origin_).count(); }

    Clock::time_point origin_ = Clock::now();
    double last_ = 0;
};

}  // namespace carom::detail
