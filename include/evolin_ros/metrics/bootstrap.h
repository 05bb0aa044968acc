// Confidence intervals of sequence figures by resampling frames (Efron 1979; circular blocks:
// Politis and Romano 1992).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace evolin {

struct BootstrapOptions {
  int resamples = 1000;
  int block_length = 0;  ///< consecutive frames drawn together, as neighbours look alike; 0: the
                         ///< cube root of the number of frames, rounded up
  std::uint64_t seed = 1;
  double level = 0.95;  ///< of the two-sided percentile interval, between 0 and 1
};

struct ConfidenceInterval {
  double level = 0;
  double low = 0;  ///< NaN, as `high`, when the figure was undefined in every resample
  double high = 0;
};

/// Figures of the sequence in which frame f occurs weights[f] times, NaN where one is undefined;
/// always the same number of figures.
using WeightedFigures =
    std::function<std::vector<double>(const std::vector<std::uint32_t>& weights)>;

/// The same of many resamples at a time: a row of figures for each row of weights.
using FiguresOfResamples = std::function<std::vector<std::vector<double>>(
    const std::vector<std::vector<std::uint32_t>>& resamples)>;

/// One interval a figure. A resample is a row of blocks with uniform starts, wrapping around the
/// end of the sequence and cut to its length, so that all frames are equally likely; percentiles
/// are linear between neighbours; resamples that leave a figure undefined do not count for it. The
/// same options give the same intervals on every platform. Throws Error without frames, for fewer
/// than one resample, a block length below 0 or above `frames`, or a level outside (0, 1).
std::vector<ConfidenceInterval> blockBootstrap(std::size_t frames, const BootstrapOptions& options,
                                               const WeightedFigures& figures);

/// The same for figures that are found quicker for many resamples at a time.
std::vector<ConfidenceInterval> blockBootstrapOfMany(std::size_t frames,
                                                     const BootstrapOptions& options,
                                                     const FiguresOfResamples& figures);

}  // namespace evolin
