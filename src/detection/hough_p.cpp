// Canny edges and the progressive probabilistic Hough transform of OpenCV.
#include "evolin_ros/detection/hough_p.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "evolin_ros/base/parameters.h"
#include "opencv_support.h"

namespace evolin {
namespace {

const char* const kOwner = "detector hough_p";

}  // namespace

void HoughP::configure(const YAML::Node& parameters) {
  HoughPParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("canny_threshold1", &read.canny_threshold1, 0.0, 100000.0);
  reader.read("canny_threshold2", &read.canny_threshold2, 0.0, 100000.0);
  reader.read("canny_aperture", &read.canny_aperture, 3, 7);
  reader.read("rho", &read.rho, 0.1, 10.0);
  reader.read("theta", &read.theta, 0.1, 90.0);
  reader.read("threshold", &read.threshold, 1, 1000000);
  reader.read("min_length", &read.min_length, 0.0, 100000.0);
  reader.read("max_gap", &read.max_gap, 0.0, 100000.0);
  reader.finish();
  requireOddAperture(kOwner, read.canny_aperture);
  parameters_ = read;
  configured_ = true;
}

LineSegments HoughP::detect(const Frame& frame) {
  return detectOnGray(kOwner, configured_, frame, [this](const cv::Mat& gray) {
    // One row or column has no gradient across it, and its Hough table would be empty at coarse
    // resolutions.
    if (std::min(gray.cols, gray.rows) < 2) {
      return LineSegments();
    }
    cv::Mat edges;
    cv::Canny(gray, edges, parameters_.canny_threshold1, parameters_.canny_threshold2,
              parameters_.canny_aperture);
    std::vector<cv::Vec4i> rows;
    cv::HoughLinesP(edges, rows, parameters_.rho, parameters_.theta * CV_PI / 180.0,
                    parameters_.threshold, parameters_.min_length, parameters_.max_gap);
    return toLineSegments(rows);
  });
}

}  // namespace evolin
