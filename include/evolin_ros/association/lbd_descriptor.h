// The float line band descriptor on a single scale (Zhang, Koch: An efficient and robust line
// segment matching approach based on LBD descriptor and pairwise geometric consistency, JVCIR
// 2013).
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Length of a descriptor: 9 bands, each with mean and standard deviation of four gradient sums.
constexpr int kLbdSize = 72;

/// Coordinates beyond this magnitude (pixels) have no descriptor.
constexpr float kLbdLargestCoordinate = 32767.0F;

/// One row of CV_32F a line, in the order of `lines`: N x kLbdSize. `gray` is CV_8UC1; throws Error
/// for another type or an empty image. The order of a line's endpoints matters. Parts of a support
/// region outside the image see the nearest border pixel. A line whose endpoints coincide has a row
/// of zeros; one with a coordinate that is not finite or beyond kLbdLargestCoordinate a row of NaN.
cv::Mat describeLbd(const cv::Mat& gray, const LineSegments& lines);

/// The same for image after image: the memory that it needs on the way is kept for the next one.
/// An instance serves one thread at a time.
class LbdDescriber {
 public:
  LbdDescriber();
  ~LbdDescriber();
  LbdDescriber(const LbdDescriber&) = delete;
  LbdDescriber& operator=(const LbdDescriber&) = delete;

  cv::Mat describe(const cv::Mat& gray, const LineSegments& lines);

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace evolin
