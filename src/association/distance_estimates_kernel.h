// The loops of distance_estimates.h, for files that are compiled for different processors; see
// there and in lbd_rows_kernel.h.
#pragma once

#include "distance_estimates.h"

namespace evolin {

namespace {

/// What the loops need of a processor, in terms of the compiler's own vectors.
struct FourColumns {
  using Float __attribute__((vector_size(16))) = float;
  using Int __attribute__((vector_size(16))) = std::int32_t;

  static bool any(const Int& mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }
};

template <class Vectors>
class EstimateLoops {
 public:
  /// Block by block of columns, which stay in the nearest cache while all rows pass.
  static void estimate(const EstimateRow* rows, std::size_t row_count,
                       const EstimateColumns& columns, float* estimates) {
    for (std::size_t begin = 0; begin < columns.count; begin += kVectors * kWidth) {
      std::size_t i = 0;
      for (; i + 2 < row_count; i += 3) {
        estimateBlock<3>(rows + i, columns, begin, estimates + i * columns.count);
      }
      for (; i < row_count; ++i) {
        estimateBlock<1>(rows + i, columns, begin, estimates + i * columns.count);
      }
    }
  }

  static float takeLowest(const float* estimates, std::size_t count, float* of_columns) {
    Float lowest[kVectors];
    for (Float& vector : lowest) {
      vector = Float{} + __builtin_inff();
    }
    for (std::size_t j = 0; j < count; j += kVectors * kWidth) {
      for (std::size_t i = 0; i < kVectors; ++i) {
        const Float values = load(estimates + j + i * kWidth);
        const Float before = load(of_columns + j + i * kWidth);
        const Float after = values < before ? values : before;
        __builtin_memcpy(of_columns + j + i * kWidth, &after, sizeof(after));
        lowest[i] = values < lowest[i] ? values : lowest[i];
      }
    }
    float result = __builtin_inff();
    for (const Float& vector : lowest) {
      for (std::size_t k = 0; k < kWidth; ++k) {
        result = vector[k] < result ? vector[k] : result;
      }
    }
    return result;
  }

  static std::size_t findCandidates(const float* estimates, std::size_t count, float limit,
                                    const float* limits, std::uint32_t* places) {
    std::size_t found = 0;
    for (std::size_t j = 0; j < count; j += kWidth) {
      const Float values = load(estimates + j);
      const Int near = (values <= limit) | (values <= load(limits + j));
      if (Vectors::any(near)) {
        for (std::size_t k = 0; k < kWidth; ++k) {
          if (near[k] != 0) {
            places[found++] = static_cast<std::uint32_t>(j + k);
          }
        }
      }
    }
    return found;
  }

 private:
  using Float = typename Vectors::Float;
  using Int = typename Vectors::Int;

  static constexpr std::size_t kWidth = sizeof(Float) / sizeof(float);
  /// Of three rows so many sums are under way that none waits for its last addition.
  static constexpr std::size_t kVectors = 4;
  static_assert(kEstimateColumns % (kVectors * kWidth) == 0, "whole blocks");

  static Float load(const float* values) {
    Float vector;
    __builtin_memcpy(&vector, values, sizeof(vector));
    return vector;
  }

  template <std::size_t rows>
  static void estimateBlock(const EstimateRow* row, const EstimateColumns& columns,
                            std::size_t begin, float* estimates) {
    Float products[rows][kVectors] = {};
    const float* column = columns.values +
                          begin / kEstimateColumns * kEstimateColumns * columns.size +
                          begin % kEstimateColumns;
    for (std::size_t d = 0; d < columns.size; ++d) {
      for (std::size_t i = 0; i < kVectors; ++i) {
        const Float values = load(column + i * kWidth);
        for (std::size_t r = 0; r < rows; ++r) {
          products[r][i] += row[r].values[d] * values;
        }
      }
      column += kEstimateColumns;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t i = 0; i < kVectors; ++i) {
        const Float squares = row[r].squares + load(columns.squares + begin + i * kWidth);
        const Float distances = squares - 2.0F * products[r][i];
        __builtin_memcpy(estimates + r * columns.count + begin + i * kWidth, &distances,
                         sizeof(distances));
      }
    }
  }
};

template <class Vectors>
EstimateFunctions functionsFor() {
  using Loops = EstimateLoops<Vectors>;
  return {&Loops::estimate, &Loops::takeLowest, &Loops::findCandidates};
}

}  // namespace

}  // namespace evolin
