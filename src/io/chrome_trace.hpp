#pragma once

#include <string>

#include "carom/profile.hpp"
#include "io/output_file.hpp"

namespace carom::io {

/// Writes what steps take in the format of Chrome's tracing tool, which Perfetto (ui.perfetto.dev) and
/// chrome://tracing open: a bar a step, in it a bar a stage, and curves of how much there was to do.
class ChromeTrace {
  public:
    /// Throws `Error` when the file cannot be written.
    explicit ChromeTrace(const std::string& path);
    void write_step(const StepProfile& profile);
    void finish();

  private:
    void bar(const char* name, double begin, double seconds);

    OutputFile file_;
    bool first_ = true;
};

}  // namespace carom::io
