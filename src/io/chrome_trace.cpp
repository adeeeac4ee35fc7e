#include "io/chrome_trace.hpp"

#include <fmt/format.h>

namespace carom::io {

namespace {

constexpr double microseconds = 1e6;

}  // namespace

ChromeTrace::ChromeTrace(const std::string& path) : file_(path, "profile") {
    file_.write("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n");
}

void ChromeTrace::bar(const char* name, double begin, double seconds) {
    file_.write(fmt::format(R"({}{{"name":"{}","ph":"X","pid":1,"tid":1,"ts":{:.3f},"dur":{:.3f}}})",
                            first_ ? "" : ",\n", name, begin * microseconds, seconds * microseconds));
    first_ = false;
}

void ChromeTrace::write_step(const StepProfile& profile) {
    bar("step", profile.begin, profile.seconds);
    for (const StageTime& stage : profile.stages) bar(stage.name, stage.begin, stage.seconds);
    file_.write(fmt::format(
        ",\n"
        R"({{"name":"work","ph":"C","pid":1,"ts":{:.3f},"args":{{"awake bodies":{},"pairs":{},"contacts solved":{},"contacts looked at":{}}}}})",
        profile.begin * microseconds, profile.awake, profile.pairs, profile.solved, profile.looked_at));
}

void ChromeTrace::finish() {
    file_.write("\n]}\n");
    file_.finish();
}

}  // namespace carom::io
