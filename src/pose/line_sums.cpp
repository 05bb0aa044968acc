// The loops for any processor, and the choice between them and those for some.
#include "line_sums.h"

#include <opencv2/core/utility.hpp>

#include "line_sums_kernel.h"

namespace evolin {

namespace generic {

void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums) {
  LineLoops<TwoWide>::sum(table, motion, delta, sums);
}

}  // namespace generic

namespace {

auto bestLoops() {
  if (cv::checkHardwareSupport(CV_CPU_AVX512_SKX)) {
    return &widest::lineSums;
  }
  return cv::checkHardwareSupport(CV_CPU_AVX2) ? &wide::lineSums : &generic::lineSums;
}

}  // namespace

void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums) {
  static const auto loops = bestLoops();
  loops(table, motion, delta, sums);
}

}  // namespace evolin
