// Brings images and their lines together by stamp, in order of time and within a bounded memory.
#pragma once

#include <evolin_ros/LineArray.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace evolin::ros_shell {

/// The lines' stream leads: a stamp of it that lies before the last one taken is a jump back in
/// time. The two streams jump at their own time: lines of the pass before wait on for their images.
/// One thread at a time.
class FrameLinesJoiner {
 public:
  struct Pair {
    sensor_msgs::ImageConstPtr image;
    evolin_ros::LineArrayConstPtr lines;
    /// Time jumped back before it: what is remembered of earlier frames is of another pass.
    bool begins_pass = false;
  };
  struct Result {
    std::vector<Pair> complete;              ///< in the order of the lines
    std::string problem;                     ///< for the log: what had to be left out and why
    std::vector<std_msgs::Header> left_out;  ///< of the lines that will get no image
  };

  /// Keeps at most `capacity` images and as many line arrays that wait for their image.
  explicit FrameLinesJoiner(std::size_t capacity) : capacity_(capacity) {}

  Result addImage(const sensor_msgs::ImageConstPtr& image);
  Result addLines(const evolin_ros::LineArrayConstPtr& lines);

 private:
  struct WaitingLines {
    evolin_ros::LineArrayConstPtr message;
    int pass;
  };

  void pair(Result* result);

  std::size_t capacity_;
  std::deque<sensor_msgs::ImageConstPtr> images_;
  std::deque<WaitingLines> lines_;
  std::optional<ros::Time> last_lines_;
  int pass_ = 0;         ///< of the newest lines
  int paired_pass_ = 0;  ///< of the newest pair
};

}  // namespace evolin::ros_shell
