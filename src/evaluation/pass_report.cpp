// What a pass has to tell, put together.
#include <algorithm>
#include <tuple>
#include <utility>

#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

namespace {

/// By second stamp, then first.
template <class Record>
void sortByStamp(std::vector<Record>* records) {
  std::stable_sort(records->begin(), records->end(), [](const Record& a, const Record& b) {
    return std::tie(a.stamp, a.first_stamp) < std::tie(b.stamp, b.first_stamp);
  });
}

void appendRows(const RepeatabilityMetrics& metrics, std::vector<RepeatabilityRow>* rows) {
  for (std::size_t i = 0; i < metrics.settings().size(); ++i) {
    const RepeatabilitySetting& setting = metrics.settings()[i];
    rows->push_back({setting, metrics.pairs(setting.frame_step), metrics.figures(i)});
  }
}

}  // namespace

FrameState PassEvaluation::stateByWhatIsMissing(bool has_lines) {
  return has_lines ? FrameState::kNoGroundTruth : FrameState::kUnmatched;
}

CoverageCounts PassEvaluation::coverage() const {
  CoverageCounts counts = coverage_;
  const std::size_t others = imagesOfOthers().size();
  counts.seen -= others;
  counts.waiting -= others;
  counts.no_depth = motion_.counts().no_depth;
  counts.no_pose = motion_.counts().no_pose;
  counts.bad_lines = motion_.counts().bad_lines;
  const MotionWaiting waiting = motion_.waiting();
  counts.waiting_depth = waiting.depth;
  counts.waiting_pose = waiting.pose;
  return counts;
}

PassSums PassEvaluation::sums() const {
  return {evaluator_,
          motion_.repeatability(),
          motion_.repeatabilityByScore(),
          motion_.oneToOne(),
          motion_.bestLocalization(),
          wants(MetricFamily::kTracks) ? tracks() : TrackReport(),
          coverage(),
          poseStep()};
}

bool PassEvaluation::waitsForLines(Stamp stamp, const Entry& entry) const {
  if (entry.record.lines || entry.record.state != FrameState::kWaiting ||
      left_out_lines_.count(stamp) != 0) {
    return false;
  }
  const bool passed_over = lines_in_order_ && newest_lines_ && stamp < *newest_lines_;
  const bool alone = !entry.record.ground_truth;
  return !passed_over && !(alone && standsForAnother(stamp));
}

/// Whether the frame has the lines that matches are between, as far as that is known.
bool PassEvaluation::isMatched(const Entry& entry) const {
  const bool on_ground_truth =
      newest_matches_ ? matches_lines_source_ == ground_truth_source_ : lines_seen_ == 0;
  return on_ground_truth ? entry.record.ground_truth.has_value() : entry.record.lines.has_value();
}

bool PassEvaluation::waiting(const MayCome& may_come) const {
  if (hasPendingTasks()) {
    return true;
  }
  if (entries_.empty()) {
    return may_come.first_matches;
  }
  std::optional<Stamp> newest;
  for (const auto& [stamp, entry] : entries_) {
    if (may_come.lines && waitsForLines(stamp, entry)) {
      return true;
    }
    if (isMatched(entry) && left_out_matches_.count(stamp) == 0) {
      newest = stamp;
    }
  }
  if (!newest_matches_) {
    return may_come.first_matches && newest;
  }
  return may_come.matches && newest && *newest_matches_ < *newest;
}

Report PassEvaluation::report(bool complete) const {
  Report report;
  report.families = options_.families;
  report.protocol = options_.evaluation.vectorized.protocol;
  report.complete = complete && !hasPendingTasks();
  report.lines_source = lines_source_;
  report.ground_truth_source = ground_truth_source_;
  report.matches_source = matches_source_;
  report.matches_lines_source = matches_lines_source_;
  report.detection_frames = evaluator_.detection().frames();
  report.detection_dropped = evaluator_.detection().dropped();
  report.scored = evaluator_.detection().scored();
  report.detection = evaluator_.detectionEntries();
  report.spatial_spread = evaluator_.spread().share();
  report.association = evaluator_.association().classification();
  report.pairs = pair_counts_;
  for (const auto& [key, matches] : pending_pairs_) {
    ++(betweenDetectedLines(matches) ? report.pairs.detected_lines : report.pairs.no_ground_truth);
  }
  fillDetectedAssociation(&report);
  fillHeatmap(&report);
  fillMotion(complete, &report);
  if (wants(MetricFamily::kTracks)) {
    report.tracks = tracks();
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
  const std::vector<Stamp> of_others = imagesOfOthers();
  for (const auto& [stamp, entry] : entries_) {
    if (std::binary_search(of_others.begin(), of_others.end(), stamp)) {
      continue;
    }
    FrameRecord record = entry.record;
    entry.figures.restore(evaluator_.detection().settings(), &record);
    if (complete && record.state == FrameState::kWaiting) {
      record.state = stateByWhatIsMissing(record.lines.has_value());
    }
    report.coverage.add(record.state);
    report.frames.push_back(std::move(record));
  }
  report.pair_records = pair_records_;
  for (std::size_t i = 0; i < dropped_messages_; ++i) {
    report.coverage.add(FrameState::kDropped);
  }
  sortByStamp(&report.pair_records);
  report.notes = notes_;
  if (std::string text = imageOffsetNote(); complete && !text.empty()) {
    report.notes.push_back(std::move(text));
  }
  if (notes_left_out_ > 0) {
    report.notes.push_back("and " + std::to_string(notes_left_out_) + " more of these");
  }
  return report;
}

void PassEvaluation::fillDetectedAssociation(Report* report) const {
  report->detected_association = evaluator_.detectedAssociation().classification();
  report->detected_pairs = detected_pair_counts_;
  report->detected_pairs.no_ground_truth += pending_detected_pairs_.size();
  for (const auto& [key, matches] : pending_pairs_) {
    report->detected_pairs.no_ground_truth += betweenDetectedLines(matches) ? 1 : 0;
  }
  report->detected_pair_records = detected_pair_records_;
  sortByStamp(&report->detected_pair_records);
}

void PassEvaluation::fillHeatmap(Report* report) const {
  report->heatmap.score_thresholds = evaluator_.heatmapThresholds();
  report->heatmap.counts = evaluator_.heatmap();
  report->heatmap.frames = evaluator_.heatmapFrames();
  report->heatmap.unscored = evaluator_.unscoredHeatmap();
  report->heatmap.pending = heatmaps_pending_;
}

void PassEvaluation::fillMotion(bool complete, Report* report) const {
  PoseReport& pose = report->pose;
  pose.method = options_.motion.pose_method;
  pose.auc_thresholds = options_.auc_thresholds;
  pose.errors = evaluator_.pose();
  pose.pending = poses_pending_;
  pose.records = pose_records_;
  report->repeatability.records = repeatability_records_;
  if (!complete) {
    fillRepeatability(motion_, report);
  } else {
    // What still waits will wait for ever; the pass itself stays open for what may come all the
    // same.
    MotionEvaluation finished = motion_;
    for (const Stamp image : imagesOfOthers()) {
      finished.removeImage(image);
    }
    MotionUpdate rest = finished.finish();
    std::vector<RepeatabilityRecord>& records = report->repeatability.records;
    records.insert(records.end(), rest.repeatability.begin(), rest.repeatability.end());
    const PoseMethod method(options_.motion.pose_method);
    for (const PoseTask& task : rest.pose_tasks) {
      pose.records.push_back(runPoseTask(task, method));
      pose.errors.addPair(pose.records.back().pair);
    }
    fillRepeatability(finished, report);
  }
  sortByStamp(&report->repeatability.records);
  sortByStamp(&pose.records);
  // Only now is it known which images lie between.
  std::map<Stamp, int> places;
  int place = 0;
  const std::vector<Stamp> of_others = imagesOfOthers();
  for (const auto& [stamp, entry] : entries_) {
    if (!std::binary_search(of_others.begin(), of_others.end(), stamp)) {
      places.emplace_hint(places.end(), stamp, place++);
    }
  }
  std::set<int> steps;
  for (PoseRecord& record : pose.records) {
    record.frame_step = places.at(record.stamp) - places.at(record.first_stamp);
    steps.insert(record.frame_step);
  }
  pose.frame_step = steps.size() == 1 ? *steps.begin() : 0;
}

void PassEvaluation::fillRepeatability(const MotionEvaluation& motion, Report* report) const {
  RepeatabilityReport& repeatability = report->repeatability;
  repeatability.counts = motion.counts();
  repeatability.camera = motion.hasCamera();
  repeatability.depth = motion.hasDepth();
  repeatability.poses = motion.hasPoses();
  repeatability.nearest_depth_miss = motion.nearestDepthMiss();
  appendRows(motion.repeatability(), &repeatability.rows);
  if (motion.repeatabilityByScore()) {
    appendRows(*motion.repeatabilityByScore(), &repeatability.rows);
  }
  repeatability.one_to_one = motion.oneToOne();
  repeatability.best_localization = motion.bestLocalization();
  repeatability.best_count = options_.motion.best_localization.count;
  report->coverage.no_depth = motion.counts().no_depth;
  report->coverage.no_pose = motion.counts().no_pose;
  report->coverage.waiting_depth = motion.waiting().depth;
  report->coverage.waiting_pose = motion.waiting().pose;
  report->coverage.bad_lines = motion.counts().bad_lines;
  report->coverage.heatmap_skipped = coverage_.heatmap_skipped;
  report->coverage.pose_skipped = coverage_.pose_skipped;
  report->coverage.depth_left_out = coverage_.depth_left_out;
  report->coverage.poses_left_out = coverage_.poses_left_out;
}

}  // namespace evolin
