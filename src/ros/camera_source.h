// The camera of a stream, from a file or from camera_info: for plug-ins that ask for it, and for
// rectifying images.
#pragma once

#include <image_geometry/pinhole_camera_model.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin::ros_shell {

/// What becomes of images of a camera with distortion.
enum class Rectify {
  kNever,   ///< taken as they are
  kAlways,  ///< rectified as image_proc does it: with D, R and P of camera_info
  kRefuse,  ///< an error
};

/// "false", "true" or "refuse"; throws Error naming another text.
Rectify parseRectify(const std::string& text);

/// Safe for several threads, fill() for one at a time.
class CameraSource {
 public:
  /// `camera` is a preset or a file ("" takes camera_info, subscribed only when the plug-in asks
  /// for the camera or `rectify` needs it). `owner` names the plug-in in messages. Throws
  /// UnavailableError when the plug-in needs depth or poses, which this node does not deliver, and
  /// Error for an unusable camera.
  CameraSource(const ros::NodeHandle& handle, std::string owner, const Needs& needs,
               const std::string& camera, Rectify rectify = Rectify::kNever);

  /// Sets `frame->camera` where it is known and, as asked for, rectifies the image; the camera is
  /// then that of the rectified image, without distortion. An image without any distortion stays
  /// shared. With kAlways and kRefuse the first calibrated camera is waited for, for at most two
  /// seconds of wall time; throws Error when there is none, when it is of another image size, or
  /// when the image is refused.
  void fill(Frame* frame);

  /// Breaks off a fill() that waits, and all to come.
  void stop();

 private:
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void rectify(const sensor_msgs::CameraInfoConstPtr& info, Frame* frame);

  std::string owner_;
  Rectify rectify_;
  image_geometry::PinholeCameraModel model_;  ///< keeps its maps from frame to frame
  std::mutex mutex_;                          ///< guards what follows, up to the blank line
  std::condition_variable changed_;
  std::optional<Camera> camera_;
  sensor_msgs::CameraInfoConstPtr info_;  ///< with camera_
  std::string problem_;                   ///< of the last camera_info, when it cannot be used
  bool warned_ = false;
  bool waited_ = false;
  bool stopping_ = false;

  ros::Subscriber camera_info_;
};

}  // namespace evolin::ros_shell
