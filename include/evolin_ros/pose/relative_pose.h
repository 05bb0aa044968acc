// Motion of the camera between two frames from their matched lines: the interface and its answer.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/geometry/camera.h"
#include "evolin_ros/geometry/pose.h"
#include "evolin_ros/pose/matched_lines.h"

namespace evolin {

enum class PoseStrategy {
  kEvolin,  ///< what the published implementation does
  kRobust,  ///< consensus over minimal samples, then refinement
};

/// "evolin" or "robust".
std::string toString(PoseStrategy strategy);

/// Throws Error naming the value and the accepted ones.
PoseStrategy parsePoseStrategy(const std::string& text);

enum class PoseFailure {
  kNone,
  kTooFewMatches,  ///< fewer than three matches with depth
  kDegenerate,     ///< the lines leave a direction of motion open
  kNoConsensus,    ///< too few matches agree on any motion
  kNotFinite,      ///< the numbers ran away
};

/// "none", "too few matches", ...
std::string toString(PoseFailure failure);

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct RelativePose {
  PoseFailure failure = PoseFailure::kNone;
  std::string reason;    ///< a sentence where failure is not kNone
  Pose first_to_second;  ///< maps points of the first camera to the second; the identity on failure
  std::vector<std::size_t> inliers;  ///< places in the matches given, rising
  /// Of d = (rotation in radians, translation in metres) in exp(d) * first_to_second, from the
  /// residuals of the inliers; NaN where they do not determine it.
  Matrix6d covariance = Matrix6d::Constant(std::numeric_limits<double>::quiet_NaN());
  int iterations = 0;            ///< linear systems solved, trials and samples included
  bool ill_conditioned = false;  ///< found, but it hangs on so few lines that it may well be wrong

  bool found() const { return failure == PoseFailure::kNone; }
};

/// A way of estimating. Implementations keep no state between calls and may be used from several
/// threads at once; the same input always gives the same answer.
class RelativePoseEstimator {
 public:
  virtual ~RelativePoseEstimator() = default;

  /// Intrinsics are used as they are (fy may be negative), distortion is not. Never throws for what
  /// the matches are; a motion that cannot be had is an answer with its failure.
  virtual RelativePose estimate(const SpatialMatches& matches, const Camera& camera) const = 0;
};

}  // namespace evolin
