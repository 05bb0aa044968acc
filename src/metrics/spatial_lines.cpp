// Lifting detected lines into space and projecting them, by the rules of both protocols.
#include "evolin_ros/metrics/spatial_lines.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/geometry/clipping.h"
#include "scaling.h"

namespace evolin {

namespace {

/// The outermost pixel centres.
Rectangle imageRectangle(ImageSize size) { return {0, 0, size.width - 1.0, size.height - 1.0}; }

/// The published rule, which means lines of zero length and drops all that are parallel to an axis.
bool isParallelToAxis(const LineSegment& line) { return line.x1 == line.x2 || line.y1 == line.y2; }

bool isPoint(const LineSegment& line) { return line.x1 == line.x2 && line.y1 == line.y2; }

/// The projection as it counts; none when the protocol drops it.
std::optional<LineSegment> bringInside(const LineSegment& projection, ImageSize size,
                                       Protocol protocol) {
  if (protocol == Protocol::kEvolin) {
    if (isParallelToAxis(projection)) {
      return std::nullopt;
    }
    const LineSegment clamped = clampToRectangle(projection, imageRectangle(size));
    return isParallelToAxis(clamped) ? std::nullopt : std::optional<LineSegment>(clamped);
  }
  if (isPoint(projection)) {
    return std::nullopt;
  }
  const std::optional<LineSegment> clipped = clipToRectangle(projection, imageRectangle(size));
  return clipped && isPoint(*clipped) ? std::nullopt : clipped;
}

}  // namespace

SpatialFrame liftLines(Protocol protocol, const std::string& frame_name, const LineSegments& lines,
                       const DepthMap& depth, const Camera& camera, const Pose& pose) {
  if (camera.fx == 0 || camera.fy == 0) {
    throw Error("camera of frame " + frame_name + ": focal lengths " + formatDouble(camera.fx) +
                " and " + formatDouble(camera.fy) + "; expected numbers of pixels other than 0");
  }
  const bool evolin = protocol == Protocol::kEvolin;
  SpatialFrame frame{protocol, depth.size(), camera, pose, {}};
  const Rectangle image = imageRectangle(frame.size);
  frame.lines.reserve(lines.size());
  std::vector<cv::Point> pixels;  // of both endpoints of every line
  pixels.reserve(2 * lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    if (!line.isFinite()) {
      throw Error("detected lines of frame " + frame_name + ", row " + std::to_string(row) + ": " +
                  coordinates(line) + " is not finite");
    }
    SpatialLine inside{line, true, std::nullopt};
    if (evolin) {
      inside.segment = clampToRectangle(line, image);
    } else if (const std::optional<LineSegment> clipped = clipToRectangle(line, image)) {
      inside.segment = *clipped;
    } else {
      inside.in_image = false;
    }
    pixels.push_back(nearestPixel(inside.segment.x1, inside.segment.y1, frame.size));
    pixels.push_back(nearestPixel(inside.segment.x2, inside.segment.y2, frame.size));
    frame.lines.push_back(inside);
  }
  const std::vector<double> depths = depth.at(pixels);
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const EndpointDepths ends{depths[2 * row], depths[2 * row + 1]};
    SpatialLine& line = frame.lines[row];
    if (line.in_image && ends.areKnown()) {
      line.endpoints = backProject(camera, line.segment, ends, evolin);
    }
  }
  return frame;
}

std::vector<LineProjection> projectLines(const SpatialFrame& from, const SpatialFrame& to,
                                         double score_threshold) {
  if (from.protocol != to.protocol) {
    throw Error("cannot project lines between frames of different protocols (" +
                toString(from.protocol) + " and " + toString(to.protocol) + ")");
  }
  const Eigen::Isometry3d motion = motionBetween(from.pose, to.pose);
  std::vector<LineProjection> projections;
  projections.reserve(from.lines.size());
  for (std::size_t row = 0; row < from.lines.size(); ++row) {
    const std::optional<Segment3d>& endpoints = from.lines[row].endpoints;
    // Nothing is passed over where either is NaN.
    if (!endpoints || from.lines[row].segment.score <= score_threshold) {
      continue;
    }
    const std::optional<LineSegment> seen =
        project(to.camera, *endpoints, motion, from.protocol == Protocol::kPaper);
    if (!seen) {
      continue;
    }
    if (const std::optional<LineSegment> inside = bringInside(*seen, to.size, from.protocol)) {
      projections.push_back({*inside, static_cast<std::uint32_t>(row)});
    }
  }
  return projections;
}

}  // namespace evolin
