// The loops for any processor, and the choice between them and the wide ones.
#include "line_bounds.h"

#include <opencv2/core/utility.hpp>

#include "line_bounds_kernel.h"

namespace evolin {

namespace generic {

BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space) {
  return findCandidatesWith<FourLines>(kind, lines, question, space);
}

}  // namespace generic

BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space) {
  static const bool has_wide =
      cv::checkHardwareSupport(CV_CPU_AVX2) && cv::checkHardwareSupport(CV_CPU_FMA3);
  return (has_wide ? wide::findCandidates : generic::findCandidates)(kind, lines, question, space);
}

}  // namespace evolin
