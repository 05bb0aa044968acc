// camera_info is taken once it is calibrated; an uncalibrated one is reported once.
#include "camera_source.h"

#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "node_parameters.h"
#include "package_files.h"
#include "topics.h"

namespace evolin::ros_shell {

namespace {

/// camera_info is sent with every image, so that it is late by little.
constexpr std::chrono::seconds kFirstCamera(2);

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// P of cameras that no calibration has filled in is K without distortion.
sensor_msgs::CameraInfoConstPtr withProjection(const sensor_msgs::CameraInfoConstPtr& info) {
  if (info->P[0] != 0) {
    return info;
  }
  const auto filled = boost::make_shared<sensor_msgs::CameraInfo>(*info);
  for (std::size_t row = 0; row < 3; ++row) {
    std::copy_n(info->K.begin() + static_cast<std::ptrdiff_t>(3 * row), 3,
                filled->P.begin() + static_cast<std::ptrdiff_t>(4 * row));
  }
  if (info->R[0] == 0) {
    filled->R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  }
  return filled;
}

/// Whether rectified and raw image are the same.
bool isRectified(const sensor_msgs::CameraInfo& info) {
  const auto& k = info.K;
  const auto& p = info.P;
  const boost::array<double, 9> identity = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  return info.R == identity && p[0] == k[0] && p[2] == k[2] && p[5] == k[4] && p[6] == k[5];
}

}  // namespace

Rectify parseRectify(const std::string& text) {
  if (text == "false") {
    return Rectify::kNever;
  }
  if (text == "true") {
    return Rectify::kAlways;
  }
  if (text == "refuse") {
    return Rectify::kRefuse;
  }
  throw Error("rectify: expected false, true or refuse, got " + quote(text));
}

CameraSource::CameraSource(const ros::NodeHandle& handle, std::string owner, const Needs& needs,
                           const std::string& camera, Rectify rectify)
    : owner_(std::move(owner)), rectify_(rectify) {
  if (needs.depth || needs.pose) {
    throw UnavailableError(owner_ + " needs " + (needs.depth ? "depth" : "poses") +
                           ", which this node does not deliver in this version");
  }
  if (!camera.empty()) {
    camera_ = cameraOfParameter(camera, cameraFolder());
    info_ = boost::make_shared<sensor_msgs::CameraInfo>(toMessage(*camera_, std_msgs::Header()));
  } else if (needs.camera || rectify != Rectify::kNever) {
    camera_info_ = ros::NodeHandle(handle).subscribe(topics::kCameraInfo, 10,
                                                     &CameraSource::onCameraInfo, this);
  }
}

void CameraSource::fill(Frame* frame) {
  sensor_msgs::CameraInfoConstPtr info;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (rectify_ != Rectify::kNever) {
      // Once: a stream without cameras must not wait at every frame.
      if (!std::exchange(waited_, true)) {
        changed_.wait_for(lock, kFirstCamera,
                          [this] { return stopping_ || camera_ || !problem_.empty(); });
      }
      if (!camera_) {
        throw Error("~rectify needs the camera: " +
                    (problem_.empty() ? "no message on " + camera_info_.getTopic() : problem_));
      }
    }
    frame->camera = camera_;
    info = info_;
  }
  if (rectify_ == Rectify::kRefuse && hasDistortion(*frame->camera)) {
    throw Error("the camera has distortion (" + frame->camera->distortion_model +
                ") and ~rectify is refuse; remap 'image' to the rectified image, or set ~rectify "
                "to true");
  }
  if (rectify_ == Rectify::kAlways) {
    rectify(withProjection(info), frame);
  }
}

void CameraSource::rectify(const sensor_msgs::CameraInfoConstPtr& info, Frame* frame) {
  Camera& camera = *frame->camera;
  if (frame->image.cols != camera.width || frame->image.rows != camera.height) {
    throw Error("~rectify: the image is " + sizeText(frame->image.cols, frame->image.rows) +
                " but its camera_info, with region of interest and binning, is for " +
                sizeText(camera.width, camera.height));
  }
  if (!hasDistortion(camera) && isRectified(*info)) {
    return;
  }
  cv::Mat rectified;
  try {
    model_.fromCameraInfo(info);
    model_.rectifyImage(frame->image, rectified, cv::INTER_LINEAR);
  } catch (const std::exception& error) {  // image_geometry's and OpenCV's own
    throw Error(std::string("~rectify: ") + error.what());
  }
  frame->image = rectified;
  frame->owner.reset();
  camera.fx = model_.fx();
  camera.fy = model_.fy();
  camera.cx = model_.cx();
  camera.cy = model_.cy();
  camera.distortion.clear();
}

void CameraSource::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void CameraSource::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  std::string warning;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    try {
      camera_ = fromMessage(*message);
      info_ = message;
    } catch (const Error& error) {
      problem_ = error.what();
      if (!std::exchange(warned_, true)) {
        warning = problem_;
      }
    }
  }
  changed_.notify_all();
  if (!warning.empty()) {
    ROS_WARN_STREAM(owner_ << ": " << camera_info_.getTopic() << ": " << warning);
  }
}

}  // namespace evolin::ros_shell
