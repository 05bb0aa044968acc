// Repeatability in which every line serves once and must agree in direction and extent (not in the
// article, where many projections may share one line and an infinite line may stand for a short
// one).
#pragma once

#include <cstddef>
#include <cstdint>

#include "evolin_ros/metrics/exact_sum.h"
#include "evolin_ros/metrics/projected_pair.h"
#include "evolin_ros/metrics/spatial_lines.h"

namespace evolin {

struct OneToOneOptions {
  double max_distance = 5;   ///< orthogonal distance without its gate, pixels of the image
  double max_angle = 5;      ///< between the directions, degrees, in (0, 90]
  double min_overlap = 0.5;  ///< mean share of each segment that the other covers, in [0, 1]
};

/// Sums over any number of pairs of frames, both directions: lines of one frame projected into the
/// other (where depth and view allow), matched with the lines there. Pairs within all gates
/// (inclusive) are taken by rising distance (ties: lower row of the projected line, then of the
/// other), each projection and each line at most once.
class OneToOneRepeatability {
 public:
  /// Throws Error naming a gate that is out of range.
  explicit OneToOneRepeatability(OneToOneOptions options = {});

  /// Returns this pair's own sums. Throws Error when the frames' protocols differ.
  OneToOneRepeatability addPair(const SpatialFrame& first, const SpatialFrame& second);
  /// Of frames all of whose lines have been projected.
  OneToOneRepeatability addPair(const ProjectedPair& projected);

  std::size_t pairs() const { return pairs_; }
  std::uint64_t visible() const { return visible_; }  ///< projections inside the other image
  std::uint64_t matched() const { return matched_; }  ///< of these

  /// Matched / visible, in [0, 1]; 0 where nothing is visible.
  double byCount() const;

  /// Length of the matched projections as far as their partners cover them / length of all visible
  /// ones, in [0, 1]; 0 where nothing is visible.
  double byLength() const;

  /// Throws Error when the gates differ.
  void merge(const OneToOneRepeatability& other);
  void reset();

 private:
  void addDirection(const ProjectedLines& projected);

  OneToOneOptions options_;
  std::size_t pairs_ = 0;
  std::uint64_t visible_ = 0;
  std::uint64_t matched_ = 0;
  ExactSum visible_length_;  ///< pixels
  ExactSum matched_length_;  ///< pixels
};

}  // namespace evolin
