// Grey images without an allocation per frame.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/dataset/frame.h"

namespace evolin {

/// Holds the grey version of one colour image at a time.
class GreyImage {
 public:
  /// `image` itself when it is grey, else the grey of toGray() in a buffer that the next call
  /// overwrites. Rows may have gaps. Throws Error for another type or an empty image.
  const cv::Mat& of(const cv::Mat& image) {
    if (image.dims == 2 && !image.empty() && image.type() == CV_8UC3) {
      cv::cvtColor(image, converted_, cv::COLOR_BGR2GRAY);
      return converted_;
    }
    view_ = toGray(image);
    return view_;
  }

 private:
  cv::Mat converted_;
  cv::Mat view_;
};

}  // namespace evolin
