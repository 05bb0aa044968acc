// Says once, by name, which expected topic stays silent and what is there instead.
#pragma once

#include <ros/node_handle.h>

#include <map>
#include <mutex>
#include <string>

namespace evolin::ros_shell {

/// Safe for several threads. Waiting counts in wall time, from the moment that the topic was
/// expected and ROS time runs (with use_sim_time: from the first /clock).
class TopicWatchdog {
 public:
  /// `owner` stands at the head of the warnings; silent for good when `seconds` is 0.
  TopicWatchdog(const ros::NodeHandle& handle, std::string owner, double seconds);

  /// `topic` is a resolved name, `type` its message type, `hint` what to do ("" for none).
  void expect(const std::string& topic, const std::string& type, const std::string& hint);
  void heard(const std::string& topic);
  /// Not waited for any more, for example because nobody listens.
  void forget(const std::string& topic);

 private:
  struct Expectation {
    std::string type;
    std::string hint;
    ros::WallTime since;
  };

  void check();

  std::string owner_;
  double seconds_;
  std::mutex mutex_;
  std::map<std::string, Expectation> expected_;
  ros::WallTimer timer_;
};

}  // namespace evolin::ros_shell
