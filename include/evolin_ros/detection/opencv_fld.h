// The fast line detector of OpenCV (Lee, Lee, Zhang, Lim, Suh: Outdoor place recognition in urban
// environments using straight lines, ICRA 2014).
#pragma once

#include <string>

#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are OpenCV's.
struct OpenCvFldParameters {
  int length_threshold = 10;                ///< shorter segments are dropped, pixels, 1 to 100000
  double distance_threshold = 1.414213562;  ///< of a point from its line, pixels, 0.001 to 1000
  double canny_threshold1 = 50.0;           ///< gradient units, 0.001 to 100000
  double canny_threshold2 = 50.0;           ///< gradient units, 0.001 to 100000
  int canny_aperture = 3;                   ///< side of the Sobel window, pixels: 3, 5 or 7
  bool merge = false;                       ///< joins neighbouring segments in a second pass
};

/// Plug-in `opencv_fld`. No score.
class OpenCvFld : public LineDetector {
 public:
  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override;
  LineSegments detect(const Frame& frame) override;

  const OpenCvFldParameters& parameters() const { return parameters_; }

 private:
  OpenCvFldParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
