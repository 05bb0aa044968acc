// Areas from what the true positives lose to a precision of one.
#include "evolin_ros/metrics/resampled_precision.h"

#include <algorithm>
#include <array>
#include <limits>
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

ResampledPrecision::Size ResampledPrecision::sizeOf(
    const std::vector<std::uint32_t>& weights) const {
  if (weights.size() != ground_truth_.size()) {
    throw Error("average precision: " + std::to_string(weights.size()) + " weights for " +
                std::to_string(ground_truth_.size()) + " frames; expected one a frame");
  }
  Size size;
  for (std::size_t frame = 0; frame < weights.size(); ++frame) {
    size.lines += std::uint64_t{weights[frame]} * ground_truth_[frame];
    size.predictions += std::uint64_t{weights[frame]} * predicted_[frame];
  }
  if (size.predictions > std::numeric_limits<std::int32_t>::max()) {
    throw Error("average precision: " + std::to_string(size.predictions) +
                " weighted predictions; expected fewer than 2^31");
  }
  return size;
}

std::vector<std::optional<double>> ResampledPrecision::precisionsOf(
    const std::vector<std::uint32_t>& weights, const Size& size, const double* losses,
    const double* misses) const {
  std::vector<std::optional<double>> result(settings_);
  if (size.lines == 0 || size.predictions == 0) {
    return result;
  }
  const auto first =
      std::find_if(entries_.begin(), entries_.end(),
                   [&](const ScoreRanking::Entry& entry) { return weights[entry.frame] > 0; });
  for (std::size_t setting = 0; setting < settings_; ++setting) {
    const std::size_t place = setting * kAreaLanes;
    double area = static_cast<double>(size.predictions) - misses[place] - losses[place];
    // Without an anchor the curve's first point adds no area.
    if (protocol_ == Protocol::kEvolin && ((first->hits >> setting) & 1U) != 0) {
      area -= 1;
    }
    result[setting] = area / static_cast<double>(size.lines);
  }
  return result;
}

std::vector<std::vector<std::optional<double>>> ResampledPrecision::averagePrecisions(
    const std::vector<std::vector<std::uint32_t>>& resamples) {
  std::vector<std::uint32_t> frames;
  frames.reserve(entries_.size());
  std::vector<RankedRun> runs;
  for (const ScoreRanking::Entry& entry : entries_) {
    frames.push_back(entry.frame);
    if (runs.empty() || runs.back().hits != entry.hits) {
      runs.push_back({entry.hits, 0});
    }
    runs.back().end = static_cast<std::uint32_t>(frames.size());
  }
  const RankedRuns ranked{frames.data(), runs.data(), runs.size(), settings_};
  std::vector<std::int32_t> weights(ground_truth_.size() * kAreaLanes);
  std::vector<double> losses(settings_ * kAreaLanes);
  std::vector<double> misses(settings_ * kAreaLanes);
  std::array<Size, kAreaLanes> sizes;
  std::vector<std::vector<std::optional<double>>> result;
  result.reserve(resamples.size());
  for (std::size_t begin = 0; begin < resamples.size(); begin += kAreaLanes) {
    const std::size_t lanes = std::min(kAreaLanes, resamples.size() - begin);
    std::fill(weights.begin(), weights.end(), 0);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::vector<std::uint32_t>& resample = resamples[begin + lane];
      sizes[lane] = sizeOf(resample);
      extendSteps(sizes[lane].predictions);
      for (std::size_t frame = 0; frame < resample.size(); ++frame) {
        weights[frame * kAreaLanes + lane] = static_cast<std::int32_t>(resample[frame]);
      }
    }
    resampleAreas(ranked, weights.data(), steps_.data(), losses.data(), misses.data());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      result.push_back(precisionsOf(resamples[begin + lane], sizes[lane], losses.data() + lane,
                                    misses.data() + lane));
    }
  }
  return result;
}

}  // namespace evolin
