// A moment by which work must be done, or a word to stop, for computations that may be broken off.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>

#include "evolin_ros/base/error.h"

namespace evolin {

/// Thrown by work that was broken off because its deadline passed or it was told to stop.
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

  /// Besides, the work ends once `stop` is true; it outlives the deadline. None: nothing stops it.
  void stopOn(const std::atomic<bool>* stop) { stop_ = stop; }

  bool stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }
  bool passed() const { return end_.has_value() && Clock::now() >= *end_; }

  /// Throws DeadlineError once it has passed or was stopped; some tens of nanoseconds until then.
  void check() const {
    if (stopped()) {
      throw DeadlineError("broken off: told to stop");
    }
    if (passed()) {
      throw DeadlineError("broken off: the time allowed for it has passed");
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<Clock::time_point> end_;
  const std::atomic<bool>* stop_ = nullptr;
};

}  // namespace evolin
