// Line segments with depth: out of one camera's image into space, and into another camera's image.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/pose.h"

namespace evolin {

/// Depth along the optical axis for every pixel, read where it lies: the image is shared, not
/// copied.
class DepthMap {
 public:
  /// `image` is CV_32FC1 in metres, or CV_16UC1 in metres x `factor` (read without the rounding
  /// that single precision brings). Throws Error for an empty image, another type, or a factor that
  /// is not positive and finite.
  explicit DepthMap(cv::Mat image, double factor = 5000);

  ImageSize size() const { return {image_.cols, image_.rows}; }

  /// Metres at column x and row y as the image has them (see isDepth()); 0 outside the image.
  double at(int x, int y) const {
    if (x < 0 || y < 0 || x >= image_.cols || y >= image_.rows) {
      return 0;
    }
    return in_units_ ? image_.at<std::uint16_t>(y, x) / factor_
                     : static_cast<double>(image_.at<float>(y, x));
  }

  /// The same for many pixels, in their order: scattered reads of a large image are slow one by one
  /// and overlap in a short loop.
  std::vector<double> at(const std::vector<cv::Point>& pixels) const;

  /// CV_32FC1, rounded once: NaN where nothing was measured.
  cv::Mat metres() const;

  /// False for what stands for "not measured": 0, NaN, infinite or negative numbers.
  static bool isDepth(double metres) { return metres > 0 && std::isfinite(metres); }

 private:
  cv::Mat image_;
  bool in_units_;
  double factor_;
};

/// A segment in space, in metres; as a camera sees it: x right, y down, z along the optical axis.
struct Segment3d {
  Eigen::Vector3d p1;
  Eigen::Vector3d p2;
};

/// The point that is seen at (x, y) pixels with `depth` metres along the optical axis. The camera
/// is a pinhole here and below: images are rectified, distortion is not looked at. fy may be
/// negative.
Eigen::Vector3d backProject(const Camera& camera, double x, double y, double depth);

/// The pixel nearest to (x, y), halves to the even one; (-1, -1) where that is outside the image or
/// a coordinate is NaN.
cv::Point nearestPixel(double x, double y, ImageSize size);

/// Metres along the optical axis at a segment's endpoints.
struct EndpointDepths {
  double first = 0;
  double second = 0;

  bool areKnown() const { return DepthMap::isDepth(first) && DepthMap::isDepth(second); }
};

/// The segment in space behind a segment of the image. With `from_pixel_centers` the rays go
/// through the centres of the pixels nearest to the endpoints (the published implementation), else
/// through the endpoints themselves.
Segment3d backProject(const Camera& camera, const LineSegment& segment, EndpointDepths depths,
                      bool from_pixel_centers);

/// Takes points of the camera at `first` to the camera at `second`; both poses are camera to world.
Eigen::Isometry3d motionBetween(const Pose& first, const Pose& second);

/// The image, in pixels, of `segment` after `motion`. With `only_in_front` none when an endpoint
/// does not lie in front of the camera; else (the published implementation) such a point is
/// mirrored through the centre, and one beside the camera may be infinite. Never NaN: none instead.
std::optional<LineSegment> project(const Camera& camera, const Segment3d& segment,
                                   const Eigen::Isometry3d& motion, bool only_in_front);

}  // namespace evolin
