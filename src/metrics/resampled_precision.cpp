// Areas from what the true positives lose to a precision of one.
#include "evolin_ros/metrics/resampled_precision.h"

#include <algorithm>
#include <string>

#include "evolin_ros/base/error.h"
#include "resampled_areas.h"

namespace evolin {

ResampledPrecision::ResampledPrecision(const ScoreRanking& ranking)
    : protocol_(ranking.protocol()),
      settings_(ranking.settings()),
      entries_(ranking.entries()),
      ground_truth_(ranking.groundTruth()),
      predicted_(ground_truth_.size(), 0),
      steps_{0, 0} {
  for (const ScoreRanking::Entry& entry : entries_) {
    ++predicted_[entry.frame];
  }
}

void ResampledPrecision::extendSteps(std::size_t predictions) {
  for (std::size_t n = steps_.size(); n <= predictions; ++n) {
    const auto last = static_cast<double>(n);
    steps_.push_back(steps_.back() + (1 / (last - 1) + 1 / last) / 2);
  }
}

std::vector<std::optional<double>> ResampledPrecision::averagePrecisions(
    const std::vector<std::uint32_t>& weights) {
  if (weights.size() != ground_truth_.size()) {
    throw Error("average precision: " + std::to_string(weights.size()) + " weights for " +
                std::to_string(ground_truth_.size()) + " frames; expected one a frame");
  }
  std::uint64_t lines = 0;
  std::uint64_t predictions = 0;
  std::vector<FrameWeight> of_frames;
  of_frames.reserve(weights.size());
  for (std::size_t frame = 0; frame < weights.size(); ++frame) {
    const std::uint32_t weight = weights[frame];
    lines += std::uint64_t{weight} * ground_truth_[frame];
    predictions += std::uint64_t{weight} * predicted_[frame];
    of_frames.push_back({static_cast<double>(weight), weight});
  }
  std::vector<std::optional<double>> result(settings_);
  if (lines == 0 || predictions == 0) {
    return result;
  }
  extendSteps(predictions);
  const auto first =
      std::find_if(entries_.begin(), entries_.end(),
                   [&](const ScoreRanking::Entry& entry) { return weights[entry.frame] > 0; });
  for (std::size_t begin = 0; begin < settings_; begin += kAreaSettings) {
    ResampledAreas areas;
    resampleAreas(entries_.data(), entries_.size(), static_cast<unsigned>(begin), of_frames.data(),
                  steps_.data(), &areas);
    const std::size_t end = std::min(begin + kAreaSettings, settings_);
    for (std::size_t setting = begin; setting < end; ++setting) {
      const std::size_t lane = setting - begin;
      double area = static_cast<double>(predictions) - areas.misses[lane] - areas.losses[lane];
      // Without an anchor the curve's first point adds no area.
      if (protocol_ == Protocol::kEvolin && ((first->hits >> setting) & 1U) != 0) {
        area -= 1;
      }
      result[setting] = area / static_cast<double>(lines);
    }
  }
  return result;
}

}  // namespace evolin
