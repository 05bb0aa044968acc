// The fast line detector of OpenCV.
#include "evolin_ros/detection/opencv_fld.h"

#include <algorithm>
#include <vector>

#include "evolin_opencv_features.h"
#include "evolin_ros/base/parameters.h"
#include "opencv_support.h"
#if EVOLIN_HAS_FAST_LINE_DETECTOR
#include <opencv2/ximgproc.hpp>
#endif

namespace evolin {
namespace {

const char* const kOwner = "detector opencv_fld";

#if EVOLIN_HAS_FAST_LINE_DETECTOR
// The library blanks a corner of six pixels and throws when there is none.
constexpr int kSmallestSide = 6;

LineSegments detectFastLines(const cv::Mat& gray, const OpenCvFldParameters& parameters) {
  if (std::min(gray.cols, gray.rows) < kSmallestSide) {
    return {};
  }
  const cv::Ptr<cv::ximgproc::FastLineDetector> detector = cv::ximgproc::createFastLineDetector(
      parameters.length_threshold, static_cast<float>(parameters.distance_threshold),
      parameters.canny_threshold1, parameters.canny_threshold2, parameters.canny_aperture,
      parameters.merge);
  std::vector<cv::Vec4f> rows;
  detector->detect(gray, rows);
  return toLineSegments(rows);
}
#else
LineSegments detectFastLines(const cv::Mat&, const OpenCvFldParameters&) { return {}; }
#endif

}  // namespace

std::string OpenCvFld::whyUnavailable() const {
  return EVOLIN_HAS_FAST_LINE_DETECTOR
             ? std::string()
             : missingInOpenCv("FastLineDetector (module ximgproc of opencv_contrib)",
                               "3.3 where opencv_contrib is installed");
}

void OpenCvFld::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  OpenCvFldParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("length_threshold", &read.length_threshold, 1, 100000);
  reader.read("distance_threshold", &read.distance_threshold, 0.001, 1000.0);
  reader.read("canny_threshold1", &read.canny_threshold1, 0.001, 100000.0);
  reader.read("canny_threshold2", &read.canny_threshold2, 0.001, 100000.0);
  reader.read("canny_aperture", &read.canny_aperture, 3, 7);
  reader.read("merge", &read.merge);
  reader.finish();
  requireOddAperture(kOwner, read.canny_aperture);
  parameters_ = read;
  configured_ = true;
}

LineSegments OpenCvFld::detect(const Frame& frame) {
  return detectOnGray(kOwner, configured_, frame,
                      [this](const cv::Mat& gray) { return detectFastLines(gray, parameters_); });
}

}  // namespace evolin
