// The loop for any processor, and the choice between it and the wide one.
#include "distance_estimates.h"

#include <opencv2/core/utility.hpp>

#include "distance_estimates_kernel.h"

namespace evolin {

namespace generic {

void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates) {
  estimate<FourColumns>(row, columns, size, count, estimates);
}

}  // namespace generic

void estimateDistances(const float* row, const float* columns, std::size_t size, std::size_t count,
                       float* estimates) {
  static const bool has_wide =
      cv::checkHardwareSupport(CV_CPU_AVX2) && cv::checkHardwareSupport(CV_CPU_FMA3);
  (has_wide ? wide::estimateDistances : generic::estimateDistances)(row, columns, size, count,
                                                                    estimates);
}

}  // namespace evolin
