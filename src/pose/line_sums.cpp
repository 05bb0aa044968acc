// The loops for any processor, and the choice between them and the wide ones.
#include "line_sums.h"

#include <opencv2/core/utility.hpp>

#include "line_sums_kernel.h"

namespace evolin {

namespace generic {

void lineSums(const LineTableView& table, const LineMotion& motion, double delta,
              bool with_equations, LineSums* sums) {
  with_equations ? LineLoops<TwoWide>::sum<true>(table, motion, delta, sums)
                 : LineLoops<TwoWide>::sum<false>(table, motion, delta, sums);
}

}  // namespace generic

void lineSums(const LineTableView& table, const LineMotion& motion, double delta,
              bool with_equations, LineSums* sums) {
  static const bool has_wide = cv::checkHardwareSupport(CV_CPU_AVX2);
  (has_wide ? wide::lineSums : generic::lineSums)(table, motion, delta, with_equations, sums);
}

}  // namespace evolin
