// The loops for processors with AVX-512: this file alone is compiled for them.
#include "line_sums.h"
#include "line_sums_kernel.h"

namespace evolin::widest {

void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums) {
  LineLoops<FourWide>::sum(table, motion, delta, sums);
}

}  // namespace evolin::widest
