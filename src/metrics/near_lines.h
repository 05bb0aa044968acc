// The few lines of a frame that may be near another line, found quickly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"
#include "line_bounds.h"

namespace evolin {

/// Which lines are wanted: those at most `reach` (finite) away under each distance asked for.
struct NearQuestion {
  bool structural = false;
  bool orthogonal = false;
  double reach = 0;
  /// Orthogonal: the mean share of each line that the other covers, at least; 0: any.
  double min_overlap = 0;
  bool nearest = false;  ///< of these, those with the smallest distance alone
};

/// Holds the lines of one frame, by length and place, in blocks of neighbours. A question passes
/// over most blocks by the boxes around them and bounds the distances of the others in single
/// precision. One thread at a time.
class NearLines {
 public:
  /// The finder is one that the processor can run.
  explicit NearLines(const LineSegments& lines, CandidateFinder finder = findCandidates);

  struct Rows {
    const std::uint32_t* first;
    const std::uint32_t* last;

    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
  };

  /// By distance; none for one that was not asked for.
  struct Answer {
    Rows structural;
    Rows orthogonal;
  };

  /// Rows of all lines that are wanted and of a few more, in any order; valid until the next call.
  Answer find(const LineSegment& query, const NearQuestion& question);

 private:
  void sortRows(const LineSegments& lines);
  void fillBlocks(const LineSegments& lines);
  Rows rowsOf(std::vector<std::uint32_t>* places, std::size_t count) const;

  CandidateFinder finder_;
  double largest_ = 0;               ///< absolute value of a coordinate
  std::vector<std::uint32_t> rows_;  ///< block by block
  std::vector<LineBlock> blocks_;
  std::vector<BoxGroup> boxes_;
  // Of the question being answered.
  std::vector<std::uint32_t> near_blocks_;
  std::vector<float> structural_bounds_;
  std::vector<float> orthogonal_bounds_;
  std::vector<std::uint32_t> structural_;
  std::vector<std::uint32_t> orthogonal_;
};

}  // namespace evolin
