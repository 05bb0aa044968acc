// Lifting of segments by their depth.
#include "evolin_ros/pose/matched_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {

namespace {

void requireDepth(const DepthImage& depth, const std::string& which) {
  if (depth.image.empty() || (depth.image.type() != CV_16UC1 && depth.image.type() != CV_32FC1)) {
    throw Error("relative pose: the depth image of the " + which + " frame is " +
                std::to_string(depth.image.cols) + " x " + std::to_string(depth.image.rows) +
                " of OpenCV type " + std::to_string(depth.image.type()) +
                ", expected pixels of type CV_16UC1 or CV_32FC1");
  }
  if (!(depth.factor > 0 && std::isfinite(depth.factor))) {
    throw Error("relative pose: the depth factor of the " + which + " frame is " +
                formatDouble(depth.factor) + ", expected a positive number of units per metre");
  }
}

/// Metres, or none.
std::optional<double> depthAt(const DepthImage& depth, int x, int y) {
  const double stored = depth.image.type() == CV_16UC1
                            ? static_cast<double>(depth.image.at<std::uint16_t>(y, x))
                            : static_cast<double>(depth.image.at<float>(y, x));
  const double metres = stored / depth.factor;
  return metres > 0 && std::isfinite(metres) ? std::optional<double>(metres) : std::nullopt;
}

Eigen::Vector3d backProject(const Camera& camera, const Eigen::Vector2d& pixel, double depth) {
  return {(pixel.x() - camera.cx) * depth / camera.fx, (pixel.y() - camera.cy) * depth / camera.fy,
          depth};
}

std::optional<Eigen::Vector3d> pointAt(const Eigen::Vector2d& pixel, const DepthImage& depth,
                                       const Camera& camera) {
  const std::optional<double> metres = depthAt(depth, static_cast<int>(std::nearbyint(pixel.x())),
                                               static_cast<int>(std::nearbyint(pixel.y())));
  return metres ? std::optional<Eigen::Vector3d>(backProject(camera, pixel, *metres))
                : std::nullopt;
}

std::optional<SpatialLine> lift(const LineSegment& line, const DepthImage& depth,
                                const Camera& camera, EndpointRule rule) {
  const Rectangle image{0, 0, static_cast<double>(depth.image.cols - 1),
                        static_cast<double>(depth.image.rows - 1)};
  SpatialLine lifted;
  if (rule == EndpointRule::kTruncated) {
    const LineSegment inside = clampToRectangle(line, image);
    lifted.pixel1 = {std::trunc(inside.x1), std::trunc(inside.y1)};
    lifted.pixel2 = {std::trunc(inside.x2), std::trunc(inside.y2)};
  } else {
    const std::optional<LineSegment> inside = clipToRectangle(line, image);
    if (!inside) {
      return std::nullopt;
    }
    lifted.pixel1 = {inside->x1, inside->y1};
    lifted.pixel2 = {inside->x2, inside->y2};
  }
  const std::optional<Eigen::Vector3d> point1 = pointAt(lifted.pixel1, depth, camera);
  const std::optional<Eigen::Vector3d> point2 = pointAt(lifted.pixel2, depth, camera);
  if (!point1 || !point2) {
    return std::nullopt;
  }
  lifted.point1 = *point1;
  lifted.point2 = *point2;
  return lifted;
}

const LineSegment& lineAt(const LineSegments& lines, std::int64_t index, std::size_t match,
                          const std::string& which) {
  if (index < 0 || static_cast<std::size_t>(index) >= lines.size()) {
    throw Error("relative pose: match " + std::to_string(match) + " names line " +
                std::to_string(index) + " of the " + which + " frame, expected 0 to " +
                std::to_string(lines.size()) + " exclusive (its number of lines)");
  }
  const LineSegment& line = lines[static_cast<std::size_t>(index)];
  if (!line.isFinite()) {
    throw Error("relative pose: line " + std::to_string(index) + " of the " + which +
                " frame is not finite, expected four numbers of pixels");
  }
  return line;
}

}  // namespace

SpatialMatches liftMatches(const LineSegments& first, const DepthImage& first_depth,
                           const LineSegments& second, const DepthImage& second_depth,
                           const IndexPairs& matches, const Camera& camera, EndpointRule rule) {
  requireDepth(first_depth, "first");
  requireDepth(second_depth, "second");
  if (first_depth.image.size() != second_depth.image.size()) {
    throw Error("relative pose: the depth images are " + std::to_string(first_depth.image.cols) +
                " x " + std::to_string(first_depth.image.rows) + " and " +
                std::to_string(second_depth.image.cols) + " x " +
                std::to_string(second_depth.image.rows) + ", expected one size");
  }
  Camera sized = camera;
  sized.width = first_depth.image.cols;
  sized.height = first_depth.image.rows;
  validateCamera(sized, "relative pose: camera " + camera.name);

  SpatialMatches lifted;
  lifted.reserve(matches.size());
  for (std::size_t match = 0; match < matches.size(); ++match) {
    const LineSegment& a = lineAt(first, matches[match].first, match, "first");
    const LineSegment& b = lineAt(second, matches[match].second, match, "second");
    const std::optional<SpatialLine> line_a = lift(a, first_depth, camera, rule);
    const std::optional<SpatialLine> line_b = lift(b, second_depth, camera, rule);
    if (line_a && line_b) {
      lifted.push_back({*line_a, *line_b, match});
    }
  }
  return lifted;
}

SpatialMatches exchanged(SpatialMatches matches) {
  for (SpatialMatch& match : matches) {
    std::swap(match.first, match.second);
  }
  return matches;
}

}  // namespace evolin
