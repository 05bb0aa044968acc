// Squared distances between many descriptors, in single precision: enough to tell which of them may
// be the nearest.
#pragma once

#include <cstddef>
#include <cstdint>

namespace evolin {

/// Columns of a matrix.
constexpr std::size_t kEstimateColumns = 32;

struct EstimateRow {
  const float* values;
  float squares;  ///< the sum of the values' squares
};

/// Descriptors as the columns of matrices of kEstimateColumns each, one after the other: value d of
/// the one in column j of a matrix is its `values[d * kEstimateColumns + j]`.
struct EstimateColumns {
  const float* values;
  const float* squares;  ///< as in EstimateRow; NaN gives a column estimates that compare with none
  std::size_t size;      ///< values of a descriptor
  std::size_t count;     ///< of all matrices, a multiple of kEstimateColumns
};

/// To `estimates[i * columns.count + j]` the squared distance of row i and column j, from their
/// squares and their product: it may lack what rounding takes of the squares, and be below zero.
/// Processors differ in the last bits.
void estimateDistances(const EstimateRow* rows, std::size_t row_count,
                       const EstimateColumns& columns, float* estimates);

/// The lowest of a row's estimates, infinity where none compares; lowers `of_columns` to them.
float takeLowest(const float* estimates, std::size_t count, float* of_columns);

/// To `places`, which has room for `count`, those of the estimates that are not above `limit` or
/// not above their column's; says how many.
std::size_t findCandidates(const float* estimates, std::size_t count, float limit,
                           const float* limits, std::uint32_t* places);

/// The three for one kind of processor.
struct EstimateFunctions {
  decltype(&estimateDistances) estimate;
  decltype(&takeLowest) take_lowest;
  decltype(&findCandidates) find_candidates;
};

namespace generic {
EstimateFunctions estimateFunctions();
}
/// For processors with AVX2 and FMA alone, where there are such.
namespace wide {
EstimateFunctions estimateFunctions();
}

}  // namespace evolin
