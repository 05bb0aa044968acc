// A moment by which work must be done, for computations that may be broken off.
#pragma once

#include <chrono>
#include <optional>

#include "evolin_ros/base/error.h"

namespace evolin {

/// Thrown by work that was broken off because its deadline passed.
class DeadlineError : public Error {
 public:
  using Error::Error;
};

class Deadline {
 public:
  /// Never passes.
  Deadline() = default;

  /// `seconds` from now by the steady clock. Never passes for a number that the clock cannot hold,
  /// infinity among them.
  static Deadline after(double seconds) {
    constexpr double kYear = 3.2e7;
    Deadline deadline;
    if (seconds < kYear) {
      deadline.end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(seconds));
    }
    return deadline;
  }

  bool passed() const { return end_.has_value() && Clock::now() >= *end_; }

  /// Throws DeadlineError once it has passed; some tens of nanoseconds until then.
  void check() const {
    if (passed()) {
      throw DeadlineError("broken off: the time allowed for it has passed");
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<Clock::time_point> end_;
};

}  // namespace evolin
