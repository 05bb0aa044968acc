// Scores complete frames and pairs of frames and sums them up; it knows nothing of where they come
// from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/report.h"
#include "evolin_ros/metrics/association.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin {

struct EvaluationOptions {
  VectorizedOptions vectorized;
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

  const VectorizedMetrics& detection() const { return detection_; }
  const AssociationMetrics& association() const { return association_; }

  /// Cumulative figures, the order of VectorizedMetrics::settings().
  std::vector<DetectionEntry> detectionEntries() const;

  void reset();

 private:
  EvaluationOptions options_;
  VectorizedMetrics detection_;
  AssociationMetrics association_;
};

}  // namespace evolin
