// Repeatability of a sequence whose pairs of frames are drawn again: what its bootstrap asks a
// thousand times.
#pragma once

#include <cstdint>
#include <vector>

#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/repeatability.h"

namespace evolin {

/// Immutable; holds each pair's own figures.
class ResampledRepeatability {
 public:
  ResampledRepeatability(const std::vector<PairRepeatability>& pairs, Protocol protocol);

  /// Of the sequence in which pair p occurs weights[p] times (at least one of them does). The sizes
  /// are equal.
  RepeatabilityFigures figures(const std::vector<std::uint32_t>& weights) const;

 private:
  struct Pair {
    double repeatability;
    double parts;  ///< that the error is a mean over: kEvolin: one, kPaper: redetections
    double error;  ///< summed over these parts
  };

  std::vector<Pair> pairs_;
};

}  // namespace evolin
