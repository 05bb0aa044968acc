// EDLines as OpenCV's EdgeDrawing implements it.
#include "evolin_ros/detection/opencv_edlines.h"

#include <algorithm>
#include <vector>

#include "evolin_opencv_features.h"
#include "evolin_ros/base/parameters.h"
#include "opencv_support.h"
#if EVOLIN_HAS_EDGE_DRAWING
#include <opencv2/ximgproc/edge_drawing.hpp>
#endif

namespace evolin {
namespace {

const char* const kOwner = "detector opencv_edlines";

#if EVOLIN_HAS_EDGE_DRAWING
// Anchors keep two pixels from the border, and smaller images make the library index outside of
// its buffers.
constexpr int kSmallestSide = 5;

int gradientOperator(const std::string& name) {
  using cv::ximgproc::EdgeDrawing;
  if (name == "sobel") {
    return EdgeDrawing::SOBEL;
  }
  if (name == "scharr") {
    return EdgeDrawing::SCHARR;
  }
  return name == "lsd" ? EdgeDrawing::LSD : EdgeDrawing::PREWITT;
}

LineSegments detectEdgeLines(const cv::Mat& gray, const OpenCvEdLinesParameters& parameters) {
  if (std::min(gray.cols, gray.rows) < kSmallestSide) {
    return {};
  }
  cv::ximgproc::EdgeDrawing::Params params;
  params.PFmode = parameters.parameter_free;
  params.EdgeDetectionOperator = gradientOperator(parameters.gradient_operator);
  params.GradientThresholdValue = parameters.gradient_threshold;
  params.AnchorThresholdValue = parameters.anchor_threshold;
  params.ScanInterval = parameters.scan_interval;
  params.MinPathLength = parameters.min_path_length;
  params.Sigma = static_cast<float>(parameters.sigma);
  params.SumFlag = parameters.sum_gradient;
  params.NFAValidation = parameters.nfa_validation;
  params.MinLineLength = parameters.min_line_length;
  params.MaxDistanceBetweenTwoLines = parameters.max_distance_between_two_lines;
  params.LineFitErrorThreshold = parameters.line_fit_error_threshold;
  params.MaxErrorThreshold = parameters.max_error_threshold;

  // A fresh object for each image: it is cheap, and what one keeps from an image of another size
  // leads it astray.
  const cv::Ptr<cv::ximgproc::EdgeDrawing> detector = cv::ximgproc::createEdgeDrawing();
  detector->setParams(params);
  detector->detectEdges(gray);
  std::vector<cv::Vec4f> rows;
  detector->detectLines(rows);
  return toLineSegments(rows);
}
#else
LineSegments detectEdgeLines(const cv::Mat&, const OpenCvEdLinesParameters&) { return {}; }
#endif

}  // namespace

std::string OpenCvEdLines::whyUnavailable() const {
  return EVOLIN_HAS_EDGE_DRAWING
             ? std::string()
             : missingInOpenCv("EdgeDrawing (module ximgproc of opencv_contrib)", "4.5.2");
}

void OpenCvEdLines::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  OpenCvEdLinesParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("parameter_free", &read.parameter_free);
  reader.read("gradient_operator", &read.gradient_operator, {"prewitt", "sobel", "scharr", "lsd"});
  reader.read("gradient_threshold", &read.gradient_threshold, 1, 30000);
  reader.read("anchor_threshold", &read.anchor_threshold, 0, 30000);
  reader.read("scan_interval", &read.scan_interval, 1, 1000);
  reader.read("min_path_length", &read.min_path_length, 10, 100000);
  reader.read("sigma", &read.sigma, 0.0, 20.0);
  reader.read("sum_gradient", &read.sum_gradient);
  reader.read("nfa_validation", &read.nfa_validation);
  reader.read("min_line_length", &read.min_line_length, -1, 100000);
  reader.read("max_distance_between_two_lines", &read.max_distance_between_two_lines, 0.0, 1000.0);
  reader.read("line_fit_error_threshold", &read.line_fit_error_threshold, 0.001, 100.0);
  reader.read("max_error_threshold", &read.max_error_threshold, 0.001, 100.0);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

LineSegments OpenCvEdLines::detect(const Frame& frame) {
  return detectOnGray(kOwner, configured_, frame,
                      [this](const cv::Mat& gray) { return detectEdgeLines(gray, parameters_); });
}

}  // namespace evolin
