// camera_info to views of images.
#include "adapter_camera.h"

#include <algorithm>
#include <utility>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "node_parameters.h"
#include "package_files.h"
#include "topics.h"

namespace evolin::ros_shell {

namespace {

ImageView imageViewOf(const Camera& camera, AdapterPixels pixels) {
  return pixels == AdapterPixels::kDistorted ? ImageView::distorted(camera)
                                             : ImageView::rectified(camera);
}

ImageView rectifiedViewOf(const sensor_msgs::CameraInfo& message) {
  sensor_msgs::CameraInfo pinhole = message;
  pinhole.D.clear();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  // Drivers of cameras that nobody rectified leave both empty.
  if (message.P[0] != 0) {
    pinhole.K = {message.P[0], 0, message.P[2], 0, message.P[5], message.P[6], 0, 0, 1};
    if (std::any_of(message.R.begin(), message.R.end(), [](double value) { return value != 0; })) {
      std::copy(message.R.begin(), message.R.end(), rotation.data());
      rotation.transposeInPlace();  // messages are row by row
    }
  }
  return ImageView::rectified(fromMessage(pinhole), rotation);
}

/// Whether nothing but stamp and running number differs: making a view takes a millisecond.
bool isSameCamera(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.header.frame_id == b.header.frame_id && a.width == b.width && a.height == b.height &&
         a.distortion_model == b.distortion_model && a.D == b.D && a.K == b.K && a.R == b.R &&
         a.P == b.P && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi.x_offset == b.roi.x_offset && a.roi.y_offset == b.roi.y_offset &&
         a.roi.width == b.roi.width && a.roi.height == b.roi.height;
}

}  // namespace

AdapterPixels parsePixels(const std::string& name) {
  if (name != "distorted" && name != "rectified") {
    throw Error("pixels " + quote(name) + ": expected distorted or rectified");
  }
  return name == "distorted" ? AdapterPixels::kDistorted : AdapterPixels::kRectified;
}

AdapterView viewOf(const sensor_msgs::CameraInfo& message, AdapterPixels pixels) {
  const std::string frame = withoutLeadingSlash(message.header.frame_id);
  switch (pixels) {
    case AdapterPixels::kRectified:
      return {rectifiedViewOf(message), frame};
    case AdapterPixels::kSizeOnly: {
      sensor_msgs::CameraInfo sized = message;
      sized.K = {1, 0, 0, 0, 1, 0, 0, 0, 1};
      sized.D.clear();
      sized.distortion_model.clear();
      return {ImageView::rectified(fromMessage(sized)), frame};
    }
    default:
      return {ImageView::distorted(fromMessage(message)), frame};
  }
}

AdapterCamera::AdapterCamera(ros::NodeHandle& handle, Options options, Callbacks callbacks)
    : options_(std::move(options)), callbacks_(std::move(callbacks)) {
  if (isAwaited()) {
    camera_info_ =
        handle.subscribe(topics::kCameraInfo, kResultQueue, &AdapterCamera::onCameraInfo, this);
    return;
  }
  const Camera camera = cameraOfParameter(options_.camera, cameraFolder());
  view_ = AdapterView{imageViewOf(camera, options_.pixels), withoutLeadingSlash(options_.frame_id)};
}

void AdapterCamera::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  if (taken_ && isSameCamera(*message, *taken_)) {
    return;
  }
  const bool first = !view_;
  try {
    view_ = viewOf(*message, options_.pixels);
  } catch (const std::exception& error) {
    callbacks_.unusable(error.what());
    return;
  }
  taken_ = message;
  if (!options_.frame_id.empty()) {
    view_->frame_id = withoutLeadingSlash(options_.frame_id);
  }
  if (first) {
    callbacks_.known();
  }
}

}  // namespace evolin::ros_shell
