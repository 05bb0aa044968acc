// The loop for processors with AVX2: this file alone is compiled for them.
#include "resampled_areas.h"
#include "resampled_areas_kernel.h"

namespace evolin::wide {

void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas) {
  sumAreas<FourSettings>(entries, count, shift, weights, steps, areas);
}

}  // namespace evolin::wide
