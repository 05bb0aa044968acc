// A proof that a matching of most pairs has the number of pairs that the cheapest matching has.
#pragma once

#include <cstdint>
#include <vector>

#include "evolin_ros/base/deadline.h"
#include "nested_matching.h"
#include "pixel_grid.h"

namespace evolin {

/// Numbers of matched ground-truth pixels for which there is no proof, at least one of every
/// connected part of the graph (matched predicted pixels, all ground-truth pixels within reach)
/// that lacks it. An empty answer proves that at every level the cheapest matching, with unmatched
/// ground-truth pixels at `free_cost` each, has as many pairs as `matching`. Throws DeadlineError.
std::vector<std::uint32_t> findUnproven(const PixelGrid& grid, const IndexedCells& ground_truth,
                                        const std::vector<std::vector<Cell>>& added,
                                        const NestedMatching& matching, double free_cost,
                                        const Deadline& deadline);

}  // namespace evolin
