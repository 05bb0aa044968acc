// Count, rate and remaining time.
#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace evolin::cli {

namespace {

constexpr double kTerminalPeriod = 0.1;  // s between two updates of the line
constexpr double kLogPeriod = 5;         // s between two lines where each stays

double secondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      begin_(Clock::now()),
      shown_(begin_) {}

std::string Progress::line(std::size_t done, bool with_remaining) const {
  const double seconds = std::max(secondsSince(begin_), 1e-9);
  const double rate = static_cast<double>(done) / seconds;
  char text[128];
  std::snprintf(text, sizeof text, " %zu of %zu, %.1f per second", done, total_, rate);
  std::string result = what_ + text;
  if (with_remaining && done > 0 && done < total_) {
    std::snprintf(text, sizeof text, ", %.0f s remaining",
                  static_cast<double>(total_ - done) / rate);
    result += text;
  }
  return result;
}

void Progress::update(std::size_t done) {
  if (secondsSince(shown_) < (terminal_ ? kTerminalPeriod : kLogPeriod)) {
    return;
  }
  shown_ = Clock::now();
  std::fprintf(stderr, terminal_ ? "\r%s\033[K" : "%s\n", line(done, true).c_str());
}

void Progress::finish(std::size_t done) {
  std::fprintf(stderr, terminal_ ? "\r%s\033[K\n" : "%s\n", line(done, false).c_str());
}

}  // namespace evolin::cli
