// Repeatability of a detector and its localisation error: lines of one frame, carried through space
// into another, should be found there again (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/metrics/exact_sum.h"
#include "evolin_ros/metrics/projected_pair.h"
#include "evolin_ros/metrics/protocol.h"
#include "evolin_ros/metrics/spatial_lines.h"

namespace evolin {

struct RepeatabilityOptions {
  Protocol protocol = Protocol::kEvolin;
  std::vector<LineDistance> distances = {LineDistance::kOrthogonal, LineDistance::kStructural};
  std::vector<double> distance_thresholds = {5, 10, 15};  ///< pixels of the 128 x 128 frame
  std::vector<int> frame_steps = {10};   ///< from a pair's first frame to its second
  std::vector<double> score_thresholds;  ///< lines with score > t alone; empty: all lines
};

struct RepeatabilitySetting {
  std::optional<double> score_threshold;
  LineDistance distance = LineDistance::kStructural;
  double distance_threshold = 0;
  int frame_step = 0;
};

/// Distances of the projections that were found again to the line nearest to them.
struct Redetections {
  std::uint32_t count = 0;
  double distance_sum = 0;  ///< pixels of the 128 x 128 frame

  /// 0 when there are none.
  double meanDistance() const { return count == 0 ? 0.0 : distance_sum / count; }
};

/// What one pair of frames says under one setting.
struct PairRepeatability {
  std::uint32_t lines = 0;  ///< detected in both frames together, with depth or without
  Redetections forward;     ///< projections of the first frame's lines among the second's lines
  Redetections backward;

  /// Share of the lines that were found again, in [0, 1]; 0 without lines.
  double repeatability() const;

  /// Pixels of the 128 x 128 frame; kEvolin: mean of the two directions' means; kPaper: mean over
  /// all redetections. 0 where there are none.
  double localizationError(Protocol protocol) const;
};

struct RepeatabilityFigures {
  double repeatability = 0;
  double localization_error = 0;  ///< pixels of the 128 x 128 frame
};

/// Sums over pairs of frames, the same to the last bit in any order.
class RepeatabilitySum {
 public:
  void add(const PairRepeatability& pair, Protocol protocol);
  RepeatabilitySum& operator+=(const RepeatabilitySum& other);

  std::size_t pairs() const { return pairs_; }

  /// Repeatability is the mean over pairs; the localisation error is, under kEvolin, the mean over
  /// pairs (0 for a pair without redetections), and under kPaper that over all redetections of all
  /// pairs (0 without any). None without pairs.
  std::optional<RepeatabilityFigures> figures(Protocol protocol) const;

 private:
  std::size_t pairs_ = 0;
  std::uint64_t redetections_ = 0;
  ExactSum repeatability_;
  ExactSum localization_error_;  ///< kEvolin: of pairs; kPaper: of distances
};

/// An accumulator over pairs of frames: add in any order, read at any time, merge, reset. It keeps
/// a few sums a setting, whatever the number of pairs.
class RepeatabilityMetrics {
 public:
  /// Throws Error when there is no setting, a distance threshold is not positive and finite, a
  /// score threshold is NaN, or a frame step is below 1 or occurs twice.
  explicit RepeatabilityMetrics(RepeatabilityOptions options = {});

  const RepeatabilityOptions& options() const { return options_; }

  /// score thresholds x distances x distance thresholds x steps, score thresholds slowest and steps
  /// fastest.
  const std::vector<RepeatabilitySetting>& settings() const { return settings_; }

  /// Indices into settings() of those with `frame_step`, rising.
  std::vector<std::size_t> settingsOf(int frame_step) const;

  /// Scores a pair without adding it, one result for each of settingsOf() any step, in their order;
  /// may be called from several threads at once. Throws Error when a frame was lifted under another
  /// protocol, or when lines without scores are to be filtered.
  std::vector<PairRepeatability> measure(const SpatialFrame& first,
                                         const SpatialFrame& second) const;

  /// The same of frames whose lines have been projected, all of them.
  std::vector<PairRepeatability> measure(ProjectedPair* pair) const;

  /// Adds what measure() returned for two frames that are `frame_step` apart. Throws Error when
  /// that is none of the options' steps or the number of results is not that of its settings.
  void add(int frame_step, const std::vector<PairRepeatability>& pair);

  /// Both in one; returns the pair's own results.
  std::vector<PairRepeatability> addPair(int frame_step, const SpatialFrame& first,
                                         const SpatialFrame& second);
  std::vector<PairRepeatability> addPair(int frame_step, ProjectedPair* pair);

  /// Pairs that were added with this step.
  std::size_t pairs(int frame_step) const;

  /// None as long as there is no pair with the setting's step.
  std::optional<RepeatabilityFigures> figures(std::size_t setting) const;

  /// Throws Error when the options differ.
  void merge(const RepeatabilityMetrics& other);
  void reset();

 private:
  std::size_t stepIndex(int frame_step) const;
  void checkFrames(const SpatialFrame& first, const SpatialFrame& second) const;

  RepeatabilityOptions options_;
  std::vector<RepeatabilitySetting> settings_;
  std::vector<RepeatabilitySum> sums_;  ///< one a setting
};

}  // namespace evolin
