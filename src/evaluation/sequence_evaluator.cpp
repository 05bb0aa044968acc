// Per-frame figures are those of an accumulator that holds just that frame.
#include "evolin_ros/evaluation/sequence_evaluator.h"

#include <algorithm>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

std::string sizeText(const LineSet& set) {
  return std::to_string(set.width) + "x" + std::to_string(set.height);
}

std::vector<DetectionEntry> entriesOf(const VectorizedMetrics& metrics) {
  const auto precisions = metrics.averagePrecisions();
  std::vector<DetectionEntry> entries;
  for (std::size_t i = 0; i < metrics.settings().size(); ++i) {
    entries.push_back({metrics.settings()[i], metrics.classification(i), precisions[i]});
  }
  return entries;
}

}  // namespace

SequenceEvaluator::SequenceEvaluator(EvaluationOptions options)
    : options_(std::move(options)), detection_(options_.vectorized), pose_(options_.pose_errors) {
  const HeatmapMetrics heatmap(options_.heatmap);
  heatmap_thresholds_ = heatmap.scoreThresholds();
  heatmap_ = heatmap.classifications();
}

FrameRecord SequenceEvaluator::addFrame(std::uint32_t number, const LineSet& lines,
                                        const LineSet& ground_truth) {
  const std::string name = formatStamp(lines.stamp);
  if (lines.width <= 0 || lines.height <= 0) {
    throw Error("lines of frame " + name + ": image size " + sizeText(lines) +
                ", expected the size of the image that they were detected in");
  }
  if (lines.width != ground_truth.width || lines.height != ground_truth.height) {
    throw Error("frame " + name + ": lines are of an image of " + sizeText(lines) +
                ", ground truth of one of " + sizeText(ground_truth));
  }
  VectorizedMetrics frame(options_.vectorized);
  frame.addFrame(number, name, {lines.width, lines.height}, lines.lines, ground_truth.lines,
                 lines.scored);
  try {
    detection_.merge(frame);
  } catch (const Error& error) {
    throw Error("frame " + name + ": " + error.what());
  }

  FrameRecord record;
  record.spatial_spread = spread_.addFrame(name, {lines.width, lines.height}, lines.lines);
  record.stamp = lines.stamp;
  record.state = FrameState::kEvaluated;
  record.lines = lines.lines.size();
  record.ground_truth = ground_truth.lines.size();
  record.processing_time = lines.processing_time;
  record.entries = entriesOf(frame);
  return record;
}

PairRecord SequenceEvaluator::addPair(const MatchSet& matches, const LineSegments& first,
                                      const LineSegments& second) {
  for (const LineMatch& match : matches.matches) {
    if (match.first >= first.size() || match.second >= second.size()) {
      throw Error("matches of " + formatStamp(matches.first_stamp) + " and " +
                  formatStamp(matches.stamp) + ": pair (" + std::to_string(match.first) + ", " +
                  std::to_string(match.second) + ") is beyond the " + std::to_string(first.size()) +
                  " and " + std::to_string(second.size()) + " lines of these frames");
    }
  }
  PairRecord record;
  record.first_stamp = matches.first_stamp;
  record.stamp = matches.stamp;
  record.processing_time = matches.processing_time;
  record.counts = association_.addPair(
      toIndexPairs(matches.matches),
      pairsOfEqualIds(first, second, formatStamp(matches.first_stamp), formatStamp(matches.stamp)));
  return record;
}

std::vector<DetectionEntry> SequenceEvaluator::detectionEntries() const {
  return entriesOf(detection_);
}

std::vector<std::int64_t> SequenceEvaluator::carriedIds(const LineSet& lines,
                                                        const LineSet& ground_truth) const {
  return carryOverIds(formatStamp(lines.stamp), {lines.width, lines.height}, lines.lines,
                      ground_truth.lines, options_.carry_over_gate);
}

DetectedPairRecord SequenceEvaluator::addDetectedPair(const MatchSet& matches,
                                                      const std::vector<std::int64_t>& first_ids,
                                                      const std::vector<std::int64_t>& second_ids) {
  DetectedPairRecord record;
  record.first_stamp = matches.first_stamp;
  record.stamp = matches.stamp;
  try {
    record.counts =
        detected_association_.addPair(toIndexPairs(matches.matches), first_ids, second_ids);
  } catch (const Error& error) {
    throw Error("matches of " + formatStamp(matches.first_stamp) + " and " +
                formatStamp(matches.stamp) + ": " + error.what());
  }
  return record;
}

void SequenceEvaluator::addHeatmap(const HeatmapRecord& record) {
  if (!record.scored.value_or(false)) {
    // Without lines every threshold's counts are those of all lines.
    unscored_heatmap_.counts += record.counts.at(0);
    ++(record.scored ? unscored_heatmap_.frames : unscored_heatmap_.empty_frames);
  }
  if (record.scored == false) {
    return;
  }
  for (std::size_t i = 0; i < heatmap_.size(); ++i) {
    heatmap_[i] += record.counts.at(i);
  }
  ++heatmap_frames_;
}

}  // namespace evolin
