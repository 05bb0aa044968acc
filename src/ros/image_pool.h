// Memory of images that nobody holds any more, for images to come: what the system gives anew it
// gives page by page, which takes longer than copying the pixels.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace evolin::ros_shell {

/// For one thread; the images that it gave may be let go of on any.
class ImagePool {
 public:
  /// An image kept here that nobody else holds, for its memory; an empty one when there is none.
  cv::Mat take();

  /// Its memory will be given once nobody else holds it.
  void keep(const cv::Mat& image);

 private:
  std::vector<cv::Mat> images_;
};

}  // namespace evolin::ros_shell
