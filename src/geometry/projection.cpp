// Pinhole geometry of segments with depth.
#include "evolin_ros/geometry/projection.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

DepthMap::DepthMap(cv::Mat image, double factor)
    : image_(std::move(image)), in_units_(image_.type() == CV_16UC1), factor_(factor) {
  if (image_.empty()) {
    throw Error("depth image: it is empty; expected a depth for every pixel");
  }
  if (image_.type() != CV_32FC1 && image_.type() != CV_16UC1) {
    throw Error("depth image: " + std::to_string(image_.channels()) + " channels of " +
                std::to_string(8 * image_.elemSize1()) +
                " bits; expected one channel of 32-bit floating-point metres or of 16-bit units");
  }
  if (!(factor > 0) || !std::isfinite(factor)) {
    throw Error("depth factor " + formatDouble(factor) +
                ": expected a positive number of stored units per metre");
  }
}

std::vector<double> DepthMap::at(const std::vector<cv::Point>& pixels) const {
  std::vector<double> metres(pixels.size());
  for (std::size_t index = 0; index < pixels.size(); ++index) {
    metres[index] = at(pixels[index].x, pixels[index].y);
  }
  return metres;
}

cv::Mat DepthMap::metres() const {
  cv::Mat metres(image_.size(), CV_32FC1);
  for (int y = 0; y < metres.rows; ++y) {
    auto* const row = metres.ptr<float>(y);
    for (int x = 0; x < metres.cols; ++x) {
      const double depth = at(x, y);
      row[x] = isDepth(depth) ? static_cast<float>(depth) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return metres;
}

Eigen::Vector3d backProject(const Camera& camera, double x, double y, double depth) {
  return {(x - camera.cx) * depth / camera.fx, (y - camera.cy) * depth / camera.fy, depth};
}

cv::Point nearestPixel(double x, double y, ImageSize size) {
  // Halves go to the even neighbour under the default rounding mode.
  const double column = std::nearbyint(x);
  const double row = std::nearbyint(y);
  // Compared as floating-point numbers: the cast is undefined far outside. NaN fails too.
  return column >= 0 && row >= 0 && column < size.width && row < size.height
             ? cv::Point(static_cast<int>(column), static_cast<int>(row))
             : cv::Point(-1, -1);
}

Segment3d backProject(const Camera& camera, const LineSegment& segment, EndpointDepths depths,
                      bool from_pixel_centers) {
  const auto at = [from_pixel_centers](double value) {
    return from_pixel_centers ? std::nearbyint(value) : value;
  };
  return {backProject(camera, at(segment.x1), at(segment.y1), depths.first),
          backProject(camera, at(segment.x2), at(segment.y2), depths.second)};
}

Eigen::Isometry3d motionBetween(const Pose& first, const Pose& second) {
  const Eigen::Matrix3d to_second = second.rotation.toRotationMatrix().transpose();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = to_second * first.rotation.toRotationMatrix();
  motion.translation() = to_second * (first.translation - second.translation);
  return motion;
}

std::optional<LineSegment> project(const Camera& camera, const Segment3d& segment,
                                   const Eigen::Isometry3d& motion, bool only_in_front) {
  const Eigen::Vector3d p1 = motion * segment.p1;
  const Eigen::Vector3d p2 = motion * segment.p2;
  if (only_in_front && !(p1.z() > 0 && p2.z() > 0)) {
    return std::nullopt;
  }
  LineSegment image;
  image.x1 = p1.x() * camera.fx / p1.z() + camera.cx;
  image.y1 = p1.y() * camera.fy / p1.z() + camera.cy;
  image.x2 = p2.x() * camera.fx / p2.z() + camera.cx;
  image.y2 = p2.y() * camera.fy / p2.z() + camera.cy;
  if (std::isnan(image.x1) || std::isnan(image.y1) || std::isnan(image.x2) ||
      std::isnan(image.y2)) {
    return std::nullopt;
  }
  return image;
}

}  // namespace evolin
