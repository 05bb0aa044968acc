// The loops for any processor, and the choice between them and the wide ones.
#include "lbd_gradient.h"

#include <opencv2/core/utility.hpp>

#include "lbd_gradient_kernel.h"

namespace evolin {

namespace generic {

void computeLbdGradient(const LbdImageView& image, const LbdGaussian& weights,
                        std::uint16_t* scratch, std::int32_t* gradient) {
  computeGradient(image, weights, scratch, gradient);
}

}  // namespace generic

std::size_t lbdGradientScratch(int width) {
  return static_cast<std::size_t>(GradientRows::kCount) *
         static_cast<std::size_t>(width + 2 * kReach);
}

const std::int32_t* LbdGradient::compute(const LbdImageView& image) {
  rows_.resize(lbdGradientScratch(image.width));
  gradient_.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  static const bool has_wide = cv::checkHardwareSupport(CV_CPU_AVX2);
  (has_wide ? wide::computeLbdGradient : generic::computeLbdGradient)(
      image, kLbdGaussian, rows_.data(), gradient_.data());
  return gradient_.data();
}

}  // namespace evolin
