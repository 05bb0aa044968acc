// Detection scored on pixels: precision, recall and F-score of drawn lines, and their average
// precision over score thresholds (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/classification.h"
#include "evolin_ros/metrics/score_ranking.h"

namespace evolin {

struct HeatmapOptions {
  /// In any order; a threshold t stands for the lines with score > t. Empty: one setting with all
  /// lines, and scores do not matter.
  std::vector<double> score_thresholds;
  /// Seconds by the steady clock that one frame may take; a frame that takes longer is refused.
  double frame_budget = std::numeric_limits<double>::infinity();
  /// A frame is broken off once this is true; it outlives the metrics. None: nothing stops a frame.
  const std::atomic<bool>* stop = nullptr;
};

/// What became of a frame.
enum class HeatmapOutcome {
  kAdded,
  kOverBudget,  ///< broken off after HeatmapOptions::frame_budget; nothing was added
  kStopped,     ///< broken off for HeatmapOptions::stop; nothing was added
};

/// What a precision-recall curve over score thresholds boils down to.
struct HeatmapSummary {
  double average_precision = 0;  ///< AP^H: trapezoid rule over the curve's points alone
  double max_f_score = 0;        ///< F^H
};

/// The curve through counts by falling score threshold.
PrecisionRecallCurve heatmapCurve(const std::vector<Classification>& counts);

/// Of counts by falling score threshold; 0 where there is nothing to sum up.
HeatmapSummary summarizeHeatmap(const std::vector<Classification>& counts);

/// An accumulator over frames: add frames in any order, read at any time, merge, reset. It keeps
/// numbers of pixels, 8 bytes a frame and setting and a few a frame, never lines or images. The
/// protocols agree on this family.
class HeatmapMetrics {
 public:
  /// Throws Error when a threshold is NaN or the budget is not positive.
  explicit HeatmapMetrics(HeatmapOptions options = {});

  /// By falling threshold, the order of every per-setting figure below; empty without thresholds.
  const std::vector<double>& scoreThresholds() const { return thresholds_; }

  /// One a threshold; 1 without thresholds.
  std::size_t settings() const { return sums_.size(); }

  /// Draws the lines at the resolution of the image and matches their pixels: some milliseconds for
  /// a hundred lines, about a hundred for hundreds of lines with many thresholds, and several times
  /// that for the rare frame that needs the slow exact solver (see frame_budget). `frame_number`
  /// must be unique; `frame_name` serves messages. Lines in pixels; endpoints outside the image are
  /// clamped to it. A frame over budget is refused, to be counted as skipped. Throws
  /// GroundTruthError for a ground-truth line that is not finite, and Error for a prediction that
  /// is not finite or, where there are thresholds, has no score, for an image without size or with
  /// a diagonal above 25500 pixels, or a frame number that was there before; nothing is added then.
  HeatmapOutcome addFrame(std::uint32_t frame_number, const std::string& frame_name, ImageSize size,
                          const LineSegments& predicted, const LineSegments& ground_truth);

  std::size_t frames() const { return frames_.size(); }

  /// Numbers of pixels over all frames.
  const Classification& classification(std::size_t setting = 0) const { return sums_.at(setting); }

  /// All settings by falling threshold.
  const std::vector<Classification>& classifications() const { return sums_; }

  /// The same frame by frame, by rising frame number.
  std::vector<Classification> frameClassifications(std::size_t setting = 0) const;

  /// One point a threshold, by falling threshold; empty without thresholds.
  PrecisionRecallCurve curve() const;

  /// Zeros without thresholds.
  HeatmapSummary summary() const;

  /// Adds everything that `other` holds, with its frame numbers; identical in any order. Budgets
  /// may differ. Throws
  /// Error when thresholds differ or a frame number occurs in both; nothing is added then.
  void merge(const HeatmapMetrics& other);

  /// Forgets all frames, keeps the options.
  void reset();

 private:
  struct PixelCounts {
    std::uint32_t true_positives;
    std::uint32_t predicted;
  };
  struct Frame {
    std::uint32_t number;
    std::uint32_t ground_truth;
    std::vector<PixelCounts> counts;  ///< by setting
  };

  static Classification classificationOf(const Frame& frame, std::size_t setting);
  Frame measure(std::uint32_t frame_number, const std::string& frame_name, ImageSize size,
                const LineSegments& predicted, const LineSegments& ground_truth) const;
  void addToSums(const Frame& frame);

  /// Keeps the order by number; throws Error when a number occurs in both.
  void mergeFrames(const std::vector<Frame>& others);

  std::vector<double> thresholds_;
  double frame_budget_;
  const std::atomic<bool>* stop_;
  std::vector<Frame> frames_;  ///< by rising number
  std::vector<Classification> sums_;
};

}  // namespace evolin
