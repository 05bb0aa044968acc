// The loop for processors with AVX2 and FMA: this file alone is compiled for them.
#include "distance_estimates.h"
#include "distance_estimates_kernel.h"

namespace evolin::wide {

void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates) {
  estimate<EightColumns>(row, columns, size, count, estimates);
}

}  // namespace evolin::wide
