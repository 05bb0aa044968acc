// Nearest line of a fixed set under the distances of geometry/distance.h, found quickly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// `distance` is infinite when no line of the set is within reach; `row` means nothing then.
struct NearestLine {
  std::uint32_t row = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// Holds the lines of one frame for any number of questions. Every question first computes a lower
/// bound (or an estimate) of all distances in single precision, in one loop over flat arrays that
/// compilers turn into vector instructions, and then the exact distance of the few candidates left;
/// answers equal those of an exhaustive search to the last bit. One thread at a time.
class NearestLineSearch {
 public:
  explicit NearestLineSearch(const LineSegments& lines);

  /// The line with the smallest distance to `query` among those at most `reach` away; the lowest
  /// row on ties. `reach` is finite; `overlap_gate` matters to the orthogonal distance alone.
  NearestLine find(LineDistance distance, const LineSegment& query, double reach,
                   bool overlap_gate);

 private:
  void boundStructural(const LineSegment& query);
  void boundOrthogonal(const LineSegment& query);

  LineSegments lines_;
  double largest_ = 0;  ///< absolute value of a coordinate
  std::vector<float> x1_, y1_, x2_, y2_;
  std::vector<float> sum_x_, sum_y_;                 ///< endpoints added up
  std::vector<float> normal_x_, normal_y_, offset_;  ///< unit normal . p + offset = 0
  std::vector<float> bounds_;                        ///< of the question being answered
  std::vector<std::uint32_t> candidates_;            ///< rows whose bound is within reach
};

}  // namespace evolin
