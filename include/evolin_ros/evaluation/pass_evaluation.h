// Joins the parts of frames by stamp within one pass over a sequence, scores what is complete and
// accounts for the rest.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/evaluation/frame_figures.h"
#include "evolin_ros/evaluation/id_matches.h"
#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/motion_evaluation.h"
#include "evolin_ros/evaluation/report.h"
#include "evolin_ros/evaluation/sequence_evaluator.h"
#include "evolin_ros/evaluation/stage_times.h"
#include "evolin_ros/evaluation/track_follower.h"

namespace evolin {

struct PassOptions {
  MetricFamilies families = {allMetricFamilies().begin(), allMetricFamilies().end()};
  EvaluationOptions evaluation;
  MotionOptions motion;  ///< `buffer` and the two families wanted are those of this struct
  std::vector<double> auc_thresholds = {1, 3, 5, 10};  ///< of relative pose, degrees
  /// Frames whose lines are kept while a part is missing, and for the pairs to come.
  std::size_t buffer = 1000;
  /// Frames between the two of a pair: of matches from ids; else only to say how many pairs were to
  /// be expected.
  int frame_step = 1;
  /// Matches are the lines of equal id in frames a step apart (IdMatcher), and no others are taken.
  bool matches_from_ids = false;
};

/// What one message brought about.
struct EvaluationUpdate {
  std::vector<FrameRecord> frames;
  std::vector<PairRecord> pairs;
  std::vector<DetectedPairRecord> detected_pairs;
  std::vector<RepeatabilityRecord> repeatability;
  std::vector<HeatmapRecord> heatmaps;
  std::vector<PoseRecord> poses;
  std::vector<EvaluationTask> tasks;  ///< to be run, and their results added or the task skipped
  std::vector<std::string> notes;     ///< new ones, for the log
  std::vector<std::string> warnings;  ///< faults of the input, for the log; each kind is told once
  /// Told once: stamps of images (camera_info) are not those of the lines, but this far off, ns.
  std::optional<Stamp> image_offset;
  bool new_pass = false;
  std::string changed_settings;  ///< why there is a new pass where time has not jumped back

  void append(EvaluationUpdate other);
};

/// What those that send a stream's parts may still send.
struct MayCome {
  bool lines = true;
  bool matches = true;         ///< where some have come already
  bool first_matches = false;  ///< where none have
};

/// Figures of a pass so far without its records: a copy that may be looked at where nobody waits.
struct PassSums {
  SequenceEvaluator evaluator;
  RepeatabilityMetrics repeatability;
  std::optional<RepeatabilityMetrics> repeatability_by_score;
  OneToOneRepeatability one_to_one;
  BestLocalization best_localization;
  TrackReport tracks;
  CoverageCounts coverage;
  int pose_step = 0;  ///< PassEvaluation::poseStep()
};

/// Parts may come in any order and any time apart, each at most once. Not safe for several threads
/// at once.
class PassEvaluation {
 public:
  explicit PassEvaluation(PassOptions options = {});

  /// An image was there; its lines are awaited. What tells of images is a companion of theirs
  /// (camera_info), whose stamp may be slightly off: one near a frame that has no image of its own
  /// stamp is of that frame, and none is an image as long as no frame has one of its own stamp.
  EvaluationUpdate addImage(Stamp stamp);
  EvaluationUpdate addLines(LineSet lines);
  EvaluationUpdate addGroundTruth(LineSet ground_truth);
  /// Where matches come from ids, these count as skipped.
  EvaluationUpdate addMatches(MatchSet matches);
  EvaluationUpdate setCamera(const Camera& camera);
  EvaluationUpdate addDepth(Stamp stamp, DepthMap depth);
  EvaluationUpdate addPose(const StampedPose& pose);

  /// The result of a task of this pass.
  EvaluationUpdate addResult(const EvaluationResult& result);

  /// A task of this pass will not be run.
  void skip(const EvaluationTask& task);

  /// Frames from this stamp on that have no lines yet, and pairs that wait for them, belong to
  /// another pass; they leave no trace here.
  void forgetFrom(Stamp boundary);

  /// The frame is left out on purpose; `text` goes to the report's notes.
  void skipFrame(Stamp stamp, const std::string& text);

  /// Nor will those that are under way be waited for; a note says how many.
  void skipPending();

  bool hasPendingTasks() const { return heatmaps_pending_ + poses_pending_ > 0; }

  /// A message that cannot belong to any frame counts as a dropped one, a part of a pair as
  /// skipped. `text` goes to the report's notes; "" when it is there already.
  void countDroppedFrame(const std::string& text);
  void countSkippedPair(const std::string& text);

  /// A depth image or a camera pose cannot belong to any frame.
  void countLeftOutDepth(const std::string& text);
  void countLeftOutPose(const std::string& text);

  /// Goes to the report.
  void addNote(const std::string& text) { keepNote(text); }

  /// The figures so far. With `complete` nothing is waited for any more, and waiting frames are
  /// counted by what they lack.
  Report report(bool complete) const;

  /// Frames by state, as report(false) has them, without building a report.
  CoverageCounts coverage() const;

  /// The detector says that no lines of this frame will come, or the associator no matches of this
  /// second frame: they are not waited for. Counts nothing; before the frame is heard of, too.
  void leaveOutLines(Stamp stamp) { left_out_lines_.insert(stamp); }
  void leaveOutMatches(Stamp stamp) { left_out_matches_.insert(stamp); }

  /// Whether an image or ground truth is there whose lines may still come (a front-end that sends
  /// in order has left out what it has passed over), matches are still due for the newest frames,
  /// or tasks are under way.
  bool waiting(const MayCome& may_come = {}) const;

  const MotionEvaluation& motion() const { return motion_; }

  /// Images from the first to the second frame of every pose estimate so far; 0: it differs.
  int poseStep() const { return pose_steps_.size() == 1 ? *pose_steps_.begin() : 0; }

  TrackReport tracks() const;

  PassSums sums() const;

  const SequenceEvaluator& evaluator() const { return evaluator_; }

  /// What metrics have taken so far, but for tasks.
  const StageTimes& stageTimes() const { return times_; }

 private:
  struct Entry {
    bool image = false;
    std::optional<std::uint32_t> number;          ///< place of its lines among all lines by stamp
    std::shared_ptr<const LineSet> lines;         ///< until evaluated or released
    std::shared_ptr<const LineSet> ground_truth;  ///< until released
    bool released = false;
    bool true_ids = false;                  ///< its ground truth has ids, or has no lines
    std::vector<std::int64_t> carried_ids;  ///< of ground truth, for the detected lines; until
                                            ///< released and followed
    bool followed = false;                  ///< its tracks are
    FrameRecord record;                     ///< without entries and heatmap
    FrameFigures figures;                   ///< these
  };
  using PairKey = std::pair<Stamp, Stamp>;

  Entry& entryAt(Stamp stamp);
  std::uint32_t placeOfLines(Stamp stamp);
  EvaluationUpdate takeLines(LineSet lines);
  EvaluationUpdate takeMatches(MatchSet matches);
  void matchByIds(const LineSet& lines, IdMatcher::Result result, EvaluationUpdate* update);
  void setState(Entry* entry, FrameState state);
  void noteFrame(Stamp stamp, const Entry& entry);
  bool standsForAnother(Stamp image) const;
  int stepBetween(Stamp first, Stamp second) const;
  std::vector<Stamp> imagesOfOthers() const;
  std::optional<Stamp> nearestFrameTo(Stamp image) const;
  void settleImages(EvaluationUpdate* update);
  Stamp offsetOf(Stamp image) const;
  std::string imageOffsetNote() const;
  void noteLines(Stamp stamp);
  void evaluateFrame(Entry* entry, EvaluationUpdate* update);
  void evaluatePairsOf(Stamp stamp, EvaluationUpdate* update);
  /// True when the pair is settled one way or the other.
  bool evaluatePair(const MatchSet& matches, EvaluationUpdate* update);
  bool evaluateDetectedPair(const MatchSet& matches, EvaluationUpdate* update);
  std::string whyUnusable(const MatchSet& matches) const;
  void keepForTracks(const MatchSet& matches);
  void followTracks();
  static void follow(TrackedLines lines, const Entry& entry, TrackFollower* follower);
  void letGo(Entry* entry);
  void scoreFrame(Entry* entry, EvaluationUpdate* update);
  void take(MotionUpdate motion, EvaluationUpdate* update);
  bool wants(MetricFamily family) const { return options_.families.count(family) != 0; }
  void hold(Stamp stamp);
  static FrameState stateByWhatIsMissing(bool has_lines);
  void fillDetectedAssociation(Report* report) const;
  void fillHeatmap(Report* report) const;
  bool waitsForLines(Stamp stamp, const Entry& entry) const;
  bool isMatched(const Entry& entry) const;
  void fillMotion(bool complete, Report* report) const;
  void fillRepeatability(const MotionEvaluation& motion, Report* report) const;
  void note(const std::string& text, EvaluationUpdate* update);
  void noteOnce(const std::string& text, bool* told, EvaluationUpdate* update);
  void keepNote(const std::string& text);
  bool betweenDetectedLines(const MatchSet& matches) const;
  Stage motionStage() const {
    return wants(MetricFamily::kRepeatability) ? Stage::kRepeatability : Stage::kPose;
  }

  PassOptions options_;
  StageTimes times_;
  SequenceEvaluator evaluator_;
  std::map<Stamp, Entry> entries_;
  std::set<Stamp> held_;               ///< entries that hold lines or ground truth
  std::set<Stamp> images_alone_;       ///< images without lines or ground truth, not settled yet
  std::size_t frames_heard_ = 0;       ///< with lines or ground truth
  std::size_t exact_images_ = 0;       ///< frames among them whose image has their stamp
  std::set<Stamp> newest_with_lines_;  ///< frames, as many as it takes to overtake an image
  std::set<Stamp> images_doubted_;     ///< overtaken, before any frame had an image of its stamp
  std::optional<Stamp> dropped_image_offset_;
  bool image_offset_told_ = false;
  std::map<PairKey, MatchSet> pending_pairs_;
  std::map<PairKey, MatchSet> pending_detected_pairs_;
  std::vector<PairRecord> pair_records_;
  std::vector<DetectedPairRecord> detected_pair_records_;
  DetectedPairCounts detected_pair_counts_;
  TrackFollower follower_;
  std::map<Stamp, TrackedLines> unfollowed_;  ///< frames with lines that are not final yet
  MotionEvaluation motion_;
  std::vector<RepeatabilityRecord> repeatability_records_;
  std::vector<PoseRecord> pose_records_;
  std::set<int> pose_steps_;
  std::size_t heatmaps_pending_ = 0;
  std::size_t poses_pending_ = 0;
  std::optional<IdMatcher> id_matcher_;  ///< only where matches come from ids
  bool foreign_matches_told_ = false;
  bool missing_ids_told_ = false;
  PairCounts pair_counts_;
  CoverageCounts coverage_;
  std::size_t dropped_messages_ = 0;  ///< without an entry; in coverage_ all the same
  std::vector<double> detector_times_;
  std::vector<double> associator_times_;
  std::vector<std::string> notes_;
  std::size_t notes_left_out_ = 0;
  std::uint32_t lines_seen_ = 0;
  std::optional<Stamp> newest_lines_;
  bool lines_in_order_ = true;
  std::size_t ground_truth_seen_ = 0;
  std::optional<Stamp> newest_matches_;
  std::set<Stamp> left_out_lines_;
  std::set<Stamp> left_out_matches_;
  std::string lines_source_;
  std::string ground_truth_source_;
  std::string matches_source_;
  std::string matches_lines_source_;
};

}  // namespace evolin
