// Relative pose as the published EVOLIN implementation estimates it, gates, kernels and damping
// included (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include "evolin_ros/pose/relative_pose.h"

namespace evolin {

/// The defaults are the published values; other ones are no longer comparable with its tables.
struct EvolinPoseOptions {
  bool normalised = false;  ///< image lines of unit norm (the article) instead of as long as the
                            ///< segment in pixels (the implementation)
  int rounds = 50;
  int steps = 30;              ///< of Levenberg and Marquardt a round, at most
  int trials = 10;             ///< of dampings a step, at most
  double huber_delta = 1;      ///< pixels x pixels, or pixels when normalised
  double first_gate = 20000;   ///< largest mean squared residual of round 0; in round i
                               ///< first_gate / (i + 1)^2
  std::size_t min_active = 6;  ///< with fewer active matches it ends, ill-conditioned
};

/// Throws ConfigError naming the option, its value and the accepted range.
void validate(const EvolinPoseOptions& options);

/// Points of the second frame are aligned with lines of the first, and the motion found is
/// inverted: so does the published implementation where it says first to second.
class EvolinPoseEstimator : public RelativePoseEstimator {
 public:
  /// Throws as validate().
  explicit EvolinPoseEstimator(const EvolinPoseOptions& options = {});

  RelativePose estimate(const SpatialMatches& matches, const Camera& camera) const override;

 private:
  EvolinPoseOptions options_;
};

}  // namespace evolin
