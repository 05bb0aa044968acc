// Keeps a repeated message out of the log for a while, by wall time: recorded stamps may start near
// 0 or stand still.
#pragma once

#include <ros/time.h>

#include <mutex>

namespace evolin::ros_shell {

/// Safe for several threads.
class WallThrottle {
 public:
  /// True at most once in five seconds, the first time at once.
  bool due() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::WallTime now = ros::WallTime::now();
    if (!last_.isZero() && (now - last_).toSec() < kPeriod) {
      return false;
    }
    last_ = now;
    return true;
  }

 private:
  static constexpr double kPeriod = 5;

  std::mutex mutex_;
  ros::WallTime last_;
};

}  // namespace evolin::ros_shell
