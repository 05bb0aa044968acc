// The loops for any processor, and the choice between them and the wider ones.
#include "lbd_rows.h"

#include <opencv2/core/utility.hpp>

#include "lbd_rows_kernel.h"

namespace evolin {

namespace generic {

void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums) {
  clamped ? LbdLoops<FourFloats>::sum<true>(gradient, support, sums)
          : LbdLoops<FourFloats>::sum<false>(gradient, support, sums);
}

}  // namespace generic

void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums) {
  static const auto best = cv::checkHardwareSupport(CV_CPU_AVX512_SKX) ? widest::sumLbdRows
                           : cv::checkHardwareSupport(CV_CPU_AVX2)     ? wide::sumLbdRows
                                                                       : generic::sumLbdRows;
  best(gradient, support, clamped, sums);
}

}  // namespace evolin
