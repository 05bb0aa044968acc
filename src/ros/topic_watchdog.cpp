// Asks the master which topics exist, so that a wrong name shows beside the right one.
#include "topic_watchdog.h"

#include <ros/console.h>
#include <ros/master.h>

#include <utility>
#include <vector>

namespace evolin::ros_shell {

namespace {

/// Whether it is there at all; else topics of the same type, and only when there are none, all.
std::string whatThereIs(const std::string& expected, const std::string& type) {
  ros::master::V_TopicInfo topics;
  if (!ros::master::getTopics(topics)) {
    return "the master does not answer";
  }
  std::string same;
  std::string all;
  for (const ros::master::TopicInfo& topic : topics) {
    if (topic.name == expected) {
      return topic.datatype == type
                 ? "it is advertised but no message has come yet: its publisher is silent or has "
                   "not connected"
                 : "it is advertised with another type, " + topic.datatype;
    }
    if (topic.datatype == type) {
      same += (same.empty() ? "" : ", ") + topic.name;
    }
    all += (all.empty() ? "" : ", ") + topic.name;
  }
  if (!same.empty()) {
    return "published with this type: " + same;
  }
  return all.empty() ? "no topic is published"
                     : "none is published with this type; there are: " + all;
}

}  // namespace

TopicWatchdog::TopicWatchdog(const ros::NodeHandle& handle, std::string owner, double seconds)
    : owner_(std::move(owner)), seconds_(seconds) {
  if (seconds > 0) {
    timer_ = handle.createWallTimer(ros::WallDuration(0.25),
                                    [this](const ros::WallTimerEvent&) { check(); });
  }
}

void TopicWatchdog::expect(const std::string& topic, const std::string& type,
                           const std::string& hint) {
  const std::lock_guard<std::mutex> lock(mutex_);
  expected_[topic] = {type, hint, ros::WallTime()};
}

void TopicWatchdog::heard(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  expected_.erase(topic);
}

void TopicWatchdog::forget(const std::string& topic) { heard(topic); }

void TopicWatchdog::check() {
  if (ros::Time::now().isZero()) {
    return;
  }
  std::vector<std::pair<std::string, Expectation>> silent;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::WallTime now = ros::WallTime::now();
    for (auto entry = expected_.begin(); entry != expected_.end();) {
      if (entry->second.since.isZero()) {
        entry->second.since = now;
      }
      if ((now - entry->second.since).toSec() < seconds_) {
        ++entry;
        continue;
      }
      silent.emplace_back(*entry);
      entry = expected_.erase(entry);
    }
  }
  for (const auto& [topic, expectation] : silent) {
    ROS_WARN_STREAM(owner_ << ": no message on " << topic << " (" << expectation.type << ") for "
                           << seconds_ << " s; " << whatThereIs(topic, expectation.type) << "."
                           << (expectation.hint.empty() ? "" : " ") << expectation.hint);
  }
}

}  // namespace evolin::ros_shell
