// The order of scores, for the many that a sequence has.
#pragma once

#include <cstdint>
#include <vector>

namespace evolin {

/// Places of `scores`, none of them NaN, by falling score; equal ones in their order.
std::vector<std::uint32_t> placesByFallingScore(const std::vector<double>& scores);

}  // namespace evolin
