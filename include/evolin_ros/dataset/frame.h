// One camera frame with what may come with it, as detectors, associators and evaluation take it.
#pragma once

#include <any>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin {

/// Images are shared, not copied (cv::Mat); nobody writes into them. `owner` keeps memory alive
/// that the images merely point into (a message of the middleware).
struct Frame {
  Stamp stamp = 0;
  std::string name;  ///< file stem, or the stamp for a live stream
  cv::Mat image;     ///< CV_8UC1, or CV_8UC3 in BGR order
  cv::Mat depth;     ///< CV_32FC1 metres, NaN: no depth; empty: the frame has none
  std::optional<Camera> camera;
  std::optional<Pose> pose;  ///< camera to world
  std::shared_ptr<const void> owner;
};

/// A frame with its lines. `description` is the associator's own cache (descriptors), filled at the
/// first match and reused in the next; one thread at a time.
struct FrameLines {
  Frame frame;
  LineSegments lines;
  mutable std::any description;
};

/// 8-bit grey of `image` as OpenCV's BGR2GRAY makes it; a grey image is returned without a copy.
/// Throws Error for another type or an empty image.
cv::Mat toGray(const cv::Mat& image);

}  // namespace evolin
