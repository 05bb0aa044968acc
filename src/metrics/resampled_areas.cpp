// The loop for any processor, and the choice between it and the wide one.
#include "resampled_areas.h"

#include <opencv2/core/utility.hpp>

#include "resampled_areas_kernel.h"

namespace evolin {

namespace generic {

void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas) {
  sumAreas<TwoSettings>(entries, count, shift, weights, steps, areas);
}

}  // namespace generic

void resampleAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
                   const FrameWeight* weights, const double* steps, ResampledAreas* areas) {
  static const bool has_wide = cv::checkHardwareSupport(CV_CPU_AVX2);
  (has_wide ? wide::resampleAreas : generic::resampleAreas)(entries, count, shift, weights, steps,
                                                            areas);
}

}  // namespace evolin
