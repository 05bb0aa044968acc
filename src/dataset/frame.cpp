// Grey images for detectors and descriptors.
#include "evolin_ros/dataset/frame.h"

#include <opencv2/imgproc.hpp>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

std::string typeName(const cv::Mat& image) {
  switch (image.depth()) {
    case CV_8U:
      return "8-bit unsigned";
    case CV_8S:
      return "8-bit signed";
    case CV_16U:
      return "16-bit unsigned";
    case CV_16S:
      return "16-bit signed";
    case CV_32S:
      return "32-bit integer";
    case CV_32F:
      return "32-bit floating-point";
    case CV_64F:
      return "64-bit floating-point";
    default:
      return "other";
  }
}

}  // namespace

cv::Mat toGray(const cv::Mat& image) {
  const char* const expectation = "expected an 8-bit image of 1 (grey) or 3 (BGR) channels";
  if (image.empty()) throw Error(std::string("empty image: ") + expectation);
  if (image.dims == 2 && image.type() == CV_8UC1) return image;
  if (image.dims == 2 && image.type() == CV_8UC3) {
    cv::Mat gray;
    cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
    return gray;
  }
  throw Error("image of " + std::to_string(image.channels()) + " " + typeName(image) +
              " channel(s) in " + std::to_string(image.dims) + " dimensions: " + expectation);
}

}  // namespace evolin
