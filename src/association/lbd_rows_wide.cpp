// The loops for processors with AVX2: this file alone is compiled for them.
#include "lbd_rows.h"
#include "lbd_rows_kernel.h"

namespace evolin::wide {

void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums) {
  clamped ? LbdLoops<EightFloats>::sum<true>(gradient, support, sums)
          : LbdLoops<EightFloats>::sum<false>(gradient, support, sums);
}

}  // namespace evolin::wide
