#include "io/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <string>

namespace carom::io {

using namespace std::chrono_literals;

Progress::Progress(std::FILE* out, bool shown, std::uint64_t total)
    : out_(out), shown_(shown && total > 0), total_(total), start_(Clock::now()), next_(start_ + 1s) {}

Progress::~Progress() {
    if (!drawn_) return;
    std::fputs("\r\033[K", out_);  // back to the start of the line, and erase it
    std::fflush(out_);
}

void Progress::update(std::uint64_t done) {
    if (!shown_) return;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + 100ms;
    drawn_ = true;

    constexpr std::uint64_t width = 40;
    const std::uint64_t filled = width * done / total_;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double left =
        done > 0 ? seconds / static_cast<double>(done) * static_cast<double>(total_ - done) : 0;
    fmt::print(out_, "\r[{}{}] {}/{} steps, {:.0f} s left\033[K", std::string(filled, '='),
               std::string(width - filled, ' '), done, total_, left);
    std::fflush(out_);
}

bool is_terminal(std::FILE* stream) { return isatty(fileno(stream)) != 0; }

}  // namespace carom::io
