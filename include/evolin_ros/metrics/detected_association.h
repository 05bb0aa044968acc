// Association of detected lines, judged by the ground-truth lines nearest to them (family
// `association_detected`; not in the article, whose association is of ground-truth lines).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Largest structural distance, in pixels of the 128 x 128 frame, of a detected line from the
/// ground-truth line that it stands for (inclusive).
constexpr double kDefaultCarryOverGate = 5;

/// For every detected line the id of the ground-truth line nearest to it (structural distance after
/// scaling both to 128 x 128; nothing is clamped or dropped; lowest row on ties), or kNoId where
/// none is within `gate` or the nearest has no id (< 0). Several detected lines may get the same
/// id, as a long line is often found in pieces; an id may also occur on several ground-truth lines.
/// Lines in pixels of an image of `size`. Throws GroundTruthError for a ground-truth line that is
/// not finite, Error for such a detected line, an image without size, or a gate that is not
/// positive and finite.
std::vector<std::int64_t> carryOverIds(const std::string& frame_name, ImageSize size,
                                       const LineSegments& detected,
                                       const LineSegments& ground_truth,
                                       double gate = kDefaultCarryOverGate);

/// Sums over any number of pairs of frames. A predicted pair (i, j) is true when both lines carry
/// an id and it is the same one; of a repeated pair one counts, its repeats are false. A physical
/// line is visible when detected lines of both frames carry its id, and joined when a predicted
/// pair of such lines exists; visible ones that are not joined are missed. Precision counts pairs
/// and recall counts physical lines, so that a line found in pieces is not worth more than another.
struct DetectedAssociation {
  std::uint64_t true_pairs = 0;
  std::uint64_t predicted_pairs = 0;
  std::uint64_t pairs_without_truth = 0;  ///< predicted; at least one line carries no id (false)
  std::uint64_t joined_lines = 0;         ///< physical lines
  std::uint64_t visible_lines = 0;        ///< physical lines

  /// In [0, 1]; 0 where undefined.
  double precision() const;  ///< true pairs / predicted pairs
  double recall() const;     ///< joined lines / visible lines
  double fScore() const;     ///< harmonic mean of both

  DetectedAssociation& operator+=(const DetectedAssociation& other);
};

/// One pair of frames; `first_ids` and `second_ids` as carryOverIds() gives them. Throws Error
/// naming the pair for an index that is no row of its frame.
DetectedAssociation classifyDetectedAssociation(const IndexPairs& predicted,
                                                const std::vector<std::int64_t>& first_ids,
                                                const std::vector<std::int64_t>& second_ids);

/// An accumulator over pairs of frames: add in any order, read at any time, merge, reset.
class DetectedAssociationMetrics {
 public:
  /// Returns this pair's own counts; throws as classifyDetectedAssociation(), and adds nothing
  /// then.
  DetectedAssociation addPair(const IndexPairs& predicted,
                              const std::vector<std::int64_t>& first_ids,
                              const std::vector<std::int64_t>& second_ids);

  std::size_t pairs() const { return pairs_; }
  const DetectedAssociation& classification() const { return sum_; }

  void merge(const DetectedAssociationMetrics& other);
  void reset();

 private:
  DetectedAssociation sum_;
  std::size_t pairs_ = 0;
};

}  // namespace evolin
