// Gaussian smoothing and Sobel or Prewitt derivatives of a grey image in one pass over its rows,
// with the arithmetic of OpenCV's 8-bit filters.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace evolin {

/// The greatest side of the smoothing window.
constexpr int kMaxSmoothingKernel = 15;

/// Weights of a Gaussian window in 1/256, from its edge to its centre (the other half mirrors it).
/// They add up to 256 over the window: what rounding takes from a weight goes to its neighbour.
/// `kernel` is odd, from 1 to kMaxSmoothingKernel; `sigma` in pixels, above 0.
std::vector<int> gaussianWeights(int kernel, double sigma);

/// Derivatives of one image, row after row without gaps.
struct GradientMaps {
  int width = 0;
  int height = 0;
  std::vector<std::int16_t> derivatives;  ///< d/dx and d/dy of each pixel, side by side; or empty
  /// 2 * (|dx| + |dy|) + (1 where |dx| >= |dy|), the edge runs rather up than sideways; the sum
  /// counts as 0 below the threshold.
  std::vector<std::uint16_t> strength;

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

enum class DerivativeFilter : std::uint8_t {
  kSobel,            ///< weights 1 2 1 along the edge
  kPrewittStrength,  ///< weights 1 1 1; leaves the maps' derivatives empty
};

/// Keeps its buffers from image to image; one thread at a time.
class SmoothedGradient {
 public:
  SmoothedGradient(int kernel, double sigma, DerivativeFilter filter = DerivativeFilter::kSobel);

  /// Smooths `gray` (CV_8UC1, any size from 1x1, rows may have gaps; pixels beyond the border
  /// mirror those within) and takes 3x3 derivatives (border pixels repeated). A sum |dx| +
  /// |dy| below `threshold` gives strength 0.
  void compute(const cv::Mat& gray, int threshold, GradientMaps* maps);

 private:
  void smoothAlongRow(const std::uint8_t* row, std::uint16_t* smoothed);
  void smoothAcrossRows(int y, int height, std::uint8_t* smoothed) const;
  void differentiate(int y, int threshold, GradientMaps* maps);
  template <DerivativeFilter kFilter>
  void differentiateBy(int y, int threshold, GradientMaps* maps);

  std::vector<int> weights_;
  DerivativeFilter filter_;
  int width_ = 0;
  std::vector<std::uint8_t> padded_;        // a row with its mirrored ends
  std::vector<std::uint16_t> along_rows_;   // the last rows, smoothed along themselves
  std::vector<std::uint8_t> smoothed_;      // the last three rows, a pixel wider on both sides
  std::vector<std::int16_t> column_sum_;    // 1 2 1 or 1 1 1 across rows
  std::vector<std::int16_t> column_slope_;  // -1 0 1 across rows
};

}  // namespace evolin
