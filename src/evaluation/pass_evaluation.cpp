// Every frame that was heard of ends in exactly one state; nothing leaves without being counted.
#include "evolin_ros/evaluation/pass_evaluation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

constexpr std::size_t kMostNotes = 100;

bool isMeasured(double processing_time) {
  return std::isfinite(processing_time) && processing_time > 0;
}

bool hasIds(const LineSegments& lines) {
  return std::any_of(lines.begin(), lines.end(),
                     [](const LineSegment& line) { return line.id >= 0; });
}

FrameState stateByWhatIsMissing(bool has_lines) {
  return has_lines ? FrameState::kNoGroundTruth : FrameState::kUnmatched;
}

}  // namespace

void EvaluationUpdate::append(EvaluationUpdate other) {
  std::move(other.frames.begin(), other.frames.end(), std::back_inserter(frames));
  std::move(other.pairs.begin(), other.pairs.end(), std::back_inserter(pairs));
  std::move(other.notes.begin(), other.notes.end(), std::back_inserter(notes));
  std::move(other.warnings.begin(), other.warnings.end(), std::back_inserter(warnings));
  new_pass = new_pass || other.new_pass;
}

PassEvaluation::PassEvaluation(PassOptions options)
    : options_(std::move(options)), evaluator_(options_.evaluation) {}

PassEvaluation::Entry& PassEvaluation::entryAt(Stamp stamp) {
  const auto [place, is_new] = entries_.try_emplace(stamp);
  if (is_new) {
    place->second.record.stamp = stamp;
    coverage_.add(FrameState::kWaiting);
  }
  return place->second;
}

void PassEvaluation::setState(Entry* entry, FrameState state) {
  coverage_.remove(entry->record.state);
  coverage_.add(state);
  entry->record.state = state;
}

/// Equal scores are ranked by the frames' order in time, whatever order they arrive in.
std::uint32_t PassEvaluation::placeOfLines(Stamp stamp) {
  std::uint32_t place = lines_seen_++;
  if (!newest_lines_ || stamp > *newest_lines_) {
    newest_lines_ = stamp;
    return place;
  }
  for (auto later = entries_.rbegin(); later != entries_.rend() && later->first > stamp; ++later) {
    if (later->second.number) {
      place = (*later->second.number)++;
    }
  }
  evaluator_.makeRoom(place);
  return place;
}

EvaluationUpdate PassEvaluation::addImage(Stamp stamp) {
  entryAt(stamp).image = true;
  return {};
}

EvaluationUpdate PassEvaluation::addLines(LineSet lines) {
  EvaluationUpdate update;
  const Stamp stamp = lines.stamp;
  Entry& entry = entryAt(stamp);
  entry.number = placeOfLines(stamp);
  entry.record.lines = lines.lines.size();
  if (!isMeasured(lines.processing_time)) {
    lines.processing_time = 0;
  }
  entry.record.processing_time = lines.processing_time;
  if (lines.processing_time > 0) {
    detector_times_.push_back(lines.processing_time);
  }
  lines_source_ = lines.source;
  if (entry.released) {
    setState(&entry, FrameState::kDropped);
    return update;
  }
  entry.lines = std::move(lines);
  hold(stamp);
  evaluateFrame(&entry, &update);
  return update;
}

EvaluationUpdate PassEvaluation::addGroundTruth(LineSet ground_truth) {
  EvaluationUpdate update;
  const Stamp stamp = ground_truth.stamp;
  Entry& entry = entryAt(stamp);
  entry.record.ground_truth = ground_truth.lines.size();
  ground_truth_source_ = ground_truth.source;
  ++ground_truth_seen_;
  if (entry.released) {
    setState(&entry, FrameState::kDropped);
    return update;
  }
  entry.ground_truth = std::move(ground_truth);
  hold(stamp);
  evaluateFrame(&entry, &update);
  evaluatePairsOf(stamp, &update);
  return update;
}

EvaluationUpdate PassEvaluation::addMatches(MatchSet matches) {
  EvaluationUpdate update;
  if (!isMeasured(matches.processing_time)) {
    matches.processing_time = 0;
  }
  if (matches.processing_time > 0) {
    associator_times_.push_back(matches.processing_time);
  }
  matches_source_ = matches.source;
  matches_lines_source_ = matches.lines_source;
  newest_matches_ = std::max(matches.stamp, newest_matches_.value_or(matches.stamp));
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

void PassEvaluation::evaluateFrame(Entry* entry, EvaluationUpdate* update) {
  if (!entry->lines || !entry->ground_truth || entry->record.state != FrameState::kWaiting) {
    return;
  }
  try {
    FrameRecord record = evaluator_.addFrame(*entry->number, *entry->lines, *entry->ground_truth);
    setState(entry, FrameState::kEvaluated);
    entry->record = std::move(record);
  } catch (const GroundTruthError& error) {
    setState(entry, FrameState::kBadGroundTruth);
    note(error.what(), update);
  } catch (const Error& error) {
    setState(entry, FrameState::kSkipped);
    note(error.what(), update);
  }
  entry->lines.reset();
  update->frames.push_back(entry->record);
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
    pair_records_.push_back(evaluator_.addPair(matches, first->second.ground_truth->lines,
                                               second->second.ground_truth->lines));
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

void PassEvaluation::hold(Stamp stamp) {
  held_.insert(stamp);
  if (held_.size() <= options_.buffer) {
    return;
  }
  Entry& oldest = entries_.at(*held_.begin());
  if (oldest.record.state == FrameState::kWaiting) {
    setState(&oldest, stateByWhatIsMissing(oldest.lines.has_value()));
  }
  oldest.lines.reset();
  oldest.ground_truth.reset();
  oldest.released = true;
  held_.erase(held_.begin());
}

void PassEvaluation::countDroppedFrame(const std::string& text) {
  ++dropped_messages_;
  coverage_.add(FrameState::kDropped);
  keepNote(text);
}

void PassEvaluation::countSkippedPair(const std::string& text) {
  ++pair_counts_.skipped;
  keepNote(text);
}

void PassEvaluation::note(const std::string& text, EvaluationUpdate* update) {
  update->notes.push_back(text);
  keepNote(text);
}

void PassEvaluation::keepNote(const std::string& text) {
  if (text.empty()) {
    return;
  }
  if (notes_.size() < kMostNotes) {
    notes_.push_back(text);
  } else {
    ++notes_left_out_;
  }
}

bool PassEvaluation::betweenDetectedLines(const MatchSet& matches) const {
  return ground_truth_source_.empty() ? matches.lines_source == lines_source_
                                      : matches.lines_source != ground_truth_source_;
}

bool PassEvaluation::waiting() const {
  std::optional<Stamp> newest;
  for (const auto& [stamp, entry] : entries_) {
    const bool has_lines = entry.record.lines.has_value();
    if (!has_lines && entry.record.state == FrameState::kWaiting) {
      return true;
    }
    const bool matched_lines = matches_lines_source_ == ground_truth_source_
                                   ? entry.record.ground_truth.has_value()
                                   : has_lines;
    if (matched_lines) {
      newest = stamp;
    }
  }
  return newest_matches_ && newest && *newest_matches_ < *newest;
}

Report PassEvaluation::report(bool complete) const {
  Report report;
  report.protocol = options_.evaluation.vectorized.protocol;
  report.complete = complete;
  report.lines_source = lines_source_;
  report.ground_truth_source = ground_truth_source_;
  report.matches_source = matches_source_;
  report.matches_lines_source = matches_lines_source_;
  report.detection_frames = evaluator_.detection().frames();
  report.scored = evaluator_.detection().scored();
  report.detection = evaluator_.detectionEntries();
  report.association = evaluator_.association().classification();
  report.pairs = pair_counts_;
  for (const auto& [key, matches] : pending_pairs_) {
    ++(betweenDetectedLines(matches) ? report.pairs.detected_lines : report.pairs.no_ground_truth);
  }
  const bool on_ground_truth = newest_matches_ && !ground_truth_source_.empty() &&
                               matches_lines_source_ == ground_truth_source_;
  if (on_ground_truth) {
    const auto step = static_cast<std::size_t>(options_.frame_step);
    report.pairs_expected = ground_truth_seen_ > step ? ground_truth_seen_ - step : 0;
  }
  report.detector_timing = summarizeTimes(detector_times_);
  report.associator_timing = summarizeTimes(associator_times_);
  report.frames.reserve(entries_.size());
  for (const auto& [stamp, entry] : entries_) {
    FrameRecord record = entry.record;
    if (complete && record.state == FrameState::kWaiting) {
      record.state = stateByWhatIsMissing(record.lines.has_value());
    }
    report.coverage.add(record.state);
    report.frames.push_back(std::move(record));
  }
  for (std::size_t i = 0; i < dropped_messages_; ++i) {
    report.coverage.add(FrameState::kDropped);
  }
  report.pair_records = pair_records_;
  std::sort(report.pair_records.begin(), report.pair_records.end(),
            [](const PairRecord& a, const PairRecord& b) {
              return std::tie(a.stamp, a.first_stamp) < std::tie(b.stamp, b.first_stamp);
            });
  report.notes = notes_;
  if (notes_left_out_ > 0) {
    report.notes.push_back("and " + std::to_string(notes_left_out_) + " more of these");
  }
  return report;
}

}  // namespace evolin
