// Matches between the lines of two frames: scored once both frames are there, or counted.
#include <algorithm>
#include <iterator>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

EvaluationUpdate PassEvaluation::takeMatches(MatchSet matches) {
  EvaluationUpdate update;
  matches.processing_time = measuredTime(matches.processing_time);
  if (matches.processing_time > 0) {
    associator_times_.push_back(matches.processing_time);
  }
  matches_source_ = matches.source;
  matches_lines_source_ = matches.lines_source;
  newest_matches_ = std::max(matches.stamp, newest_matches_.value_or(matches.stamp));
  if (const std::string why = whyUnusable(matches); !why.empty()) {
    ++pair_counts_.skipped;
    note("matches of " + formatStamp(matches.first_stamp) + " and " + formatStamp(matches.stamp) +
             ": " + why,
         &update);
    return update;
  }
  if (wants(MetricFamily::kTracks)) {
    times_.measure(Stage::kTracks, [&] { keepForTracks(matches); });
  }
  take(times_.measure(Stage::kPose, [&] { return motion_.addMatches(matches); }), &update);
  if (evaluatePair(matches, &update)) {
    return update;
  }
  pending_pairs_.emplace(PairKey(matches.first_stamp, matches.stamp), std::move(matches));
  if (pending_pairs_.size() > options_.buffer) {
    const MatchSet& oldest = pending_pairs_.begin()->second;
    ++(betweenDetectedLines(oldest) ? pair_counts_.detected_lines : pair_counts_.no_ground_truth);
    pending_pairs_.erase(pending_pairs_.begin());
  }
  return update;
}

/// "" for matches that may be scored once all their parts are there.
std::string PassEvaluation::whyUnusable(const MatchSet& matches) const {
  if (matches.first_stamp >= matches.stamp) {
    return "the first image must be the earlier one";
  }
  const bool known = matches.lines_source == lines_source_ ||
                     matches.lines_source == ground_truth_source_ || lines_source_.empty() ||
                     ground_truth_source_.empty();
  return known ? ""
               : "they are between lines of " + quote(matches.lines_source) +
                     "; expected those of the detector, " + quote(lines_source_) +
                     ", or of the ground truth, " + quote(ground_truth_source_);
}

void PassEvaluation::evaluatePairsOf(Stamp stamp, EvaluationUpdate* update) {
  for (auto pair = pending_pairs_.begin(); pair != pending_pairs_.end();) {
    const bool concerned = pair->first.first == stamp || pair->first.second == stamp;
    const bool settled = concerned && evaluatePair(pair->second, update);
    pair = settled ? pending_pairs_.erase(pair) : std::next(pair);
  }
}

bool PassEvaluation::evaluatePair(const MatchSet& matches, EvaluationUpdate* update) {
  if (ground_truth_source_.empty()) {
    return false;
  }
  if (matches.lines_source != ground_truth_source_) {
    ++pair_counts_.detected_lines;
    if (!evaluateDetectedPair(matches, update)) {
      pending_detected_pairs_.emplace(PairKey(matches.first_stamp, matches.stamp), matches);
      if (pending_detected_pairs_.size() > options_.buffer) {
        ++detected_pair_counts_.no_ground_truth;
        pending_detected_pairs_.erase(pending_detected_pairs_.begin());
      }
    }
    return true;
  }
  const auto first = entries_.find(matches.first_stamp);
  const auto second = entries_.find(matches.stamp);
  if (first == entries_.end() || second == entries_.end() || !first->second.ground_truth ||
      !second->second.ground_truth) {
    return false;
  }
  if (!hasIds(first->second.ground_truth->lines) && !hasIds(second->second.ground_truth->lines) &&
      !(first->second.ground_truth->lines.empty() && second->second.ground_truth->lines.empty())) {
    ++pair_counts_.without_ids;
    return true;
  }
  try {
    pair_records_.push_back(times_.measure(Stage::kAssociation, [&] {
      return evaluator_.addPair(matches, first->second.ground_truth->lines,
                                second->second.ground_truth->lines);
    }));
    ++pair_counts_.evaluated;
    update->pairs.push_back(pair_records_.back());
  } catch (const GroundTruthError& error) {
    ++pair_counts_.bad_ground_truth;
    note(error.what(), update);
  } catch (const Error& error) {
    ++pair_counts_.skipped;
    note(error.what(), update);
  }
  return true;
}

bool PassEvaluation::evaluateDetectedPair(const MatchSet& matches, EvaluationUpdate* update) {
  if (!wants(MetricFamily::kAssociation)) {
    return true;
  }
  const auto first = entries_.find(matches.first_stamp);
  const auto second = entries_.find(matches.stamp);
  if (first == entries_.end() || second == entries_.end() ||
      first->second.record.state != FrameState::kEvaluated ||
      second->second.record.state != FrameState::kEvaluated) {
    return false;
  }
  if (first->second.released || second->second.released) {
    ++detected_pair_counts_.skipped;
    note("matches of " + formatStamp(matches.first_stamp) + " and " + formatStamp(matches.stamp) +
             ": they came when a frame had left the buffer of " + std::to_string(options_.buffer) +
             " frames; raise buffer",
         update);
    return true;
  }
  const std::vector<std::int64_t>& first_ids = first->second.carried_ids;
  const std::vector<std::int64_t>& second_ids = second->second.carried_ids;
  if (!first->second.true_ids && !second->second.true_ids) {
    ++detected_pair_counts_.without_ids;
    return true;
  }
  try {
    detected_pair_records_.push_back(times_.measure(Stage::kAssociation, [&] {
      return evaluator_.addDetectedPair(matches, first_ids, second_ids);
    }));
    ++detected_pair_counts_.evaluated;
    update->detected_pairs.push_back(detected_pair_records_.back());
  } catch (const Error& error) {
    ++detected_pair_counts_.skipped;
    note(error.what(), update);
  }
  return true;
}

bool PassEvaluation::betweenDetectedLines(const MatchSet& matches) const {
  return ground_truth_source_.empty() ? matches.lines_source == lines_source_
                                      : matches.lines_source != ground_truth_source_;
}

void PassEvaluation::countSkippedPair(const std::string& text) {
  ++pair_counts_.skipped;
  keepNote(text);
}

}  // namespace evolin
