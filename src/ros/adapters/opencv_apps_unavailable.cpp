// The nodelet evolin_ros/OpencvAppsLines of a build without opencv_apps: it says what it would
// take.
#include <pluginlib/class_list_macros.hpp>

#include "evolin_ros/base/error.h"
#include "safe_nodelet.h"

namespace evolin::ros_shell {

class OpencvAppsLinesNodelet : public SafeNodelet {
 private:
  void start() override {
    throw UnavailableError(
        getName() +
        ": this build has no opencv_apps; install ros-noetic-opencv-apps (Debian: "
        "ros-opencv-apps and libopencv-apps-dev) and build again");
  }
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::OpencvAppsLinesNodelet, nodelet::Nodelet)
