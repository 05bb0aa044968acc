// The usual encodings copied row by row; everything else is left to cv_bridge.
#include "image_bytes.h"

#include <sensor_msgs/image_encodings.h>

#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace evolin::ros_shell {

namespace {

namespace encodings = sensor_msgs::image_encodings;

/// Whether the rows of pixels of `type` fill the bytes exactly.
bool fits(const ImageBytes& image, int type) {
  const std::uint64_t row = static_cast<std::uint64_t>(image.width) * CV_ELEM_SIZE(type);
  const std::uint64_t all = static_cast<std::uint64_t>(image.step) * image.height;
  constexpr std::uint32_t kLongestSide = 1U << 30;
  return image.width > 0 && image.height > 0 && image.width < kLongestSide &&
         image.height < kLongestSide && image.step >= row && image.size == all;
}

cv::Mat copyRows(const ImageBytes& image, int type, cv::Mat copy) {
  copy.create(static_cast<int>(image.height), static_cast<int>(image.width), type);
  const std::size_t row_size = image.width * copy.elemSize();
  if (image.step == row_size) {
    std::memcpy(copy.data, image.data, image.size);
    return copy;
  }
  for (int row = 0; row < copy.rows; ++row) {
    std::memcpy(copy.ptr(row), image.data + static_cast<std::size_t>(image.step) * row, row_size);
  }
  return copy;
}

}  // namespace

cv::Mat copyPixels(const ImageBytes& image, cv::Mat memory) {
  const std::string& encoding = image.encoding;
  if ((encoding == encodings::MONO8 || encoding == encodings::TYPE_8UC1) && fits(image, CV_8UC1)) {
    return copyRows(image, CV_8UC1, std::move(memory));
  }
  if (encoding == encodings::BGR8 && fits(image, CV_8UC3)) {
    return copyRows(image, CV_8UC3, std::move(memory));
  }
  if (encoding == encodings::RGB8 && fits(image, CV_8UC3)) {
    const cv::Mat stored(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                         const_cast<std::uint8_t*>(image.data), image.step);
    cv::cvtColor(stored, memory, cv::COLOR_RGB2BGR);
    return memory;
  }
  return {};
}

cv::Mat copyDepth(const ImageBytes& image, cv::Mat memory) {
  if (image.is_bigendian != 0) {
    return {};
  }
  if (image.encoding == encodings::TYPE_32FC1 && fits(image, CV_32FC1)) {
    return copyRows(image, CV_32FC1, std::move(memory));
  }
  if ((image.encoding == encodings::TYPE_16UC1 || image.encoding == encodings::MONO16) &&
      fits(image, CV_16UC1)) {
    return copyRows(image, CV_16UC1, std::move(memory));
  }
  return {};
}

}  // namespace evolin::ros_shell
