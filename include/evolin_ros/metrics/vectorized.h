// Detection scored on segments as vectors: precision, recall, F-score and average precision
// (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/classification.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/score_ranking.h"

namespace evolin {

/// One distance with one threshold, in pixels of the 128 x 128 image that lines are scaled to.
struct VectorizedSetting {
  LineDistance distance = LineDistance::kStructural;
  double threshold = 0;
};

struct VectorizedOptions {
  Protocol protocol = Protocol::kEvolin;
  std::vector<LineDistance> distances = {LineDistance::kOrthogonal, LineDistance::kStructural};
  std::vector<double> distance_thresholds = {5, 10, 15};
};

/// An accumulator over frames: add frames in any order, read at any time, merge, reset. It keeps 16
/// bytes a prediction and a few a frame, never lines or images.
class VectorizedMetrics {
 public:
  static constexpr std::size_t kMaxSettings = 32;

  /// Throws Error when there are no settings, more than kMaxSettings, or a threshold that is not
  /// positive and finite.
  explicit VectorizedMetrics(VectorizedOptions options = {});

  /// distances x thresholds, distance slowest: the order of every per-setting figure below.
  const std::vector<VectorizedSetting>& settings() const { return settings_; }
  const VectorizedOptions& options() const { return options_; }

  /// `frame_number` fixes the order of equal scores and must be unique; `frame_name` serves
  /// messages. Lines in pixels of an image of `size`. `scored` says whether `predicted` carries
  /// scores; a frame without predictions may say either. Throws GroundTruthError for a ground-truth
  /// line that is not finite, has no length, or leaves the image (half a pixel beyond the centres
  /// of the first row and column, beyond 128 after scaling), and Error for a prediction that is not
  /// finite, a scored frame with a NaN score, a scored frame among unscored ones, an image without
  /// size, or a frame number that was there before; nothing is added then.
  void addFrame(std::uint32_t frame_number, const std::string& frame_name, ImageSize size,
                const LineSegments& predicted, const LineSegments& ground_truth, bool scored);

  /// Frames numbered `number` and above move up by one, so that a frame that came late can be added
  /// in its place.
  void makeRoom(std::uint32_t number);

  std::size_t frames() const { return frames_.size(); }

  /// Predictions that the protocol drops, over all frames; they are in no other figure.
  std::size_t dropped() const { return dropped_; }

  /// False as long as only frames without predictions have been added.
  bool scored() const { return scored_.value_or(false); }

  /// Counts over all frames, or over the predictions with score > `score_threshold` (a filter takes
  /// away no true positive but those it drops: a better prediction survives every filter that a
  /// worse one survives). Throws Error when there are only predictions without scores to filter.
  Classification classification(
      std::size_t setting, double score_threshold = -std::numeric_limits<double>::infinity()) const;

  /// The same counts frame by frame, by rising frame number.
  std::vector<Classification> frameClassifications(
      std::size_t setting, double score_threshold = -std::numeric_limits<double>::infinity()) const;

  /// Empty when there are no scores, no predictions or no ground truth. Each call sorts all
  /// predictions: for more than one setting take averagePrecisions(), or ranking() and ask that.
  std::optional<double> averagePrecision(std::size_t setting) const;
  std::vector<std::optional<double>> averagePrecisions() const;
  PrecisionRecallCurve curve(std::size_t setting) const;

  /// Predictions by falling score, then frame number, then row; frames by rising number. Without
  /// scores it has frames but no predictions.
  ScoreRanking ranking() const;

  /// Adds everything that `other` holds, with its frame numbers; identical in any order. Throws
  /// Error when options differ, a frame number occurs in both, or one is scored and the other is
  /// not.
  void merge(const VectorizedMetrics& other);

  /// Forgets all frames, keeps the options.
  void reset();

 private:
  /// Bit k of `hits`: a true positive under setting k.
  struct Prediction {
    double score;
    std::uint32_t frame;
    std::uint32_t hits;
  };
  struct FrameCount {
    std::uint32_t number;
    std::uint32_t ground_truth;
  };

  void checkFilter(double score_threshold) const;
  std::vector<FrameCount>::const_iterator findFrame(std::uint32_t number) const;

  /// Keeps the order by number; throws Error when a number occurs in both.
  void mergeFrames(const std::vector<FrameCount>& others);

  VectorizedOptions options_;
  std::vector<VectorizedSetting> settings_;
  std::vector<Prediction> predictions_;  ///< a frame's in a row, by row; frames in order of arrival
  std::vector<FrameCount> frames_;       ///< by rising number
  std::optional<bool> scored_;
  std::size_t dropped_ = 0;
};

}  // namespace evolin
