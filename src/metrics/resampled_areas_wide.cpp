// The loop for processors with AVX2: this file alone is compiled for them.
#include "resampled_areas.h"
#include "resampled_areas_kernel.h"

namespace evolin::wide {

void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses) {
  sumAreas(ranked, weights, steps, losses, misses);
}

}  // namespace evolin::wide
