// The cheapest matching of pixels, found step by step: slow, and right for every input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "evolin_ros/base/deadline.h"
#include "pixel_grid.h"

namespace evolin {

/// Entry k: number of pairs of the cheapest matching of ground-truth cells with the cells of levels
/// 0 to k, a pair at its distance + 1e-6 and an unmatched ground-truth cell at `free_cost`. Throws
/// DeadlineError.
std::vector<std::size_t> countCheapest(const PixelGrid& grid, const IndexedCells& ground_truth,
                                       const std::vector<std::vector<Cell>>& added,
                                       double free_cost, const Deadline& deadline);

}  // namespace evolin
