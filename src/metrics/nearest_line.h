// Nearest line of a fixed set under the distances of geometry/distance.h, found quickly.
#pragma once

#include <cstdint>
#include <limits>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/geometry/line_segment.h"
#include "near_lines.h"

namespace evolin {

/// `distance` is infinite when no line of the set is within reach; `row` means nothing then.
struct NearestLine {
  std::uint32_t row = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// By distance.
struct NearestLines {
  NearestLine orthogonal;
  NearestLine structural;

  const NearestLine& of(LineDistance distance) const {
    return distance == LineDistance::kStructural ? structural : orthogonal;
  }
};

/// Holds the lines of one frame for any number of questions. Bounds in single precision leave a few
/// lines of which a question computes the exact distance; answers equal those of an exhaustive
/// search to the last bit. One thread at a time.
class NearestLineSearch {
 public:
  explicit NearestLineSearch(LineSegments lines);

  /// The line with the smallest distance to `query` among those at most `reach` away; the lowest
  /// row on ties. `reach` is finite; `overlap_gate` matters to the orthogonal distance alone.
  NearestLine find(LineDistance distance, const LineSegment& query, double reach,
                   bool overlap_gate);

  /// Of both distances, in little more time than of one.
  NearestLines findBoth(const LineSegment& query, double reach, bool overlap_gate);

 private:
  NearestLines findNearest(const NearQuestion& question, const LineSegment& query);

  LineSegments lines_;
  NearLines near_;
};

}  // namespace evolin
