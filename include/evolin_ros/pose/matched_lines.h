// Matched lines as relative pose takes them: each with its pixels and its two points in space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

/// A segment with depth. Points in the frame of its camera, metres, z along the optical axis.
struct LiftedLine {
  Eigen::Vector2d pixel1 = Eigen::Vector2d::Zero();
  Eigen::Vector2d pixel2 = Eigen::Vector2d::Zero();
  Eigen::Vector3d point1 = Eigen::Vector3d::Zero();
  Eigen::Vector3d point2 = Eigen::Vector3d::Zero();
};

/// One a line, in its row; empty where an endpoint has no depth.
using LiftedLines = std::vector<std::optional<LiftedLine>>;

struct SpatialMatch {
  LiftedLine first;
  LiftedLine second;
  std::size_t match = 0;  ///< its place in the list of index pairs that it came from
};

using SpatialMatches = std::vector<SpatialMatch>;

/// How endpoints become points.
enum class EndpointRule {
  kTruncated,  ///< clamped to the image one coordinate at a time, then truncated to whole pixels
  kExact,      ///< the segment cut at the image's border; depth of the nearest pixel, exact point
};

/// Lifts all lines of a frame; under kExact segments wholly outside the image stay empty.
/// Intrinsics are used as they are (fy may be negative); distortion is not undone. The image is as
/// large as its depth image. Throws Error naming `frame_name` for a line that is not finite, and
/// for intrinsics that validateCamera() refuses (a focal length of zero).
LiftedLines liftEndpoints(const std::string& frame_name, const LineSegments& lines,
                          const DepthMap& depth, const Camera& camera, EndpointRule rule);

/// The matches whose lines both have depth, in their order. Throws Error for an index beyond the
/// lines.
SpatialMatches liftedMatches(const LiftedLines& first, const LiftedLines& second,
                             const IndexPairs& matches);

/// The same matches seen from the other side: first and second exchanged.
SpatialMatches exchanged(SpatialMatches matches);

}  // namespace evolin
