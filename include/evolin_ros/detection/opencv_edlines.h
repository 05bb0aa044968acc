// EDLines as OpenCV's EdgeDrawing implements it (Akinlar, Topal: EDLines: A real-time line segment
// detector with a false detection control, Pattern Recognition Letters 2011).
#pragma once

#include <string>

#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are OpenCV's.
struct OpenCvEdLinesParameters {
  bool parameter_free = false;                  ///< edges validated by EDPF instead of thresholds
  std::string gradient_operator = "prewitt";    ///< prewitt, sobel, scharr or lsd
  int gradient_threshold = 20;                  ///< gradient units, 1 to 30000
  int anchor_threshold = 0;                     ///< gradient units, 0 to 30000
  int scan_interval = 1;                        ///< anchors every so many rows, pixels, 1 to 1000
  int min_path_length = 10;                     ///< of an edge segment, pixels, 10 to 100000
  double sigma = 1.0;                           ///< of the blur, pixels, 0 to 20; below 1: no blur
  bool sum_gradient = true;                     ///< |gx| + |gy| instead of the Euclidean norm
  bool nfa_validation = true;                   ///< lines validated by their number of false alarms
  int min_line_length = -1;                     ///< pixels, -1 (from the image's size) to 100000
  double max_distance_between_two_lines = 6.0;  ///< gap that is joined, pixels, 0 to 1000
  double line_fit_error_threshold = 1.0;        ///< pixels, 0.001 to 100
  double max_error_threshold = 1.3;             ///< when lines are joined, pixels, 0.001 to 100
};

/// Plug-in `opencv_edlines`. No score.
class OpenCvEdLines : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override;
  LineSegments detect(const Frame& frame) override;

  const OpenCvEdLinesParameters& parameters() const { return parameters_; }

 private:
  OpenCvEdLinesParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
