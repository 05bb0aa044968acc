// Which matches of two frames one motion of the camera explains.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/geometry/projection.h"
#include "evolin_ros/pose/relative_pose.h"

namespace evolin {

struct MatchVerificationOptions {
  double threshold = 3;         ///< largest root mean square distance of a line's two points from
                                ///< the line seen in the other image, pixels
  std::size_t min_inliers = 6;  ///< matches, with depth in both frames, that agree on the motion;
                                ///< at least 3
};

/// Throws ConfigError naming the option, its value and the accepted range.
void validate(const MatchVerificationOptions& options);

/// The lines of a frame, and where they are in space, metres in their camera's frame; none where
/// there is no depth. As many of both.
struct SpatialLines {
  const LineSegments& lines;
  const std::vector<std::optional<Segment3d>>& in_space;
};

struct MatchVerification {
  /// Places in the matches given, rising; empty when no motion was found.
  std::vector<std::size_t> kept;
  std::size_t without_depth = 0;  ///< matches of which neither line has depth
  /// Why there is no motion that enough matches agree on; kNone where there is one.
  PoseFailure failure = PoseFailure::kNone;

  bool found() const { return failure == PoseFailure::kNone; }
};

/// The motion comes from the matches with depth in both frames, by RobustPoseEstimator. Of all
/// matches those are kept for which the line of one of the two frames has depth and is seen, after
/// the motion, within the threshold of its partner; how far along the partner does not count.
/// Matches without depth in either frame are never kept. Both images are rectified and of one
/// camera. Throws Error for an index beyond the lines, and as validate().
MatchVerification verifyByPose(const SpatialLines& first, const SpatialLines& second,
                               const LineMatches& matches, const Camera& camera,
                               const MatchVerificationOptions& options);

}  // namespace evolin
