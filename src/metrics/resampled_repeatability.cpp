// Divisions pair by pair happen once, not with every resample.
#include "evolin_ros/metrics/resampled_repeatability.h"

namespace evolin {

ResampledRepeatability::ResampledRepeatability(const std::vector<PairRepeatability>& pairs,
                                               Protocol protocol) {
  pairs_.reserve(pairs.size());
  for (const PairRepeatability& pair : pairs) {
    if (protocol == Protocol::kEvolin) {
      pairs_.push_back({pair.repeatability(), 1, pair.localizationError(protocol)});
    } else {
      pairs_.push_back({pair.repeatability(),
                        static_cast<double>(pair.forward.count) + pair.backward.count,
                        pair.forward.distance_sum + pair.backward.distance_sum});
    }
  }
}

RepeatabilityFigures ResampledRepeatability::figures(
    const std::vector<std::uint32_t>& weights) const {
  double total = 0;
  double parts = 0;
  double repeatability = 0;
  double error = 0;
  for (std::size_t index = 0; index < pairs_.size(); ++index) {
    const Pair& pair = pairs_[index];
    const double weight = weights[index];
    total += weight;
    parts += weight * pair.parts;
    repeatability += weight * pair.repeatability;
    error += weight * pair.error;
  }
  return {repeatability / total, parts == 0 ? 0.0 : error / parts};
}

}  // namespace evolin
