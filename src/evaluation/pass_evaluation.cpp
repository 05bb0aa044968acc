// Every frame that was heard of ends in exactly one state; nothing leaves without being counted.
#include "evolin_ros/evaluation/pass_evaluation.h"

#include <algorithm>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

constexpr std::size_t kMostNotes = 100;

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
  changed_settings += other.changed_settings;
  image_offset = image_offset ? image_offset : other.image_offset;
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
  lines_in_order_ = lines_in_order_ && (!newest_lines_ || stamp >= *newest_lines_);
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

EvaluationUpdate PassEvaluation::takeLines(LineSet lines) {
  EvaluationUpdate update;
  const Stamp stamp = lines.stamp;
  Entry& entry = entryAt(stamp);
  noteFrame(stamp, entry);
  entry.number = placeOfLines(stamp);
  entry.record.lines = lines.lines.size();
  noteLines(stamp);
  settleImages(&update);
  if (wants(MetricFamily::kTracks)) {
    std::size_t repeated = 0;
    TrackedLines& tracked = unfollowed_[stamp];
    tracked.stamp = stamp;
    tracked.count = lines.lines.size();
    tracked.track_ids = trackIdsOf(lines.lines, &repeated);
    if (repeated > 0) {
      note("lines of frame " + formatStamp(stamp) + ": " + std::to_string(repeated) +
               " repeat an id of the same frame; the first line of an id alone is followed",
           &update);
    }
  }
  take(times_.measure(motionStage(), [&] { return motion_.addLines(lines); }), &update);
  lines.processing_time = measuredTime(lines.processing_time);
  entry.record.processing_time = lines.processing_time;
  if (lines.processing_time > 0) {
    detector_times_.push_back(lines.processing_time);
  }
  lines_source_ = lines.source;
  if (entry.released) {
    setState(&entry, FrameState::kDropped);
    return update;
  }
  entry.lines = std::make_shared<const LineSet>(std::move(lines));
  hold(stamp);
  evaluateFrame(&entry, &update);
  times_.measure(Stage::kTracks, [this] { followTracks(); });
  return update;
}

EvaluationUpdate PassEvaluation::addGroundTruth(LineSet ground_truth) {
  EvaluationUpdate update;
  const Stamp stamp = ground_truth.stamp;
  Entry& entry = entryAt(stamp);
  noteFrame(stamp, entry);
  entry.record.ground_truth = ground_truth.lines.size();
  ground_truth_source_ = ground_truth.source;
  ++ground_truth_seen_;
  take(times_.measure(motionStage(), [&] { return motion_.addGroundTruth(ground_truth); }),
       &update);
  if (entry.released) {
    setState(&entry, FrameState::kDropped);
    return update;
  }
  entry.ground_truth = std::make_shared<const LineSet>(std::move(ground_truth));
  hold(stamp);
  evaluateFrame(&entry, &update);
  evaluatePairsOf(stamp, &update);
  return update;
}

EvaluationUpdate PassEvaluation::setCamera(const Camera& camera) {
  EvaluationUpdate update;
  take(times_.measure(motionStage(), [&] { return motion_.setCamera(camera); }), &update);
  return update;
}

EvaluationUpdate PassEvaluation::addDepth(Stamp stamp, DepthMap depth) {
  EvaluationUpdate update;
  take(times_.measure(motionStage(), [&] { return motion_.addDepth(stamp, std::move(depth)); }),
       &update);
  return update;
}

EvaluationUpdate PassEvaluation::addPose(const StampedPose& pose) {
  EvaluationUpdate update;
  take(times_.measure(motionStage(), [&] { return motion_.addPose(pose); }), &update);
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
    pose_records_.back().frame_step = stepBetween(pose->first_stamp, pose->stamp);
    pose_steps_.insert(pose_records_.back().frame_step);
    update.poses.push_back(pose_records_.back());
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
  if (heatmap.scored != false) {
    entries_.at(heatmap.stamp).figures.keepHeatmap(heatmap.counts);
  }
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
  entry->figures.keepDetection(&entry->record);
}

void PassEvaluation::scoreFrame(Entry* entry, EvaluationUpdate* update) {
  const LineSet& lines = *entry->lines;
  const LineSet& ground_truth = *entry->ground_truth;
  FrameRecord record = times_.measure(
      Stage::kDetection, [&] { return evaluator_.addFrame(*entry->number, lines, ground_truth); });
  setState(entry, FrameState::kEvaluated);
  entry->record = std::move(record);
  entry->true_ids = ground_truth.lines.empty() || hasIds(ground_truth.lines);
  if (wants(MetricFamily::kAssociation) || wants(MetricFamily::kTracks)) {
    entry->carried_ids = times_.measure(Stage::kAssociation,
                                        [&] { return evaluator_.carriedIds(lines, ground_truth); });
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

void PassEvaluation::hold(Stamp stamp) {
  held_.insert(stamp);
  if (held_.size() <= options_.buffer) {
    return;
  }
  Entry& oldest = entries_.at(*held_.begin());
  if (oldest.record.state == FrameState::kWaiting) {
    setState(&oldest, stateByWhatIsMissing(oldest.lines != nullptr));
  }
  oldest.lines.reset();
  oldest.ground_truth.reset();
  oldest.released = true;
  letGo(&oldest);
  held_.erase(held_.begin());
}

void PassEvaluation::countLeftOutDepth(const std::string& text) {
  ++coverage_.depth_left_out;
  keepNote(text);
}

void PassEvaluation::countLeftOutPose(const std::string& text) {
  ++coverage_.poses_left_out;
  keepNote(text);
}

void PassEvaluation::countDroppedFrame(const std::string& text) {
  ++dropped_messages_;
  coverage_.add(FrameState::kDropped);
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

}  // namespace evolin
