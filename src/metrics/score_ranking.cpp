// Curves and areas in one pass over the ranked predictions.
#include "evolin_ros/metrics/score_ranking.h"

#include <utility>

namespace evolin {

ScoreRanking::ScoreRanking(Protocol protocol, std::size_t settings, std::vector<Entry> entries,
                           std::vector<std::uint32_t> ground_truth)
    : protocol_(protocol),
      settings_(settings),
      entries_(std::move(entries)),
      ground_truth_(std::move(ground_truth)) {}

PrecisionRecallCurve ScoreRanking::curve(std::size_t setting) const {
  std::uint64_t lines = 0;
  for (const std::uint32_t count : ground_truth_) {
    lines += count;
  }
  PrecisionRecallCurve curve;
  curve.recall.reserve(entries_.size());
  curve.precision.reserve(entries_.size());
  std::uint64_t hits = 0;
  std::uint64_t predictions = 0;
  for (const Entry& entry : entries_) {
    hits += (entry.hits >> setting) & 1U;
    ++predictions;
    curve.recall.push_back(lines == 0 ? 0.0
                                      : static_cast<double>(hits) / static_cast<double>(lines));
    curve.precision.push_back(static_cast<double>(hits) / static_cast<double>(predictions));
  }
  return curve;
}

std::vector<std::optional<double>> ScoreRanking::averagePrecisions() const {
  std::uint64_t lines = 0;
  for (const std::uint32_t count : ground_truth_) {
    lines += count;
  }
  // Recall moves at true positives only, so they alone add area: with h true positives among n
  // predictions, from ((h-1)/lines, (h-1)/(n-1)) to (h/lines, h/n).
  std::vector<std::uint64_t> hits(settings_, 0);
  std::vector<double> areas(settings_, 0.0);
  std::uint64_t predictions = 0;
  for (const Entry& entry : entries_) {
    ++predictions;
    if (entry.hits == 0) {
      continue;
    }
    for (std::size_t setting = 0; setting < settings_; ++setting) {
      if (((entry.hits >> setting) & 1U) == 0) {
        continue;
      }
      const auto before = static_cast<double>(hits[setting]++);
      const double precision = (before + 1) / static_cast<double>(predictions);
      if (predictions > 1) {
        areas[setting] += (precision + before / static_cast<double>(predictions - 1)) / 2;
      } else if (protocol_ == Protocol::kPaper) {
        areas[setting] += precision;
      }
    }
  }
  std::vector<std::optional<double>> result(settings_);
  if (lines > 0 && predictions > 0) {
    for (std::size_t setting = 0; setting < settings_; ++setting) {
      result[setting] = areas[setting] / static_cast<double>(lines);
    }
  }
  return result;
}

}  // namespace evolin
