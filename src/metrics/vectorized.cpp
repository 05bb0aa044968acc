// Sums over frames, with one bit a setting for every prediction.
#include "evolin_ros/metrics/vectorized.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "detection_matching.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "score_order.h"

namespace evolin {

namespace {

constexpr double kNoFilter = -std::numeric_limits<double>::infinity();

}  // namespace

VectorizedMetrics::VectorizedMetrics(VectorizedOptions options) : options_(std::move(options)) {
  for (const double threshold : options_.distance_thresholds) {
    if (!(threshold > 0) || !std::isfinite(threshold)) {
      throw Error("distance threshold " + formatDouble(threshold) +
                  ": expected a positive, finite number of pixels");
    }
  }
  for (const LineDistance distance : options_.distances) {
    for (const double threshold : options_.distance_thresholds) {
      settings_.push_back({distance, threshold});
    }
  }
  if (settings_.empty() || settings_.size() > kMaxSettings) {
    throw Error(std::to_string(options_.distances.size()) + " distances with " +
                std::to_string(options_.distance_thresholds.size()) +
                " thresholds: expected 1 to " + std::to_string(kMaxSettings) + " combinations");
  }
}

std::vector<VectorizedMetrics::FrameCount>::const_iterator VectorizedMetrics::findFrame(
    std::uint32_t number) const {
  return std::lower_bound(
      frames_.begin(), frames_.end(), number,
      [](const FrameCount& frame, std::uint32_t value) { return frame.number < value; });
}

void VectorizedMetrics::addFrame(std::uint32_t frame_number, const std::string& frame_name,
                                 ImageSize size, const LineSegments& predicted,
                                 const LineSegments& ground_truth, bool scored) {
  checkSize(frame_name, size);
  if (!predicted.empty() && scored_ && *scored_ != scored) {
    throw Error(
        "predicted lines of frame " + frame_name + (scored ? " have" : " lack") +
        " scores, unlike those of earlier frames; expected scores in all frames or in none");
  }
  const auto place = findFrame(frame_number);
  if (place != frames_.end() && place->number == frame_number) {
    throw Error("frame " + frame_name + ": its number " + std::to_string(frame_number) +
                " is taken; expected every frame once");
  }
  const LineSegments truth = prepareGroundTruth(frame_name, size, ground_truth);
  const LineSegments lines =
      preparePredictions(frame_name, size, predicted, scored, options_.protocol).lines;
  const std::vector<std::uint32_t> hits = findHits(lines, truth, scored, options_);

  std::vector<Prediction> added;
  added.reserve(lines.size());
  for (std::size_t index = 0; index < lines.size(); ++index) {
    added.push_back({scored ? lines[index].score : kNoScore, frame_number, hits[index]});
  }
  predictions_.insert(predictions_.end(), added.begin(), added.end());
  frames_.insert(place, {frame_number, static_cast<std::uint32_t>(truth.size())});
  dropped_ += predicted.size() - lines.size();
  if (!predicted.empty()) {
    scored_ = scored;
  }
}

void VectorizedMetrics::makeRoom(std::uint32_t number) {
  for (FrameCount& frame : frames_) {
    frame.number += frame.number >= number ? 1 : 0;
  }
  for (Prediction& prediction : predictions_) {
    prediction.frame += prediction.frame >= number ? 1 : 0;
  }
}

void VectorizedMetrics::checkFilter(double score_threshold) const {
  if (scored_.has_value() && !*scored_ && score_threshold != kNoFilter) {
    throw Error("score threshold " + formatDouble(score_threshold) +
                ": the predicted lines have no scores to filter by");
  }
}

Classification VectorizedMetrics::classification(std::size_t setting,
                                                 double score_threshold) const {
  checkFilter(score_threshold);
  Classification counts;
  for (const Prediction& prediction : predictions_) {
    if (score_threshold == kNoFilter || prediction.score > score_threshold) {
      ++counts.predicted;
      counts.true_positives += (prediction.hits >> setting) & 1U;
    }
  }
  for (const FrameCount& frame : frames_) {
    counts.ground_truth += frame.ground_truth;
  }
  return counts;
}

std::vector<Classification> VectorizedMetrics::frameClassifications(std::size_t setting,
                                                                    double score_threshold) const {
  checkFilter(score_threshold);
  std::vector<Classification> counts(frames_.size());
  for (std::size_t index = 0; index < frames_.size(); ++index) {
    counts[index].ground_truth = frames_[index].ground_truth;
  }
  std::size_t index = 0;
  for (const Prediction& prediction : predictions_) {
    if (frames_[index].number != prediction.frame) {
      index = static_cast<std::size_t>(findFrame(prediction.frame) - frames_.begin());
    }
    if (score_threshold == kNoFilter || prediction.score > score_threshold) {
      ++counts[index].predicted;
      counts[index].true_positives += (prediction.hits >> setting) & 1U;
    }
  }
  return counts;
}

std::optional<double> VectorizedMetrics::averagePrecision(std::size_t setting) const {
  return averagePrecisions().at(setting);
}

std::vector<std::optional<double>> VectorizedMetrics::averagePrecisions() const {
  return ranking().averagePrecisions();
}

PrecisionRecallCurve VectorizedMetrics::curve(std::size_t setting) const {
  return ranking().curve(setting);
}

ScoreRanking VectorizedMetrics::ranking() const {
  std::vector<std::uint32_t> ground_truth;
  ground_truth.reserve(frames_.size());
  for (const FrameCount& frame : frames_) {
    ground_truth.push_back(frame.ground_truth);
  }
  std::vector<ScoreRanking::Entry> entries;
  if (scored()) {
    std::vector<Prediction> by_frame;
    const std::vector<Prediction>* ordered = &predictions_;
    const auto is_earlier = [](const Prediction& a, const Prediction& b) {
      return a.frame < b.frame;
    };
    if (!std::is_sorted(predictions_.begin(), predictions_.end(), is_earlier)) {
      by_frame = predictions_;
      std::stable_sort(by_frame.begin(), by_frame.end(), is_earlier);
      ordered = &by_frame;
    }
    std::vector<double> scores;
    scores.reserve(ordered->size());
    for (const Prediction& prediction : *ordered) {
      scores.push_back(prediction.score);
    }
    entries.reserve(ordered->size());
    // Frames are mostly numbered without gaps: then the number less the first is the index.
    const bool dense = frames_.back().number - frames_.front().number == frames_.size() - 1;
    // Equal scores stay by frame, and a frame's predictions in their order.
    for (const std::uint32_t place : placesByFallingScore(scores)) {
      const Prediction& prediction = (*ordered)[place];
      const auto index =
          dense ? prediction.frame - frames_.front().number
                : static_cast<std::uint32_t>(findFrame(prediction.frame) - frames_.begin());
      entries.push_back({index, prediction.hits});
    }
  }
  return {options_.protocol, settings_.size(), std::move(entries), std::move(ground_truth)};
}

void VectorizedMetrics::merge(const VectorizedMetrics& other) {
  if (options_.protocol != other.options_.protocol ||
      options_.distances != other.options_.distances ||
      options_.distance_thresholds != other.options_.distance_thresholds) {
    throw Error("cannot merge detection metrics: protocols, distances or thresholds differ");
  }
  if (scored_ && other.scored_ && *scored_ != *other.scored_) {
    throw Error("cannot merge detection metrics: one has scores and the other has none");
  }
  if (!frames_.empty() && !other.frames_.empty() &&
      frames_.back().number < other.frames_.front().number) {
    // The way of a live stream: its cost must not grow with the frames already there.
    std::copy(other.frames_.begin(), other.frames_.end(), std::back_inserter(frames_));
  } else {
    mergeFrames(other.frames_);
  }
  predictions_.insert(predictions_.end(), other.predictions_.begin(), other.predictions_.end());
  if (other.scored_) {
    scored_ = other.scored_;
  }
  dropped_ += other.dropped_;
}

void VectorizedMetrics::mergeFrames(const std::vector<FrameCount>& others) {
  std::vector<FrameCount> frames;
  frames.reserve(frames_.size() + others.size());
  std::merge(frames_.begin(), frames_.end(), others.begin(), others.end(),
             std::back_inserter(frames),
             [](const FrameCount& a, const FrameCount& b) { return a.number < b.number; });
  const auto twice = std::adjacent_find(
      frames.begin(), frames.end(),
      [](const FrameCount& a, const FrameCount& b) { return a.number == b.number; });
  if (twice != frames.end()) {
    throw Error("cannot merge detection metrics: frame number " + std::to_string(twice->number) +
                " occurs in both");
  }
  frames_ = std::move(frames);
}

void VectorizedMetrics::reset() { *this = VectorizedMetrics(options_); }

}  // namespace evolin
