// The loop of estimateDistances(), for files that are compiled for different processors; see there
// and in lbd_rows_kernel.h.
#pragma once

#include "distance_estimates.h"

namespace evolin {

namespace {

struct FourColumns {
  using Float __attribute__((vector_size(16))) = float;
};
struct EightColumns {
  using Float __attribute__((vector_size(32))) = float;
};

template <class Vectors>
void estimate(const float* row, const float* columns, std::size_t size, std::size_t count,
              float* estimates) {
  using Float = typename Vectors::Float;
  constexpr std::size_t kWidth = sizeof(Float) / sizeof(float);
  // So many sums are under way that none waits for its last addition.
  constexpr std::size_t kVectors = 8;
  static_assert(kEstimateColumns % (kVectors * kWidth) == 0, "whole blocks");
  for (std::size_t begin = 0; begin < count; begin += kVectors * kWidth) {
    Float sums[kVectors] = {};
    for (std::size_t d = 0; d < size; ++d) {
      const float* const column = columns + d * count + begin;
      for (std::size_t i = 0; i < kVectors; ++i) {
        Float values;
        __builtin_memcpy(&values, column + i * kWidth, sizeof(values));
        const Float difference = row[d] - values;
        sums[i] += difference * difference;
      }
    }
    __builtin_memcpy(estimates + begin, sums, sizeof(sums));
  }
}

}  // namespace

}  // namespace evolin
