// The time that passes, on the wall.
#pragma once

#include <chrono>

namespace evolin {

/// Runs on the steady clock from its construction on.
class StopWatch {
 public:
  void restart() { begin_ = Clock::now(); }

  /// Since it was made or last started again.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  double milliseconds() const { return 1e3 * seconds(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace evolin
