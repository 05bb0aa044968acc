// LSD as OpenCV implements it.
#include "evolin_ros/detection/opencv_lsd.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "evolin_opencv_features.h"
#include "evolin_ros/base/parameters.h"
#include "opencv_support.h"

namespace evolin {
namespace {

const char* const kOwner = "detector opencv_lsd";

int refinement(const std::string& name) {
  if (name == "none") {
    return cv::LSD_REFINE_NONE;
  }
  return name == "standard" ? cv::LSD_REFINE_STD : cv::LSD_REFINE_ADV;
}

}  // namespace

std::string OpenCvLsd::whyUnavailable() const {
  return kOpenCvHasLsd ? std::string()
                       : missingInOpenCv("a working LineSegmentDetector (module imgproc)",
                                         "3.0, not in 3.4.6 to 3.4.15 and 4.1.0 to 4.5.3");
}

void OpenCvLsd::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  OpenCvLsdParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("refine", &read.refine, {"none", "standard", "advanced"});
  reader.read("scale", &read.scale, 0.1, 4.0);
  reader.read("sigma_scale", &read.sigma_scale, 0.01, 10.0);
  reader.read("quantization", &read.quantization, 0.0, 255.0);
  reader.read("angle_tolerance", &read.angle_tolerance, 0.1, 179.0);
  reader.read("log_eps", &read.log_eps, -1000.0, 1000.0);
  reader.read("density_threshold", &read.density_threshold, 0.0, 0.99);
  reader.read("bins", &read.bins, 1, 65536);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

LineSegments OpenCvLsd::detect(const Frame& frame) {
  return detectOnGray(kOwner, configured_, frame, [this](const cv::Mat& gray) {
    // The gradient needs two pixels each way after scaling; OpenCV throws when nothing is left.
    if (cvRound(std::min(gray.cols, gray.rows) * parameters_.scale) < 2) {
      return LineSegments();
    }
    const cv::Ptr<cv::LineSegmentDetector> detector = cv::createLineSegmentDetector(
        refinement(parameters_.refine), parameters_.scale, parameters_.sigma_scale,
        parameters_.quantization, parameters_.angle_tolerance, parameters_.log_eps,
        parameters_.density_threshold, parameters_.bins);
    std::vector<cv::Vec4f> rows;
    std::vector<double> scores;
    if (!givesScores()) {
      detector->detect(gray, rows);
      return toLineSegments(rows);
    }
    detector->detect(gray, rows, cv::noArray(), cv::noArray(), scores);
    LineSegments lines = toLineSegments(rows);
    if (scores.size() != lines.size()) {
      throw Error(std::string(kOwner) + ": OpenCV returned " + std::to_string(scores.size()) +
                  " scores for " + std::to_string(lines.size()) + " lines");
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      lines[i].score = scores[i];
    }
    return lines;
  });
}

}  // namespace evolin
