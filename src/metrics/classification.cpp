// Ratios of counts.
#include "evolin_ros/metrics/classification.h"

namespace evolin {

namespace {

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double Classification::precision() const { return ratio(true_positives, predicted); }

double Classification::recall() const { return ratio(true_positives, ground_truth); }

double Classification::fScore() const {
  const double p = precision();
  const double r = recall();
  return p + r > 0 ? 2 * p * r / (p + r) : 0.0;
}

Classification weightedSum(const std::vector<Classification>& counts,
                           const std::vector<std::uint32_t>& weights) {
  Classification sum;
  for (std::size_t index = 0; index < counts.size(); ++index) {
    sum += counts[index] * weights[index];
  }
  return sum;
}

}  // namespace evolin
