// The camera of a stream, from a file or from camera_info, for plug-ins that ask for it.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin::ros_shell {

/// Safe for several threads.
class CameraSource {
 public:
  /// `camera` is a preset or a file ("" takes camera_info, subscribed only when the plug-in asks
  /// for the camera). `owner` names the plug-in in messages. Throws UnavailableError when the
  /// plug-in needs depth or poses, which this node does not deliver, and Error for an unusable
  /// camera.
  CameraSource(const ros::NodeHandle& handle, std::string owner, const Needs& needs,
               const std::string& camera);

  /// Sets `frame->camera` where it is known.
  void fill(Frame* frame) const;

 private:
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);

  std::string owner_;
  mutable std::mutex mutex_;
  std::optional<Camera> camera_;
  std::atomic<bool> warned_{false};
  ros::Subscriber camera_info_;
};

}  // namespace evolin::ros_shell
