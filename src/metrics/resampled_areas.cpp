// The loop for any processor, and the choice between it and the wider ones.
#include "resampled_areas.h"

#include <opencv2/core/utility.hpp>

#include "resampled_areas_kernel.h"

namespace evolin {

namespace generic {

void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses) {
  sumAreas(ranked, weights, steps, losses, misses);
}

}  // namespace generic

void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses) {
  static const auto best = cv::checkHardwareSupport(CV_CPU_AVX512_SKX) ? widest::resampleAreas
                           : cv::checkHardwareSupport(CV_CPU_AVX2)     ? wide::resampleAreas
                                                                       : generic::resampleAreas;
  best(ranked, weights, steps, losses, misses);
}

}  // namespace evolin
