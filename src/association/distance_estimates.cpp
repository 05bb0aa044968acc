// The loops for any processor, and the choice between them and the wide ones.
#include "distance_estimates.h"

#include <opencv2/core/utility.hpp>

#include "distance_estimates_kernel.h"

namespace evolin {

namespace generic {

EstimateFunctions estimateFunctions() { return functionsFor<FourColumns>(); }

}  // namespace generic

namespace {

const EstimateFunctions& best() {
  static const EstimateFunctions functions =
      cv::checkHardwareSupport(CV_CPU_AVX2) && cv::checkHardwareSupport(CV_CPU_FMA3)
          ? wide::estimateFunctions()
          : generic::estimateFunctions();
  return functions;
}

}  // namespace

void estimateDistances(const EstimateRow* rows, std::size_t row_count,
                       const EstimateColumns& columns, float* estimates) {
  best().estimate(rows, row_count, columns, estimates);
}

float takeLowest(const float* estimates, std::size_t count, float* of_columns) {
  return best().take_lowest(estimates, count, of_columns);
}

std::size_t findCandidates(const float* estimates, std::size_t count, float limit,
                           const float* limits, std::uint32_t* places) {
  return best().find_candidates(estimates, count, limit, limits, places);
}

}  // namespace evolin
