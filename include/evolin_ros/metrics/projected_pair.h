// Two frames with the lines of each carried into the other: what all metrics of a pair start from,
// worked out once.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/spatial_lines.h"

namespace evolin {

class NearestLineSearch;

/// Lines of one frame seen in another one. One thread at a time.
class ProjectedLines {
 public:
  /// projectLines() of the two, which must stay where they are; throws as that does.
  ProjectedLines(const SpatialFrame& from, const SpatialFrame& to, double score_threshold);
  ~ProjectedLines();
  ProjectedLines(const ProjectedLines&) = delete;
  ProjectedLines& operator=(const ProjectedLines&) = delete;

  const SpatialFrame& from() const { return from_; }
  const SpatialFrame& to() const { return to_; }
  const std::vector<LineProjection>& projections() const { return projections_; }

  /// The projections in the 128 x 128 frame, with the scores of their lines.
  const LineSegments& scaledProjections();

  /// To every projection the distance of the nearest line of to() in its image, in pixels of the
  /// 128 x 128 frame; the overlap gate of the orthogonal distance follows the protocol. Infinite
  /// where it is beyond `reach` (finite), or beyond the longest reach that was asked for earlier.
  const std::vector<double>& nearestDistances(LineDistance distance, double reach);

  /// For nearestDistances() of both distances within `reach`: quicker than one after the other.
  void searchBoth(double reach);

 private:
  struct Nearest {
    double reach = -std::numeric_limits<double>::infinity();
    std::vector<double> distances;
  };

  bool gate() const { return to_.protocol == Protocol::kEvolin; }
  NearestLineSearch& search();
  Nearest& nearestOf(LineDistance distance);

  const SpatialFrame& from_;
  const SpatialFrame& to_;
  std::vector<LineProjection> projections_;
  LineSegments scaled_;
  std::unique_ptr<NearestLineSearch> search_;  ///< once it is needed
  std::array<Nearest, 2> nearest_;             ///< by distance
};

/// Throws Error when the frames were lifted under different protocols.
struct ProjectedPair {
  /// The frames must stay where they are. Lines whose score is at most `score_threshold` are not
  /// projected (NaN: all are).
  ProjectedPair(const SpatialFrame& first, const SpatialFrame& second,
                double score_threshold = kNoScore)
      : forward(first, second, score_threshold), backward(second, first, score_threshold) {}

  ProjectedLines forward;   ///< of the first frame in the second
  ProjectedLines backward;  ///< of the second frame in the first
};

}  // namespace evolin
