// Edge pixels of the Canny filter in a map with a margin, for methods that follow them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "smoothed_gradient.h"

namespace evolin {

/// Keeps the map of one image at a time, and its memory.
class CannyEdges {
 public:
  /// The pixels that cv::Canny finds on the smoothed image with an aperture of 3 and the L1 norm:
  /// more than `low` (at least 0), and connected to such of more than `high` (in either order),
  /// rounded down. The maps have derivatives, and strength from leastStrength() on at the latest.
  void find(const GradientMaps& maps, double low, double high);

  /// As cv::Canny finds them, with an aperture of 3, 5 or 7 (and allocates). `gray`: CV_8UC1, rows
  /// may have gaps; nothing around a window is looked at.
  void findByOpenCv(const cv::Mat& gray, double low, double high, int aperture);

  /// The least |dx| + |dy| of an edge pixel.
  static int leastStrength(double low, double high) {
    return static_cast<int>(std::floor(std::min({low, high, kMostStrength}))) + 1;
  }

  int width() const { return width_; }
  int height() const { return height_; }

  /// 0 or kEdge; valid for rows from -1 to height() and columns from -1 to width().
  std::uint8_t* row(int y) { return map_.data() + (y + 1) * stride() + 1; }

  /// From one row to the next.
  std::ptrdiff_t stride() const { return width_ + 2; }

  static constexpr std::uint8_t kEdge = 255;

 private:
  // Greater sums do not occur.
  static constexpr double kMostStrength = 4 * 2 * 255;

  void prepare(int width, int height);
  void suppress(const GradientMaps& maps, int y, int low, int high);
  void spread();

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> map_;
  std::vector<std::uint8_t*> weak_;    // may be edges
  std::vector<std::uint8_t*> strong_;  // edges whose neighbours are to be looked at
  cv::Mat copy_;
};

}  // namespace evolin
