// Counts of a classification and the precision, recall and F-score that they give.
#pragma once

#include <cstdint>
#include <vector>

namespace evolin {

/// Sums over any number of frames or pairs. Ratios lie in [0, 1] and are 0 where they are
/// undefined.
struct Classification {
  std::uint64_t true_positives = 0;
  std::uint64_t predicted = 0;     ///< true and false positives
  std::uint64_t ground_truth = 0;  ///< true positives and misses

  double precision() const;
  double recall() const;
  double fScore() const;

  Classification& operator+=(const Classification& other) {
    true_positives += other.true_positives;
    predicted += other.predicted;
    ground_truth += other.ground_truth;
    return *this;
  }
};

/// The counts of `times` copies.
inline Classification operator*(const Classification& counts, std::uint64_t times) {
  return {counts.true_positives * times, counts.predicted * times, counts.ground_truth * times};
}

/// Each of `counts` as often as its weight says; as many weights as counts.
Classification weightedSum(const std::vector<Classification>& counts,
                           const std::vector<std::uint32_t>& weights);

}  // namespace evolin
