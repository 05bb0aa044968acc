// Pinhole geometry of segments with depth.
#include "evolin_ros/geometry/projection.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

DepthMap::DepthMap(cv::Mat image, double factor) : image_(std::move(image)), factor_(factor) {
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

std::optional<double> DepthMap::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= image_.cols || y >= image_.rows) {
    return std::nullopt;
  }
  const double metres = image_.type() == CV_16UC1 ? image_.at<std::uint16_t>(y, x) / factor_
                                                  : static_cast<double>(image_.at<float>(y, x));
  return metres > 0 && std::isfinite(metres) ? std::optional<double>(metres) : std::nullopt;
}

Eigen::Vector3d backProject(const Camera& camera, double x, double y, double depth) {
  return {(x - camera.cx) * depth / camera.fx, (y - camera.cy) * depth / camera.fy, depth};
}

std::optional<Segment3d> backProject(const Camera& camera, const LineSegment& segment,
                                     const DepthMap& depth, bool from_pixel_centers) {
  const auto endpoint = [&](double x, double y) -> std::optional<Eigen::Vector3d> {
    // Halves go to the even neighbour under the default rounding mode.
    const double column = std::nearbyint(x);
    const double row = std::nearbyint(y);
    const ImageSize size = depth.size();
    // Compared as floating-point numbers: the cast is undefined far outside. NaN fails too.
    if (!(column >= 0 && row >= 0 && column < size.width && row < size.height)) {
      return std::nullopt;
    }
    const std::optional<double> metres = depth.at(static_cast<int>(column), static_cast<int>(row));
    if (!metres) {
      return std::nullopt;
    }
    return from_pixel_centers ? backProject(camera, column, row, *metres)
                              : backProject(camera, x, y, *metres);
  };
  const std::optional<Eigen::Vector3d> p1 = endpoint(segment.x1, segment.y1);
  const std::optional<Eigen::Vector3d> p2 = endpoint(segment.x2, segment.y2);
  if (!p1 || !p2) {
    return std::nullopt;
  }
  return Segment3d{*p1, *p2};
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
