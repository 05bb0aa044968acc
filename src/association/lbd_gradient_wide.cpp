// The loops for processors with AVX2: this file alone is compiled for them.
#include "lbd_gradient.h"
#include "lbd_gradient_kernel.h"

namespace evolin::wide {

void computeLbdGradient(const LbdImageView& image, const LbdGaussian& weights,
                        std::uint16_t* scratch, std::int32_t* gradient) {
  computeGradient(image, weights, scratch, gradient);
}

}  // namespace evolin::wide
