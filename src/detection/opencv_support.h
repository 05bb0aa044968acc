// What the detectors made of OpenCV's functions share.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Throws ConfigError for a Canny aperture other than 3, 5 and 7.
void requireOddAperture(const std::string& owner, int canny_aperture);

/// Rows x1 y1 x2 y2 as lines without score and id.
LineSegments toLineSegments(const std::vector<cv::Vec4f>& rows);
LineSegments toLineSegments(const std::vector<cv::Vec4i>& rows);

/// Converts the image to grey, calls `detect` on it and cuts the lines to the image: OpenCV's LSD
/// gives some that end pixels beyond, its Hough transform some of no length. Throws Error when the
/// plug-in is not configured, the image is not 8-bit grey or BGR, or OpenCV itself throws.
template <typename Detect>
LineSegments detectOnGray(const std::string& owner, bool configured, const Frame& frame,
                          Detect detect) {
  if (!configured) {
    throw Error(owner + ": detect() was called before configure()");
  }
  cv::Mat gray = toGray(frame.image);
  if (gray.isSubmatrix() || !gray.isContinuous()) {
    // OpenCV's filters would see the pixels around a window, and EdgeDrawing expects one run.
    gray = gray.clone();
  }
  try {
    return LineFilter().apply(detect(gray), gray.size(), owner);
  } catch (const cv::Exception& error) {
    throw Error(owner + ": OpenCV failed on the image of " + std::to_string(gray.cols) + "x" +
                std::to_string(gray.rows) + " pixels of frame '" + frame.name +
                "': " + error.what());
  }
}

}  // namespace evolin
