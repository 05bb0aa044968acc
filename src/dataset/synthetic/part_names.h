// Which visible part of an edge is which from frame to frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evolin_ros/dataset/synthetic/visible_edges.h"

namespace evolin::synthetic {

/// Names the lines of one frame after the other: the parts of an edge are counted from 0 in the
/// order in which they are first seen. A part is the same as in an earlier frame when it overlaps
/// with what was seen of the edge then; of several candidates those with the largest overlap, as a
/// share of the edge, belong together, lines of the frame before come first, and lines that
/// were lost earlier and have nobody's part now are found again. A part that overlaps with none
/// of these is new. So when something comes between, the larger piece stays what the whole was.
class PartNames {
 public:
  explicit PartNames(std::size_t edges) : known_(edges) {}

  /// The number of each line's part among those of its edge. `lines` are the next frame's, by edge;
  /// of one edge no two overlap.
  std::vector<std::uint32_t> nextFrame(const std::vector<VisibleLine>& lines);

 private:
  struct Part {
    EdgePart reach;         ///< when it was last seen
    std::size_t frame = 0;  ///< when that was
  };

  std::vector<std::vector<Part>> known_;  ///< by edge and number
  std::size_t frame_ = 0;
};

}  // namespace evolin::synthetic
