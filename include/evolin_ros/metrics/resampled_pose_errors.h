// Median pose errors of a sequence whose pairs of frames are drawn again: what its bootstrap asks a
// thousand times.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "evolin_ros/metrics/pose_error.h"

namespace evolin {

/// Immutable; sorts the errors once.
class ResampledPoseErrors {
 public:
  explicit ResampledPoseErrors(const std::vector<PosePair>& pairs);

  /// PoseErrorMetrics::medians() with pair p occurring weights[p] times; NaN when none occurs.
  /// Throws Error when the number of weights is not that of the pairs.
  PoseErrors medians(const std::vector<std::uint32_t>& weights) const;

 private:
  /// By rising error: the error, infinite where no pose was found, and its pair.
  using Sorted = std::vector<std::pair<double, std::uint32_t>>;

  Sorted rotation_;
  Sorted translation_angle_;
  Sorted translation_;
};

}  // namespace evolin
