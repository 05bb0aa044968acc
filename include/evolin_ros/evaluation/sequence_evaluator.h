// Scores complete frames and pairs of frames and sums them up; it knows nothing of where they come
// from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/report.h"
#include "evolin_ros/metrics/association.h"
#include "evolin_ros/metrics/detected_association.h"
#include "evolin_ros/metrics/heatmap.h"
#include "evolin_ros/metrics/pose_error.h"
#include "evolin_ros/metrics/spatial_spread.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

struct EvaluationOptions {
  VectorizedOptions vectorized;
  HeatmapOptions heatmap;
  PoseErrorOptions pose_errors;
  double carry_over_gate = kDefaultCarryOverGate;  ///< pixels of the 128 x 128 frame
};

/// One instance a pass over one sequence; not safe for several threads at once.
class SequenceEvaluator {
 public:
  explicit SequenceEvaluator(EvaluationOptions options = {});

  const EvaluationOptions& options() const { return options_; }

  /// Scores the detection of one frame. `number` is the frame's place in the sequence (unique; it
  /// fixes the order of equal scores), so that frames may be added in any order. Throws
  /// GroundTruthError, or Error when the two sets are of different image size, have no size, or
  /// hold a prediction that the metric refuses; nothing is added then.
  FrameRecord addFrame(std::uint32_t number, const LineSet& lines, const LineSet& ground_truth);

  /// Frames numbered `number` and above move up by one, so that a frame that came late can be added
  /// in its place.
  void makeRoom(std::uint32_t number) { detection_.makeRoom(number); }

  /// Scores matches between ground-truth lines. Throws Error when an index is beyond the lines of
  /// its frame, GroundTruthError when an id occurs twice in a frame; nothing is added then.
  PairRecord addPair(const MatchSet& matches, const LineSegments& first,
                     const LineSegments& second);

  /// Ids of ground-truth lines for detected ones, see carryOverIds(); throws as it does.
  std::vector<std::int64_t> carriedIds(const LineSet& lines, const LineSet& ground_truth) const;

  /// Scores matches between detected lines by the ids that they carry. Throws Error when an index
  /// is beyond the lines of its frame; nothing is added then.
  DetectedPairRecord addDetectedPair(const MatchSet& matches,
                                     const std::vector<std::int64_t>& first_ids,
                                     const std::vector<std::int64_t>& second_ids);

  /// What tasks found out.
  void addHeatmap(const HeatmapRecord& record);
  void addPose(const PoseRecord& record) { pose_.addPair(record.pair); }

  const VectorizedMetrics& detection() const { return detection_; }
  const AssociationMetrics& association() const { return association_; }

  const DetectedAssociationMetrics& detectedAssociation() const { return detected_association_; }
  const SpatialSpread& spread() const { return spread_; }
  const PoseErrorMetrics& pose() const { return pose_; }

  /// By falling score threshold; one without thresholds.
  const std::vector<Classification>& heatmap() const { return heatmap_; }
  std::size_t heatmapFrames() const { return heatmap_frames_; }
  /// Frames whose lines have no scores although there are thresholds: not in the figures above.
  const UnscoredHeatmap& unscoredHeatmap() const { return unscored_heatmap_; }
  const std::vector<double>& heatmapThresholds() const { return heatmap_thresholds_; }

  /// Cumulative figures, the order of VectorizedMetrics::settings().
  std::vector<DetectionEntry> detectionEntries() const;

 private:
  EvaluationOptions options_;
  VectorizedMetrics detection_;
  AssociationMetrics association_;
  DetectedAssociationMetrics detected_association_;
  SpatialSpread spread_;
  PoseErrorMetrics pose_;
  std::vector<double> heatmap_thresholds_;
  std::vector<Classification> heatmap_;
  std::size_t heatmap_frames_ = 0;
  UnscoredHeatmap unscored_heatmap_;
};

}  // namespace evolin
