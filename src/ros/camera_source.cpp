// camera_info is taken once it is calibrated; an uncalibrated one is reported once.
#include "camera_source.h"

#include <ros/console.h>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/camera_file.h"
#include "node_parameters.h"
#include "package_files.h"
#include "topics.h"

namespace evolin::ros_shell {

CameraSource::CameraSource(const ros::NodeHandle& handle, std::string owner, const Needs& needs,
                           const std::string& camera)
    : owner_(std::move(owner)) {
  if (needs.depth || needs.pose) {
    throw UnavailableError(owner_ + " needs " + (needs.depth ? "depth" : "poses") +
                           ", which this node does not deliver in this version");
  }
  if (!camera.empty()) {
    camera_ = loadCamera(camera.find('/') == std::string::npos ? camera : expandPath(camera),
                         cameraFolder());
  } else if (needs.camera) {
    camera_info_ = ros::NodeHandle(handle).subscribe(topics::kCameraInfo, 10,
                                                     &CameraSource::onCameraInfo, this);
  }
}

void CameraSource::fill(Frame* frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  frame->camera = camera_;
}

void CameraSource::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  try {
    const Camera camera = fromMessage(*message);
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_ = camera;
  } catch (const Error& error) {
    if (!warned_.exchange(true)) {
      ROS_WARN_STREAM(owner_ << ": " << camera_info_.getTopic() << ": " << error.what());
    }
  }
}

}  // namespace evolin::ros_shell
