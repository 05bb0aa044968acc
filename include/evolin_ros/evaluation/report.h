// Everything that an evaluation found, as plain values, and its forms on disk.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/evaluation/metric_family.h"
#include "evolin_ros/evaluation/motion_evaluation.h"
#include "evolin_ros/evaluation/stage_times.h"
#include "evolin_ros/evaluation/task.h"
#include "evolin_ros/evaluation/track_follower.h"
#include "evolin_ros/metrics/bootstrap.h"
#include "evolin_ros/metrics/classification.h"
#include "evolin_ros/metrics/detected_association.h"
#include "evolin_ros/metrics/pose_error.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

/// What became of a frame.
enum class FrameState {
  kWaiting,  ///< a part may still come
  kEvaluated,
  kUnmatched,  ///< the detector's lines never came
  kDropped,    ///< a part came after the frame had to leave the full buffer, or its stamp fits
               ///< nowhere
  kNoGroundTruth,
  kBadGroundTruth,
  kSkipped  ///< a message was unusable; a note says why
};

/// "evaluated", "no_ground_truth", ... as in Coverage.msg.
std::string toString(FrameState state);

/// Frames by state; seen is the sum of all others. A message that belongs to no frame (without a
/// stamp, with one that its input has just had, of a pass that is closed) is a dropped one.
struct CoverageCounts {
  std::size_t seen = 0;
  std::size_t waiting = 0;
  std::size_t evaluated = 0;
  std::size_t unmatched = 0;
  std::size_t dropped = 0;
  std::size_t no_ground_truth = 0;
  std::size_t bad_ground_truth = 0;
  std::size_t skipped = 0;

  // Besides: a frame may be evaluated and lack what one family needs.
  std::size_t no_depth = 0;         ///< frames with lines to which no depth image belongs
  std::size_t no_pose = 0;          ///< frames with lines without a camera pose
  std::size_t waiting_depth = 0;    ///< frames with lines whose depth or camera may still come
  std::size_t waiting_pose = 0;     ///< frames with lines whose pose may still come
  std::size_t bad_lines = 0;        ///< frames with lines that are not finite
  std::size_t heatmap_skipped = 0;  ///< frames left out of the heatmap for want of time
  std::size_t pose_skipped = 0;     ///< pairs left out of relative pose for want of time
  std::size_t depth_left_out = 0;   ///< depth images without a stamp
  std::size_t poses_left_out = 0;   ///< camera poses without a stamp

  void add(FrameState state);
  void remove(FrameState state);

  /// The counter of one state.
  std::size_t& of(FrameState state);
};

/// One setting's figures.
struct DetectionEntry {
  VectorizedSetting setting;
  Classification counts;
  std::optional<double> average_precision;
};

/// One frame's own figures; `entries` is empty unless it was evaluated.
struct FrameRecord {
  Stamp stamp = 0;
  FrameState state = FrameState::kWaiting;
  std::optional<std::size_t> lines;         ///< detected
  std::optional<std::size_t> ground_truth;  ///< annotated
  double processing_time = 0;               ///< of the detector, s; 0: not measured
  std::vector<DetectionEntry> entries;
  double spatial_spread = 0;            ///< share of the image's cells that lines touch
  std::vector<Classification> heatmap;  ///< by falling score threshold; empty: not (yet) measured
};

/// One pair's own figures.
struct PairRecord {
  Stamp first_stamp = 0;
  Stamp stamp = 0;
  double processing_time = 0;  ///< of the associator, s; 0: not measured
  Classification counts;
};

/// The same of a pair whose matches are between detected lines.
struct DetectedPairRecord {
  Stamp first_stamp = 0;
  Stamp stamp = 0;
  DetectedAssociation counts;
};

/// Pairs of frames by what became of their matches between detected lines.
struct DetectedPairCounts {
  std::size_t evaluated = 0;
  std::size_t no_ground_truth = 0;  ///< of one of the two frames (so far)
  std::size_t without_ids = 0;      ///< no annotated line of the two frames has an id
  std::size_t skipped = 0;          ///< unusable; a note says why
};

/// Pairs of frames by what became of their matches.
struct PairCounts {
  std::size_t evaluated = 0;
  std::size_t detected_lines = 0;   ///< matches between detected lines: another family
  std::size_t no_ground_truth = 0;  ///< ground truth of one of the two frames is missing (so far)
  std::size_t bad_ground_truth = 0;
  std::size_t without_ids = 0;  ///< no line of the two frames has an id: true matches are unknown
  std::size_t skipped = 0;      ///< unusable; a note says why
};

/// Wall time that a method took, frame by frame.
struct TimingSummary {
  std::size_t frames = 0;  ///< with a measured time
  double mean = 0;         ///< seconds, as the next four
  double median = 0;
  double p95 = 0;
  double max = 0;
  double rate = 0;  ///< frames per second the method could sustain: 1 / mean; 0 without frames
};

/// `times` in seconds, any order; the percentile is linear between neighbours.
TimingSummary summarizeTimes(std::vector<double> times);

/// Heatmap figures of lines without scores, where there are score thresholds.
struct UnscoredHeatmap {
  std::size_t frames = 0;        ///< with such lines
  std::size_t empty_frames = 0;  ///< without any lines: these count with and without scores
  Classification counts;         ///< of all lines of both
};

struct HeatmapReport {
  std::vector<double> score_thresholds;  ///< falling; empty: all lines, one entry
  std::vector<Classification> counts;    ///< one a threshold
  std::size_t frames = 0;                ///< in `counts`
  std::size_t pending = 0;               ///< still being measured
  UnscoredHeatmap unscored;

  /// Whether lines came, but none with a score for the thresholds.
  bool lacksScores() const { return unscored.frames > 0 && frames == unscored.empty_frames; }
};

struct RepeatabilityRow {
  RepeatabilitySetting setting;
  std::size_t pairs = 0;
  std::optional<RepeatabilityFigures> figures;
};

struct RepeatabilityReport {
  MotionCounts counts;
  bool camera = false;  ///< camera_info was there; the same for depth images and poses
  bool depth = false;
  bool poses = false;
  /// Distance in time of the nearest depth image that was too far away; none: there was no such.
  std::optional<Stamp> nearest_depth_miss;
  std::vector<RepeatabilityRow> rows;  ///< of all lines, then by score threshold
  OneToOneRepeatability one_to_one;    ///< of the first frame step, as the next
  BestLocalization best_localization;
  std::size_t best_count = 0;  ///< N of the N best
  std::vector<RepeatabilityRecord> records;
};

struct PoseReport {
  PoseMethodOptions method;
  int frame_step = 0;  ///< images from the first to the second of every pair; 0: it differs
  std::vector<double> auc_thresholds;  ///< degrees
  PoseErrorMetrics errors;
  std::size_t pending = 0;  ///< still being estimated
  std::vector<PoseRecord> records;
};

/// Where one figure of the sequence lies with confidence.
struct FigureInterval {
  std::string family;
  std::string figure;       ///< its key in report.json
  std::optional<int> step;  ///< the figure's setting, as far as it has one
  std::optional<LineDistance> distance;
  std::optional<double> threshold;
  std::optional<double> score_threshold;
  ConfidenceInterval interval;
};

/// How precision and recall go together under one setting, by falling score.
struct DetectionCurve {
  VectorizedSetting setting;
  PrecisionRecallCurve points;
};

struct ReportConfidence {
  BootstrapOptions options;
  std::vector<FigureInterval> figures;
};

struct Report {
  MetricFamilies families;
  Protocol protocol = Protocol::kEvolin;
  bool complete = false;  ///< the input came to its end and nothing is pending; false: a snapshot
  int pass = 1;           ///< a jump back in time starts the next
  std::string lines_source;
  std::string ground_truth_source;
  std::string matches_source;
  std::string matches_lines_source;
  CoverageCounts coverage;
  /// Images in the input where somebody counted them; more than coverage.seen: some never arrived
  /// anywhere.
  std::optional<std::size_t> input_images;
  std::size_t detection_frames = 0;
  std::size_t detection_dropped = 0;  ///< detected lines that the protocol drops
  bool scored = false;
  std::vector<DetectionEntry> detection;
  PairCounts pairs;
  std::optional<std::size_t>
      pairs_expected;  ///< from the frames with ground truth and the frame step
  Classification association;
  DetectedPairCounts detected_pairs;
  DetectedAssociation detected_association;
  double spatial_spread = 0;  ///< mean over the frames of the detection
  HeatmapReport heatmap;
  RepeatabilityReport repeatability;
  PoseReport pose;
  TrackReport tracks;
  TimingSummary detector_timing;
  TimingSummary associator_timing;
  std::optional<RunTiming> run;                           ///< of runSequence() alone
  std::optional<ReportConfidence> confidence;             ///< addConfidence(); none: not asked for
  std::vector<DetectionCurve> curves;                     ///< addCurves(); empty without scores
  std::vector<FrameRecord> frames;                        ///< every frame seen, by stamp
  std::vector<PairRecord> pair_records;                   ///< every pair evaluated, by stamp
  std::vector<DetectedPairRecord> detected_pair_records;  ///< by stamp
  std::vector<std::string>
      notes;  ///< what the reader must know: bad ground truth, unusable messages
  /// How the figures came about: JSON texts by key ("parameters", "input", "machine"), embedded as
  /// they are.
  std::map<std::string, std::string> provenance;
};

/// Why there are no association figures; "" when there are.
std::string whyNoAssociation(const Report& report);

/// Why an entry has no average precision; "" when it has one.
std::string whyNoAveragePrecision(const Report& report, const DetectionEntry& entry);

/// Why there are no figures of association of detected lines; "" when there are.
std::string whyNoDetectedAssociation(const Report& report);
std::string whyNoHeatmap(const Report& report);
std::string whyNoRepeatability(const Report& report, const RepeatabilityRow& row);
std::string whyNoPose(const Report& report);

/// Strict JSON; what has no value is null with a `reason` beside it.
std::string toJson(const Report& report);

/// A short table for people.
std::string toMarkdown(const Report& report);

/// One row a frame, or a pair of frames.
std::string framesToCsv(const Report& report);
std::string pairsToCsv(const Report& report);

/// One row a pair of frames and setting.
std::string repeatabilityToCsv(const Report& report);
std::string posesToCsv(const Report& report);

/// Relative motion of each pair with an estimate as rows "stamp tx ty tz qx qy qz qw" (TUM's form):
/// the pose of the second camera in the first one's frame at the stamp of the second image, metres.
std::string motionsToTum(const Report& report, bool estimated);

/// report.json, summary.md and the tables and trajectories of the families asked for in `folder`
/// (made if missing), each there as a whole or not at all, report.json last. Returns the path of
/// report.json; throws Error naming the file.
std::filesystem::path writeReport(const Report& report, const std::filesystem::path& folder);

/// Removes what writeReport has made in `folder`, and the folder when nothing else is in it. What
/// cannot be removed, or is not there, is left.
void removeReport(const std::filesystem::path& folder);

}  // namespace evolin
