// The camera whose pixels an adapter speaks of: from camera_info, a preset or a file.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "evolin_ros/geometry/image_view.h"

namespace evolin::ros_shell {

/// Which images lines are measured in.
enum class AdapterPixels {
  kDistorted,  ///< as the sensor gives them: K and D of camera_info
  kRectified,  ///< rectified: P and R
  kSizeOnly,   ///< lines are in pixels already; only the size matters, so that K may be 0
};

/// "distorted" or "rectified"; throws Error for another word.
AdapterPixels parsePixels(const std::string& name);

struct AdapterView {
  ImageView view;
  std::string frame_id;  ///< of the images; without a leading slash
};

/// Binning and region of interest are applied. Where P is empty, rectified images are taken to have
/// K. Throws Error for an uncalibrated camera (not with kSizeOnly) or an unknown distortion model.
AdapterView viewOf(const sensor_msgs::CameraInfo& message, AdapterPixels pixels);

class AdapterCamera {
 public:
  struct Options {
    std::string camera;  ///< preset or file; "": camera_info
    AdapterPixels pixels = AdapterPixels::kDistorted;
    std::string frame_id;  ///< instead of camera_info's; "": that
  };
  struct Callbacks {
    std::function<void()> known;  ///< for the first time
    std::function<void(const std::string&)>
        unusable;  ///< a camera_info could not be taken, and why
  };

  /// Callbacks run on the handle's queue, not in the constructor. Throws Error for an unusable
  /// preset or file.
  AdapterCamera(ros::NodeHandle& handle, Options options, Callbacks callbacks);

  /// None until the camera is known.
  const AdapterView* view() const { return view_ ? &*view_ : nullptr; }

  /// No callback runs once this has returned.
  void stop() { camera_info_.shutdown(); }

  /// Whether it is camera_info that tells.
  bool isAwaited() const { return options_.camera.empty(); }

 private:
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);

  Options options_;
  Callbacks callbacks_;
  std::optional<AdapterView> view_;
  sensor_msgs::CameraInfoConstPtr taken_;  ///< what the view was made of
  ros::Subscriber camera_info_;
};

}  // namespace evolin::ros_shell
