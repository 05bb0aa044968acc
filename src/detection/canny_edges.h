// Edge pixels of OpenCV's Canny filter in a map with a margin, for methods that follow them.
#pragma once

#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace evolin {

/// Keeps the map of one image at a time.
class CannyEdges {
 public:
  /// `gray`: CV_8UC1, rows may have gaps; nothing around a window is looked at. Images of one row
  /// or column have no edges.
  void find(const cv::Mat& gray, double threshold1, double threshold2, int aperture) {
    prepare(gray.size());
    if (gray.cols < 2 || gray.rows < 2) {
      return;
    }
    const cv::Mat* image = &gray;
    if (gray.isSubmatrix()) {
      gray.copyTo(copy_);
      image = &copy_;
    }
    cv::Mat inner = map_(cv::Rect(1, 1, gray.cols, gray.rows));
    cv::Canny(*image, inner, threshold1, threshold2, aperture);
  }

  /// 0 or 255; row `y` is valid from -1 to the number of rows, and so are its columns.
  std::uint8_t* row(int y) { return map_.ptr<std::uint8_t>(y + 1) + 1; }

  /// From one row to the next.
  std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(map_.step[0]); }

 private:
  void prepare(cv::Size size) {
    map_.create(size.height + 2, size.width + 2, CV_8UC1);
    map_.setTo(0);
  }

  cv::Mat map_;
  cv::Mat copy_;
};

/// Calls `visit(x)` for each x in [first, last) where row[x] is not 0 when its turn comes.
template <typename Visit>
void visitEdges(const std::uint8_t* row, int first, int last, Visit visit) {
  constexpr int kAtOnce = 8;
  for (int x = first; x < last; ++x) {
    if (x + kAtOnce <= last) {
      std::uint64_t block = 0;
      std::memcpy(&block, row + x, kAtOnce);
      if (block == 0) {
        x += kAtOnce - 1;
        continue;
      }
    }
    if (row[x] != 0) {
      visit(x);
    }
  }
}

}  // namespace evolin
