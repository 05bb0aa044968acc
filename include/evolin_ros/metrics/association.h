// Association scored as a classification of index pairs (Ivanov, Ferrer, Kornilova 2023).
#pragma once

#include <cstddef>
#include <string>

#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/classification.h"

namespace evolin {

/// Pairs (i, j) of lines with equal id >= 0; throws GroundTruthError, with the frame's name, when
/// an id occurs twice in one frame.
IndexPairs pairsOfEqualIds(const LineSegments& first, const LineSegments& second,
                           const std::string& first_name = "(first of the pair)",
                           const std::string& second_name = "(second of the pair)");

IndexPairs toIndexPairs(const LineMatches& matches);

/// A predicted pair is a true positive when it is among the true ones; a repeated pair counts once
/// and its repeats are false positives. A repeat among the true ones is a miss (as in the published
/// figures, which count the rows).
Classification classifyAssociation(const IndexPairs& predicted, const IndexPairs& truth);

/// An accumulator over frame pairs: add in any order, read at any time, merge, reset.
class AssociationMetrics {
 public:
  /// Returns this pair's own counts.
  Classification addPair(const IndexPairs& predicted, const IndexPairs& truth);

  std::size_t pairs() const { return pairs_; }
  const Classification& classification() const { return sum_; }

  void merge(const AssociationMetrics& other);
  void reset();

 private:
  Classification sum_;
  std::size_t pairs_ = 0;
};

}  // namespace evolin
