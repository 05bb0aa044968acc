// LSD as OpenCV implements it (Grompone von Gioi, Jakubowicz, Morel, Randall: LSD: a Line Segment
// Detector, IPOL 2012).
#pragma once

#include <string>

#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are OpenCV's, with the refinement that gives scores.
struct OpenCvLsdParameters {
  std::string refine = "advanced";  ///< none, standard or advanced; only the last gives scores
  double scale = 0.8;               ///< of the image before detection, 0.1 to 4
  double sigma_scale = 0.6;         ///< the blur's sigma is sigma_scale / scale pixels, 0.01 to 10
  double quantization = 2.0;      ///< bound of the gradient's rounding error, grey levels, 0 to 255
  double angle_tolerance = 22.5;  ///< degrees, 0.1 to 179
  double log_eps = 0.0;           ///< accepted when -log10(NFA) exceeds it, -1000 to 1000
  double density_threshold = 0.7;  ///< share of aligned points in the rectangle, 0 to 0.99
  int bins = 1024;                 ///< of the gradient's pseudo-ordering, 1 to 65536
};

/// Plug-in `opencv_lsd`. Score: -log10 of the number of false alarms. OpenCV 4.8
/// changed how a rectangle's aligned points are counted: fewer lines than before, other scores; and
/// with `refine: advanced` seconds for an edge exactly along a row or column. `lsd` has neither.
class OpenCvLsd : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override;
  bool givesScores() const override { return parameters_.refine == "advanced"; }
  LineSegments detect(const Frame& frame) override;

  const OpenCvLsdParameters& parameters() const { return parameters_; }

 private:
  OpenCvLsdParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
