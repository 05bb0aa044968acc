// Squared distances of one descriptor from many, in single precision: enough to tell which of them
// may be the nearest.
#pragma once

#include <cstddef>

namespace evolin {

/// What the number of columns is a multiple of.
constexpr std::size_t kEstimateColumns = 64;

/// To `estimates[j]` the sum over d < size of (row[d] - columns[d * count + j])^2; `count` is a
/// multiple of kEstimateColumns. Processors differ in the last bits.
void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates);

namespace generic {
void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates);
}
/// For processors with AVX2 and FMA alone, where there are such.
namespace wide {
void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates);
}

}  // namespace evolin
