#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>

namespace carom::io {

/// A bar that says how far a long run has come. It appears after a second, is drawn ten times a second at
/// most, and wipes itself away at the end.
class Progress {
  public:
    /// `shown`: draw at all; see `is_terminal`.
    Progress(std::FILE* out, bool shown, std::uint64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(std::uint64_t done);

  private:
    using Clock = std::chrono::steady_clock;

    std::FILE* out_;
    bool shown_;
    bool drawn_ = false;
    std::uint64_t total_;
    Clock::time_point start_, next_;
};

/// Is the other end of the stream a person's terminal?
bool is_terminal(std::FILE* stream);

}  // namespace carom::io
