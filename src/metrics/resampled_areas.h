// Areas under the precision-recall curves of a resampled sequence: the inner loop of their
// bootstrap.
#pragma once

#include <cstddef>
#include <cstdint>

#include "evolin_ros/metrics/score_ranking.h"

namespace evolin {

/// Settings that are worked on at a time.
constexpr std::size_t kAreaSettings = 8;

/// A frame's weight, and the same number again.
struct FrameWeight {
  double weight;
  std::size_t copies;
};

/// Precision after h true positives and m others is 1 - m / (h + m), so that copies of a true
/// positive from the a-th to the b-th prediction add b - a - m (s(b) - s(a)) to the area times the
/// number of true lines, by the trapezoid rule with s(n) = sum over 1 <= i < n of
/// (1 / i + 1 / (i + 1)) / 2.
struct ResampledAreas {
  double losses[kAreaSettings];  ///< sum of m (s(b) - s(a))
  double misses[kAreaSettings];  ///< predictions that are no true positives
};

/// Setting k is bit `shift` + k of `hits`; `weights` by frame; `steps` holds s(n) up to the number
/// of weighted predictions, s(0) = 0. The same to the last bit whatever the processor.
void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas);

namespace generic {
void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas);
}
/// For processors with AVX2 alone, where there are such.
namespace wide {
void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas);
}

}  // namespace evolin
