// Every frame that was heard of ends in exactly one state; nothing leaves without being counted.
#include "evolin_ros/evaluation/pass_evaluation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

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

/// Empty when no line has an id. An id names one line of a frame: only its first row keeps it.
std::vector<std::int64_t> trackIdsOf(const LineSegments& lines, std::size_t* repeated) {
  std::vector<std::int64_t> ids;
  if (!hasIds(lines)) {
    return ids;
  }
  std::unordered_set<std::int64_t> seen;
  for (const LineSegment& line : lines) {
    const bool is_new = line.id >= 0 && seen.insert(line.id).second;
    *repeated += line.id >= 0 && !is_new ? 1 : 0;
    ids.push_back(is_new ? line.id : kNoId);
  }
  return ids;
}

template <class Item>
void appendTo(std::vector<Item>* items, std::vector<Item> others) {
  std::move(others.begin(), others.end(), std::back_inserter(*items));
}

MotionOptions motionOptionsOf(const PassOptions& options) {
  MotionOptions motion = options.motion;
  motion.repeatability = options.families.count(MetricFamily::kRepeatability) != 0;
  motion.pose = options.families.count(MetricFamily::kPose) != 0;
  motion.pose_errors = options.evaluation.pose_errors;
  motion.buffer = options.buffer;
  return motion;
}

}  // namespace

void EvaluationUpdate::append(EvaluationUpdate other) {
  appendTo(&frames, std::move(other.frames));
  appendTo(&pairs, std::move(other.pairs));
  appendTo(&detected_pairs, std::move(other.detected_pairs));
  appendTo(&repeatability, std::move(other.repeatability));
  appendTo(&heatmaps, std::move(other.heatmaps));
  appendTo(&poses, std::move(other.poses));
  appendTo(&tasks, std::move(other.tasks));
  appendTo(&notes, std::move(other.notes));
  appendTo(&warnings, std::move(other.warnings));
  new_pass = new_pass || other.new_pass;
}

PassEvaluation::PassEvaluation(PassOptions options)
    : options_(std::move(options)),
      evaluator_(options_.evaluation),
      motion_(motionOptionsOf(options_)) {
  if (options_.matches_from_ids) {
    id_matcher_.emplace(options_.frame_step);
  }
}

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
  EvaluationUpdate update;
  take(motion_.addImage(stamp), &update);
  return update;
}

EvaluationUpdate PassEvaluation::takeLines(LineSet lines) {
  EvaluationUpdate update;
  const Stamp stamp = lines.stamp;
  Entry& entry = entryAt(stamp);
  entry.number = placeOfLines(stamp);
  entry.record.lines = lines.lines.size();
  entry.line_count = lines.lines.size();
  if (wants(MetricFamily::kTracks)) {
    std::size_t repeated = 0;
    entry.track_ids = trackIdsOf(lines.lines, &repeated);
    if (repeated > 0) {
      note("lines of frame " + formatStamp(stamp) + ": " + std::to_string(repeated) +
               " repeat an id of the same frame; the first line of an id alone is followed",
           &update);
    }
  }
  take(motion_.addLines(lines), &update);
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
  take(motion_.addGroundTruth(ground_truth), &update);
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

EvaluationUpdate PassEvaluation::takeMatches(MatchSet matches) {
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
  if (const std::string why = whyUnusable(matches); !why.empty()) {
    ++pair_counts_.skipped;
    note("matches of " + formatStamp(matches.first_stamp) + " and " + formatStamp(matches.stamp) +
             ": " + why,
         &update);
    return update;
  }
  if (wants(MetricFamily::kTracks)) {
    keepForTracks(matches);
  }
  take(motion_.addMatches(matches), &update);
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

/// Matches come after the lines that they are between; of ones that overtake them no track is made.
void PassEvaluation::keepForTracks(const MatchSet& matches) {
  const auto second = entries_.find(matches.stamp);
  if (second != entries_.end() && matches.lines_source != ground_truth_source_) {
    second->second.earlier_matches = matches;
  }
}

EvaluationUpdate PassEvaluation::setCamera(const Camera& camera) {
  EvaluationUpdate update;
  take(motion_.setCamera(camera), &update);
  return update;
}

EvaluationUpdate PassEvaluation::addDepth(Stamp stamp, DepthMap depth) {
  EvaluationUpdate update;
  take(motion_.addDepth(stamp, std::move(depth)), &update);
  return update;
}

EvaluationUpdate PassEvaluation::addPose(const StampedPose& pose) {
  EvaluationUpdate update;
  take(motion_.addPose(pose), &update);
  return update;
}

void PassEvaluation::take(MotionUpdate motion, EvaluationUpdate* update) {
  repeatability_records_.insert(repeatability_records_.end(), motion.repeatability.begin(),
                                motion.repeatability.end());
  appendTo(&update->repeatability, std::move(motion.repeatability));
  for (PoseTask& task : motion.pose_tasks) {
    ++poses_pending_;
    update->tasks.push_back({0, 0, std::move(task)});
  }
  for (const std::string& text : motion.notes) {
    note(text, update);
  }
}

EvaluationUpdate PassEvaluation::addResult(const EvaluationResult& result) {
  EvaluationUpdate update;
  if (const auto* pose = std::get_if<PoseRecord>(&result.record)) {
    --poses_pending_;
    evaluator_.addPose(*pose);
    pose_records_.push_back(*pose);
    update.poses.push_back(*pose);
    return update;
  }
  const auto& heatmap = std::get<HeatmapRecord>(result.record);
  --heatmaps_pending_;
  if (!heatmap.reason.empty()) {
    ++coverage_.heatmap_skipped;
    note("heatmap: " + heatmap.reason, &update);
    return update;
  }
  evaluator_.addHeatmap(heatmap);
  entries_.at(heatmap.stamp).record.heatmap = heatmap.counts;
  update.heatmaps.push_back(heatmap);
  return update;
}

void PassEvaluation::skip(const EvaluationTask& task) {
  if (std::holds_alternative<PoseTask>(task.work)) {
    --poses_pending_;
    ++coverage_.pose_skipped;
  } else {
    --heatmaps_pending_;
    ++coverage_.heatmap_skipped;
  }
}

void PassEvaluation::skipPending() {
  if (!hasPendingTasks()) {
    return;
  }
  keepNote(std::to_string(heatmaps_pending_) + " heatmaps and " + std::to_string(poses_pending_) +
           " pose estimates were still under way when the pass was closed; they are left out");
  coverage_.heatmap_skipped += std::exchange(heatmaps_pending_, 0);
  coverage_.pose_skipped += std::exchange(poses_pending_, 0);
}

void PassEvaluation::evaluateFrame(Entry* entry, EvaluationUpdate* update) {
  if (!entry->lines || !entry->ground_truth || entry->record.state != FrameState::kWaiting) {
    return;
  }
  try {
    scoreFrame(entry, update);
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

void PassEvaluation::scoreFrame(Entry* entry, EvaluationUpdate* update) {
  const LineSet& lines = *entry->lines;
  const LineSet& ground_truth = *entry->ground_truth;
  FrameRecord record = evaluator_.addFrame(*entry->number, lines, ground_truth);
  setState(entry, FrameState::kEvaluated);
  entry->record = std::move(record);
  entry->true_ids = ground_truth.lines.empty() || hasIds(ground_truth.lines);
  if (wants(MetricFamily::kAssociation) || wants(MetricFamily::kTracks)) {
    entry->carried_ids = evaluator_.carriedIds(lines, ground_truth);
  }
  if (wants(MetricFamily::kHeatmap)) {
    ++heatmaps_pending_;
    update->tasks.push_back(
        {0, 0,
         HeatmapTask{lines.stamp, {lines.width, lines.height}, lines.lines, ground_truth.lines}});
  }
  const Stamp stamp = lines.stamp;
  for (auto pair = pending_detected_pairs_.begin(); pair != pending_detected_pairs_.end();) {
    const bool concerned = pair->first.first == stamp || pair->first.second == stamp;
    const bool settled = concerned && evaluateDetectedPair(pair->second, update);
    pair = settled ? pending_detected_pairs_.erase(pair) : std::next(pair);
  }
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
  const std::vector<std::int64_t>& first_ids = first->second.carried_ids;
  const std::vector<std::int64_t>& second_ids = second->second.carried_ids;
  if (!first->second.true_ids && !second->second.true_ids) {
    ++detected_pair_counts_.without_ids;
    return true;
  }
  try {
    detected_pair_records_.push_back(evaluator_.addDetectedPair(matches, first_ids, second_ids));
    ++detected_pair_counts_.evaluated;
    update->detected_pairs.push_back(detected_pair_records_.back());
  } catch (const Error& error) {
    ++detected_pair_counts_.skipped;
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

}  // namespace evolin
