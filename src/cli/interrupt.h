// Ctrl-C as a question that long loops ask.
#pragma once

#include <csignal>

namespace evolin::cli {

/// While one lives, SIGINT and SIGTERM do not end the program but make interrupted() true; a second
/// signal ends it at once. Restores the former handlers. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Since construction; may be asked from any thread.
  bool interrupted() const;

 private:
  struct sigaction former_int_ = {};
  struct sigaction former_term_ = {};
};

}  // namespace evolin::cli
