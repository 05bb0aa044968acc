// Joins the regions of LSDNet that were grown in the four quarters of the image.
#pragma once

#include <array>

#include "lsdnet_regions.h"

namespace evolin::lsdnet {

/// Regions of the quarters upper left, upper right, lower left, lower right (half-open at
/// rows / 2 and columns / 2), joined across the borders as the authors do, in their order. Pixels
/// may occur in more than one of the results, which is the authors' behaviour, too.
Regions stitchQuarters(std::array<Regions, 4> quarters, int rows, int columns);

}  // namespace evolin::lsdnet
