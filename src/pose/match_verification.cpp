// The robust motion of the matches with depth, then every match against it.
#include "evolin_ros/pose/match_verification.h"

#include <cmath>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/pose/robust_pose.h"
#include "line_residual.h"
#include "two_view_line.h"

namespace evolin {

namespace {

constexpr std::size_t kFewestInliers = 3;

LiftedLine seenLine(const LineSegment& line) {
  LiftedLine seen;
  seen.pixel1 = {line.x1, line.y1};
  seen.pixel2 = {line.x2, line.y2};
  return seen;
}

LiftedLine lifted(const LineSegment& line, const Segment3d& in_space) {
  LiftedLine result = seenLine(line);
  result.point1 = in_space.p1;
  result.point2 = in_space.p2;
  return result;
}

void requireLines(const SpatialLines& frame, const char* which) {
  if (frame.lines.size() != frame.in_space.size()) {
    throw Error(std::string("verification of matches: the ") + which + " frame has " +
                std::to_string(frame.lines.size()) + " lines and " +
                std::to_string(frame.in_space.size()) + " of them in space, expected as many");
  }
}

void requireIndex(std::size_t index, const SpatialLines& frame, const char* which) {
  if (index >= frame.lines.size()) {
    throw Error("verification of matches: a match names line " + std::to_string(index) +
                " of the " + which + " frame, expected one below " +
                std::to_string(frame.lines.size()));
  }
}

/// Whether `in_space` is seen on `partner` after `motion`; false for a line without length.
bool isSeenOn(const LineSegment& partner, const Segment3d& in_space, const Pose& motion,
              const Camera& camera, double threshold) {
  const PointsOnLine seen = {{in_space.p1, in_space.p2}, imageLine(seenLine(partner), true)};
  return squaredDistance(seen, motion.rotation.toRotationMatrix(), motion.translation, camera) <=
         threshold * threshold;
}

}  // namespace

void validate(const MatchVerificationOptions& options) {
  if (!(options.threshold > 0 && std::isfinite(options.threshold))) {
    throw ConfigError(
        "verification of matches", "threshold",
        formatDouble(options.threshold) + ", expected a finite number of pixels above 0");
  }
  if (options.min_inliers < kFewestInliers) {
    throw ConfigError("verification of matches", "min_inliers",
                      std::to_string(options.min_inliers) + ", expected at least " +
                          std::to_string(kFewestInliers));
  }
}

MatchVerification verifyByPose(const SpatialLines& first, const SpatialLines& second,
                               const LineMatches& matches, const Camera& camera,
                               const MatchVerificationOptions& options) {
  validate(options);
  requireLines(first, "first");
  requireLines(second, "second");
  MatchVerification result;
  SpatialMatches with_depth;
  for (std::size_t place = 0; place < matches.size(); ++place) {
    const LineMatch& match = matches[place];
    requireIndex(match.first, first, "first");
    requireIndex(match.second, second, "second");
    const std::optional<Segment3d>& there = first.in_space[match.first];
    const std::optional<Segment3d>& here = second.in_space[match.second];
    if (there && here) {
      with_depth.push_back({lifted(first.lines[match.first], *there),
                            lifted(second.lines[match.second], *here), place});
    }
    result.without_depth += !there && !here ? 1 : 0;
  }
  RobustPoseOptions robust;
  robust.threshold = options.threshold;
  const RelativePose pose = RobustPoseEstimator(robust).estimate(with_depth, camera);
  result.failure = pose.failure;
  if (pose.found() && pose.inliers.size() < options.min_inliers) {
    result.failure = PoseFailure::kNoConsensus;
  }
  if (!result.found()) {
    return result;
  }
  const Pose& forward = pose.first_to_second;
  const Pose backward = inverse(forward);
  for (std::size_t place = 0; place < matches.size(); ++place) {
    const LineMatch& match = matches[place];
    const std::optional<Segment3d>& there = first.in_space[match.first];
    const std::optional<Segment3d>& here = second.in_space[match.second];
    if ((there &&
         isSeenOn(second.lines[match.second], *there, forward, camera, options.threshold)) ||
        (here && isSeenOn(first.lines[match.first], *here, backward, camera, options.threshold))) {
      result.kept.push_back(place);
    }
  }
  return result;
}

}  // namespace evolin
