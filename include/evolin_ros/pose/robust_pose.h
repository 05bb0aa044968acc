// Relative pose that survives wrong matches: consensus over samples of two lines, then refinement.
#pragma once

#include <cstdint>

#include "evolin_ros/pose/relative_pose.h"

namespace evolin {

struct RobustPoseOptions {
  double threshold = 3;           ///< largest root mean square distance of a line's two points from
                                  ///< the line seen, pixels
  double loss_scale = 2;          ///< of the Cauchy loss in the refinement, pixels
  double confidence = 0.999;      ///< of having drawn a sample without a wrong match, in (0, 1)
  int min_samples = 100;          ///< drawn at least
  int max_samples = 1000;         ///< drawn at most
  double min_inlier_ratio = 0.2;  ///< of all matches, below which there is no consensus, in [0, 1]
  double min_angle = 5;           ///< between the two lines of a sample, degrees, in (0, 90)
  int refinement_steps = 20;      ///< of the final least squares, at most
  std::uint64_t seed = 1;         ///< of the sampling
};

/// Throws ConfigError naming the option, its value and the accepted range.
void validate(const RobustPoseOptions& options);

/// Both frames' depth is used: points of either frame are compared with the lines of the other, so
/// that the answers of the two directions are each other's inverse but for the sampling. A set
/// whose lines leave a motion open -- parallel ones, ones through a single point, ones in a plane
/// through the camera -- is refused. A motion that hangs on a single line, or on fewer than six, is
/// marked ill-conditioned.
class RobustPoseEstimator : public RelativePoseEstimator {
 public:
  /// Throws as validate().
  explicit RobustPoseEstimator(const RobustPoseOptions& options = {});

  RelativePose estimate(const SpatialMatches& matches, const Camera& camera) const override;

 private:
  RobustPoseOptions options_;
};

}  // namespace evolin
