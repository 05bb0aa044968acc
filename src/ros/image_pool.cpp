// An image that is held here alone is free.
#include "image_pool.h"

#include <algorithm>

namespace evolin::ros_shell {

namespace {

/// Whoever holds more holds all of a recording: then there is nothing to give again.
constexpr std::size_t kMostImages = 64;

bool isFree(const cv::Mat& image) {
  // An addition, as OpenCV's own counting: what others did with the pixels is over.
  return CV_XADD(&image.u->refcount, 0) == 1;
}

}  // namespace

cv::Mat ImagePool::take() {
  const auto free = std::find_if(images_.begin(), images_.end(), isFree);
  if (free == images_.end()) {
    return {};
  }
  cv::Mat image = std::move(*free);
  images_.erase(free);
  return image;
}

void ImagePool::keep(const cv::Mat& image) {
  if (image.u == nullptr) {
    return;
  }
  images_.push_back(image);
  if (images_.size() > kMostImages) {
    images_.erase(images_.begin());
  }
}

}  // namespace evolin::ros_shell
