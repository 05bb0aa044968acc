// CannyLines, our own implementation (Lu, Yao, Li, Li: CannyLines: a parameter-free line segment
// detector, ICIP 2015).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of the authors' own program.
struct CannyLinesParameters {
  double sigma = 1.0;               ///< of the 3x3 smoothing, pixels, 0.1 to 10
  double meaningful_gradient = 70;  ///< |dx| + |dy| of the Sobel filter, 1 to 2040
  double fit_error = 1.0;           ///< root mean square of lines that merge, pixels, 0.01 to 10
  bool validate = true;             ///< lines that noise would have are dropped
  bool compatible = true;  ///< lines are fitted in single precision, as in the authors' program:
                           ///< they depend a little on where in the image they lie
  DetectorSelection selection;
};

/// Plug-in `cannylines`. No score. Memory is kept from frame to frame.
class CannyLines : public LineDetector {
 public:
  CannyLines();
  ~CannyLines() override;

  void configure(const YAML::Node& parameters) override;
  LineSegments detect(const Frame& frame) override;

  const CannyLinesParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  CannyLinesParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
