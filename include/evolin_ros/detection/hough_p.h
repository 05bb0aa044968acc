// Canny edges and the progressive probabilistic Hough transform of OpenCV (Matas, Galambos,
// Kittler: Robust detection of lines using the progressive probabilistic Hough transform, CVIU
// 2000).
#pragma once

#include "evolin_ros/detection/line_detector.h"

namespace evolin {

struct HoughPParameters {
  double canny_threshold1 = 50.0;   ///< lower hysteresis threshold, gradient units, 0 to 100000
  double canny_threshold2 = 200.0;  ///< upper hysteresis threshold, gradient units, 0 to 100000
  int canny_aperture = 3;           ///< side of the Sobel window, pixels: 3, 5 or 7
  double rho = 1.0;                 ///< distance resolution, pixels, 0.1 to 10
  double theta = 1.0;               ///< angle resolution, degrees, 0.1 to 90
  int threshold = 80;               ///< votes that a line needs, 1 to 1000000
  double min_length = 30.0;         ///< pixels, 0 to 100000
  double max_gap = 10.0;            ///< between points of one line, pixels, 0 to 100000
};

/// Plug-in `hough_p`. Endpoints are whole pixels; the library's random order is seeded, so equal
/// images give equal lines. No score.
class HoughP : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  LineSegments detect(const Frame& frame) override;

  const HoughPParameters& parameters() const { return parameters_; }

 private:
  HoughPParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
