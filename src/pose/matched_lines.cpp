// Lifting of segments by their depth.
#include "evolin_ros/pose/matched_lines.h"

#include <cmath>
#include <cstdint>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {

namespace {

std::optional<Eigen::Vector3d> pointAt(const Eigen::Vector2d& pixel, const DepthMap& depth,
                                       const Camera& camera) {
  const cv::Point nearest = nearestPixel(pixel.x(), pixel.y(), depth.size());
  const double metres = depth.at(nearest.x, nearest.y);
  return DepthMap::isDepth(metres)
             ? std::optional<Eigen::Vector3d>(backProject(camera, pixel.x(), pixel.y(), metres))
             : std::nullopt;
}

std::optional<LiftedLine> lift(const LineSegment& line, const DepthMap& depth, const Camera& camera,
                               EndpointRule rule) {
  const Rectangle image{0, 0, depth.size().width - 1.0, depth.size().height - 1.0};
  LiftedLine lifted;
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

const std::optional<LiftedLine>& lineAt(const LiftedLines& lines, std::int64_t index,
                                        std::size_t match, const std::string& which) {
  if (index < 0 || static_cast<std::size_t>(index) >= lines.size()) {
    throw Error("relative pose: match " + std::to_string(match) + " names line " +
                std::to_string(index) + " of the " + which + " frame, expected 0 to " +
                std::to_string(lines.size()) + " exclusive (its number of lines)");
  }
  return lines[static_cast<std::size_t>(index)];
}

}  // namespace

LiftedLines liftEndpoints(const std::string& frame_name, const LineSegments& lines,
                          const DepthMap& depth, const Camera& camera, EndpointRule rule) {
  Camera sized = camera;
  sized.width = depth.size().width;
  sized.height = depth.size().height;
  validateCamera(sized, "relative pose: camera " + camera.name);
  LiftedLines lifted;
  lifted.reserve(lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (!lines[row].isFinite()) {
      throw Error("relative pose: line " + std::to_string(row) + " of frame " + frame_name +
                  " is not finite, expected four numbers of pixels");
    }
    lifted.push_back(lift(lines[row], depth, camera, rule));
  }
  return lifted;
}

SpatialMatches liftedMatches(const LiftedLines& first, const LiftedLines& second,
                             const IndexPairs& matches) {
  SpatialMatches lifted;
  lifted.reserve(matches.size());
  for (std::size_t match = 0; match < matches.size(); ++match) {
    const std::optional<LiftedLine>& a = lineAt(first, matches[match].first, match, "first");
    const std::optional<LiftedLine>& b = lineAt(second, matches[match].second, match, "second");
    if (a && b) {
      lifted.push_back({*a, *b, match});
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
