// Leaves out the weak, the short and the surplus among the lines of one image.
#pragma once

#include <cstddef>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// The defaults keep everything.
struct LineSelection {
  /// At or below it there is no threshold; scores have no common unit, so that 0 may be any
  /// quality.
  static constexpr double kNoScoreThreshold = -1e6;

  double score_threshold = kNoScoreThreshold;  ///< kept: score > threshold; a line without a score
                                               ///< (NaN) is always kept
  double min_length = 0;                       ///< pixels; kept: length >= min_length
  std::size_t max_lines = 0;                   ///< 0: all

  bool keepsAll() const {
    return score_threshold <= kNoScoreThreshold && min_length <= 0 && max_lines == 0;
  }
};

/// The lines that pass, in their order. Of more than `max_lines` those of the highest score stay,
/// or of the greatest length where lines have no score; among equals the earlier ones.
LineSegments selectLines(LineSegments lines, const LineSelection& selection);

}  // namespace evolin
