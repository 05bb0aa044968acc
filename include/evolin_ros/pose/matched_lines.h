// Matched lines as relative pose takes them: each with its pixels and its two points in space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// A segment with depth. Points in the frame of its camera, metres, z along the optical axis.
struct SpatialLine {
  Eigen::Vector2d pixel1 = Eigen::Vector2d::Zero();
  Eigen::Vector2d pixel2 = Eigen::Vector2d::Zero();
  Eigen::Vector3d point1 = Eigen::Vector3d::Zero();
  Eigen::Vector3d point2 = Eigen::Vector3d::Zero();
};

struct SpatialMatch {
  SpatialLine first;
  SpatialLine second;
  std::size_t match = 0;  ///< its place in the list of index pairs that it came from
};

using SpatialMatches = std::vector<SpatialMatch>;

/// How endpoints become points.
enum class EndpointRule {
  kTruncated,  ///< clamped to the image one coordinate at a time, then truncated to whole pixels
  kExact,      ///< the segment cut at the image's border; depth of the nearest pixel, exact point
};

/// Depth of one frame: CV_16UC1 or CV_32FC1, `factor` units a metre (1: the image is in metres).
/// Zero, negative and non-finite values mean that there is none.
struct DepthImage {
  cv::Mat image;
  double factor = 1;
};

/// Lifts the matches that have depth at all four endpoints, in their order; the others are left
/// out, as under kExact are segments wholly outside the image. Intrinsics are used as they are (fy
/// may be negative); distortion is not undone. The image is as large as its depth image. Throws
/// Error for an index beyond the lines, a depth image of another type or without pixels, two of
/// different sizes, a line that is not finite, and intrinsics as validateCamera() would (a focal
/// length of zero).
SpatialMatches liftMatches(const LineSegments& first, const DepthImage& first_depth,
                           const LineSegments& second, const DepthImage& second_depth,
                           const IndexPairs& matches, const Camera& camera, EndpointRule rule);

/// The same matches seen from the other side: first and second exchanged.
SpatialMatches exchanged(SpatialMatches matches);

}  // namespace evolin
