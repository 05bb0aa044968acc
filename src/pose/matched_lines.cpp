// Lifting of segments by their depth.
#include "evolin_ros/pose/matched_lines.h"

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {

namespace {

/// The line's ends in the image; none where nothing of it is inside.
std::optional<LiftedLine> endsOf(const LineSegment& line, ImageSize size, EndpointRule rule) {
  const Rectangle image{0, 0, size.width - 1.0, size.height - 1.0};
  LiftedLine ends;
  if (rule == EndpointRule::kTruncated) {
    const LineSegment inside = clampToRectangle(line, image);
    ends.pixel1 = {std::trunc(inside.x1), std::trunc(inside.y1)};
    ends.pixel2 = {std::trunc(inside.x2), std::trunc(inside.y2)};
    return ends;
  }
  const std::optional<LineSegment> inside = clipToRectangle(line, image);
  if (!inside) {
    return std::nullopt;
  }
  ends.pixel1 = {inside->x1, inside->y1};
  ends.pixel2 = {inside->x2, inside->y2};
  return ends;
}

cv::Point depthPixel(const Eigen::Vector2d& pixel, ImageSize size) {
  return nearestPixel(pixel.x(), pixel.y(), size);
}

const std::optional<LiftedLine>& lineAt(const LiftedLines& lines, std::int64_t index,
                                        std::size_t match, const char* which) {
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
  std::vector<cv::Point>
      pixels;  // of both ends of every line, so that their depths are read at once
  pixels.reserve(2 * lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    if (!lines[row].isFinite()) {
      throw Error("relative pose: line " + std::to_string(row) + " of frame " + frame_name +
                  " is not finite, expected four numbers of pixels");
    }
    lifted.push_back(endsOf(lines[row], depth.size(), rule));
    const LiftedLine ends = lifted.back().value_or(LiftedLine());
    pixels.push_back(depthPixel(ends.pixel1, depth.size()));
    pixels.push_back(depthPixel(ends.pixel2, depth.size()));
  }
  const std::vector<double> depths = depth.at(pixels);
  for (std::size_t row = 0; row < lines.size(); ++row) {
    std::optional<LiftedLine>& line = lifted[row];
    const double depth1 = depths[2 * row];
    const double depth2 = depths[2 * row + 1];
    if (!line || !DepthMap::isDepth(depth1) || !DepthMap::isDepth(depth2)) {
      line.reset();
      continue;
    }
    line->point1 = backProject(camera, line->pixel1.x(), line->pixel1.y(), depth1);
    line->point2 = backProject(camera, line->pixel2.x(), line->pixel2.y(), depth2);
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
