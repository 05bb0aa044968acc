// The image gradient that LBD sums: derivatives of the smoothed image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evolin {

/// Rows of grey values, `stride` bytes apart.
struct LbdImageView {
  const std::uint8_t* pixels;
  std::size_t stride;
  int width;
  int height;
};

/// In 256ths. Variables, as compilers take many more instructions for constants' shifts and sums
/// than for products of words.
struct LbdGaussian {
  std::uint16_t outer;
  std::uint16_t inner;
  std::uint16_t middle;
};

/// Of sigma 1, rounded so that their sum is 1.
constexpr LbdGaussian kLbdGaussian = {14, 62, 104};

/// Computes gradients one after the other and keeps its memory for the next one.
class LbdGradient {
 public:
  /// Sobel's 3x3 derivatives of the image under a 5x5 Gaussian of sigma 1, in whole grey levels.
  /// Pixels beyond the border are as the nearest ones. Both derivatives of a pixel are in one word,
  /// dx in the lower half and dy in the upper, row after row; valid until the next call. The same
  /// to the last bit whatever the processor.
  const std::int32_t* compute(const LbdImageView& image);

 private:
  std::vector<std::uint16_t> rows_;
  std::vector<std::int32_t> gradient_;
};

/// What LbdGradient::compute() needs beside the result: so many values for every row's width.
std::size_t lbdGradientScratch(int width);

namespace generic {
void computeLbdGradient(const LbdImageView& image, const LbdGaussian& weights,
                        std::uint16_t* scratch, std::int32_t* gradient);
}
/// For processors with AVX2 alone, where there are such.
namespace wide {
void computeLbdGradient(const LbdImageView& image, const LbdGaussian& weights,
                        std::uint16_t* scratch, std::int32_t* gradient);
}

}  // namespace evolin
