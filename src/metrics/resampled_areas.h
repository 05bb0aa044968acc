// Areas under the precision-recall curves of resampled sequences: the inner loop of their
// bootstrap.
#pragma once

#include <cstddef>
#include <cstdint>

namespace evolin {

/// Resamples that are worked on side by side.
constexpr std::size_t kAreaLanes = 64;

/// Neighbours in the ranking that are true positives under the same settings: bit k of `hits` for
/// setting k.
struct RankedRun {
  std::uint32_t hits;
  std::uint32_t end;  ///< of its predictions, behind the last
};

struct RankedRuns {
  const std::uint32_t* frames;  ///< by prediction, by falling score
  const RankedRun* runs;
  std::size_t count;
  std::size_t settings;
};

/// Precision after h true positives and m others is 1 - m / (h + m), so that copies of true
/// positives from the a-th to the b-th prediction add b - a - m (s(b) - s(a)) to the area times the
/// number of true lines, by the trapezoid rule with s(n) = sum over 1 <= i < n of
/// (1 / i + 1 / (i + 1)) / 2.
///
/// `weights` of the resamples, frame by frame; `steps` holds s(n) up to the number of weighted
/// predictions, s(0) = 0. Sums m (s(b) - s(a)) into `losses`, and predictions that are no true
/// positives into `misses`: the resamples setting by setting. The same to the last bit whatever the
/// processor.
void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses);

namespace generic {
void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses);
}
/// For processors with AVX2 alone, where there are such.
namespace wide {
void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses);
}
/// For processors with AVX-512 (F, DQ, BW, VL) alone, where there are such.
namespace widest {
void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses);
}

}  // namespace evolin
