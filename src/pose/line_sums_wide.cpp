// The loops for processors with AVX2: this file alone is compiled for them.
#include "line_sums.h"
#include "line_sums_kernel.h"

namespace evolin::wide {

void lineSums(const LineTableView& table, const LineMotion& motion, double delta,
              bool with_equations, LineSums* sums) {
  with_equations ? LineLoops<FourWide>::sum<true>(table, motion, delta, sums)
                 : LineLoops<FourWide>::sum<false>(table, motion, delta, sums);
}

}  // namespace evolin::wide
