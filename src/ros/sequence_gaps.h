// Counts messages that a full queue has thrown away, by their running numbers.
#pragma once

#include <sensor_msgs/Image.h>

#include <cstdint>
#include <optional>

namespace evolin::ros_shell {

/// Publishers of ROS 1 number their messages; a number that falls or stands still tells nothing (a
/// restarted or numberless publisher).
class SequenceGaps {
 public:
  /// How many messages are missing between the previous one and this.
  std::uint32_t lostBefore(const sensor_msgs::Image& message) {
    const std::uint32_t number = message.header.seq;
    const std::uint32_t lost = last_ && number > *last_ ? number - *last_ - 1 : 0;
    last_ = number;
    return lost;
  }

 private:
  std::optional<std::uint32_t> last_;
};

}  // namespace evolin::ros_shell
