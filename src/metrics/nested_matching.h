// Matchings of most pairs between ground-truth pixels and ever larger sets of predicted pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "evolin_ros/base/deadline.h"
#include "pixel_grid.h"

namespace evolin {

/// A matching of most pairs that grows by levels. The predicted pixels that it matches after level
/// k, all of levels 0 to k, stay matched in every later level (their partners may change).
struct NestedMatching {
  std::vector<Cell> predicted;          ///< matched, by level
  std::vector<std::uint32_t> partners;  ///< number of the ground-truth pixel of each, at the end
  std::vector<std::size_t> sizes;       ///< entry k: number of pairs after level k
};

/// No cell is in two levels, nor twice in one. Throws DeadlineError.
NestedMatching matchNested(const PixelGrid& grid, const IndexedCells& ground_truth,
                           const std::vector<std::vector<Cell>>& added, const Deadline& deadline);

}  // namespace evolin
