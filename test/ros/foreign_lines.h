// A stream of opencv_apps' lines; none where that package is absent.
#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#ifdef EVOLIN_HAS_OPENCV_APPS
#include <opencv_apps/LineArrayStamped.h>
#endif

namespace evolin::test {

#ifdef EVOLIN_HAS_OPENCV_APPS
constexpr bool kHasOpencvApps = true;

class ForeignLines {
 public:
  explicit ForeignLines(ros::NodeHandle* handle)
      : lines_(handle->advertise<opencv_apps::LineArrayStamped>("opencv_apps_lines", 0)) {}

  void publish(const std_msgs::Header& header) {
    const auto message = boost::make_shared<opencv_apps::LineArrayStamped>();
    message->header = header;
    message->lines.resize(1);
    message->lines[0].pt2.x = 10;
    lines_.publish(message);
  }

 private:
  ros::Publisher lines_;
};
#else
constexpr bool kHasOpencvApps = false;

class ForeignLines {
 public:
  explicit ForeignLines(ros::NodeHandle* /*handle*/) {}
  void publish(const std_msgs::Header& /*header*/) {}
};
#endif

}  // namespace evolin::test
