// Frames in front of a flat wall, for the metrics that carry lines through space.
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/metrics/spatial_lines.h"
#include "test/metrics/vectorized_support.h"

namespace evolin::test {

constexpr int kWallSide = 128;  // one pixel of the image is one pixel of the scaled image
constexpr double kWallDepth = 2;
constexpr double kFocalLength = 128;  // with the depth: all arithmetic is exact
constexpr double kMetresPerPixel = kWallDepth / kFocalLength;  // of sideways motion

inline Camera wallCamera() {
  Camera camera;
  camera.fx = kFocalLength;
  camera.fy = kFocalLength;
  camera.cx = 64;
  camera.cy = 64;
  return camera;
}

inline cv::Mat wallDepth() {
  return cv::Mat(kWallSide, kWallSide, CV_32FC1, cv::Scalar(kWallDepth));
}

/// The camera so far to the right that the wall's image moves left by `pixels`.
inline Pose poseRight(double pixels) {
  Pose pose;
  pose.translation.x() = pixels * kMetresPerPixel;
  return pose;
}

inline SpatialFrame wallFrame(Protocol protocol, const LineSegments& lines,
                              double pixels_right = 0) {
  return liftLines(protocol, "wall", lines, DepthMap(wallDepth()), wallCamera(),
                   poseRight(pixels_right));
}

/// The same with depth in the columns below `columns` alone.
inline SpatialFrame halfWallFrame(Protocol protocol, const LineSegments& lines, int columns,
                                  double pixels_right = 0) {
  cv::Mat depth = wallDepth();
  depth.colRange(columns, kWallSide).setTo(0);
  return liftLines(protocol, "wall", lines, DepthMap(depth), wallCamera(), poseRight(pixels_right));
}

}  // namespace evolin::test
