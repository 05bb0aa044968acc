// The fast line detector, our own implementation (Lee, Lee, Zhang, Lim, Suh: Outdoor place
// recognition in urban environments using straight lines, ICRA 2014).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are OpenCV's, with which the benchmark ran.
struct FldParameters {
  int length_threshold = 10;                ///< of a line, and pixels of its first fit, 2 to 1000
  double distance_threshold = 1.414213562;  ///< of a pixel from its line, pixels, 0.001 to 100
  double canny_threshold1 = 50.0;           ///< hysteresis, gradient units, 0.001 to 100000
  double canny_threshold2 = 50.0;           ///< hysteresis, gradient units, 0.001 to 100000
  int canny_aperture = 3;                   ///< side of the Sobel window, pixels: 3, 5 or 7
  DetectorSelection selection;
};

/// Plug-in `fld`. No score. Memory is kept from frame to frame with the default aperture.
class Fld : public LineDetector {
 public:
  Fld();
  ~Fld() override;

  void configure(const YAML::Node& parameters) override;
  LineSegments detect(const Frame& frame) override;

  const FldParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  FldParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
