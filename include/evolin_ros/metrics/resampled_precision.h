// Average precision of a sequence whose frames are drawn again: what its bootstrap asks a thousand
// times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "evolin_ros/metrics/score_ranking.h"

namespace evolin {

/// Not safe for several threads.
class ResampledPrecision {
 public:
  explicit ResampledPrecision(const ScoreRanking& ranking);

  /// For each resample, which is a row of weights: ScoreRanking::averagePrecisions(), but for the
  /// last bits, of the sequence in which frame f occurs weights[f] times, copies of a prediction
  /// following each other. Many resamples at a time are quicker. Throws Error when the number of
  /// weights is not that of the frames, or for 2^31 weighted predictions.
  std::vector<std::vector<std::optional<double>>> averagePrecisions(
      const std::vector<std::vector<std::uint32_t>>& resamples);

 private:
  /// Of a resample.
  struct Size {
    std::uint64_t lines = 0;
    std::uint64_t predictions = 0;
  };

  Size sizeOf(const std::vector<std::uint32_t>& weights) const;
  /// From the sums of one resample's lane.
  std::vector<std::optional<double>> precisionsOf(const std::vector<std::uint32_t>& weights,
                                                  const Size& size, const double* losses,
                                                  const double* misses) const;
  void extendSteps(std::size_t predictions);

  Protocol protocol_;
  std::size_t settings_;
  std::vector<ScoreRanking::Entry> entries_;
  std::vector<std::uint32_t> ground_truth_;
  std::vector<std::uint32_t> predicted_;  ///< by frame
  std::vector<double> steps_;             ///< by predictions so far; see resampled_areas.h
};

}  // namespace evolin
