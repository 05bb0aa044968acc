// ELSED, our own implementation (Suarez, Buenaposada, Baumela: ELSED: Enhanced Line SEgment
// Drawing, Pattern Recognition 127, 2022).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of the benchmark; the authors' own differ in `kernel`, which is 5.
struct ElsedParameters {
  int kernel = 7;                    ///< side of the smoothing window, pixels, odd, 1 to 15
  double sigma = 1.0;                ///< of the smoothing, pixels, 0.1 to 10
  int gradient_threshold = 30;       ///< |dx| + |dy| of the Sobel filter, 1 to 2040
  int anchor_threshold = 8;          ///< rise of an anchor above its neighbours, 0 to 2040
  int scan_interval = 2;             ///< anchors every so many rows and columns, pixels, 1 to 64
  int min_line_length = 15;          ///< pixels of the first fit, 4 to 1000
  double line_fit_error = 0.2;       ///< mean squared distance of the first fit, px^2, 0.001 to 100
  double pixel_distance = 1.5;       ///< of a pixel from its segment, pixels, 0.1 to 10
  int max_outliers = 3;              ///< in a row, before the segment ends, 0 to 100
  bool junctions = true;             ///< segments go on beyond gaps of 5, 7 and 9 pixels
  double junction_eigenvalues = 10;  ///< least ratio of the gradients beyond a gap, 1 to 1e6
  double junction_angle = 10;        ///< of those gradients to the segment's, degrees, 0 to 90
  bool validate = true;              ///< segments whose gradients point elsewhere are dropped
  double validation_threshold = 0.15;  ///< angle of a pixel's gradient, radians, 0.001 to 1.5
  DetectorSelection selection;
};

/// Plug-in `elsed`. Score: pixels of the segment whose gradient stands across it (without
/// `validate`: all its pixels). Images in which no anchor rises high enough are searched again with
/// half the threshold. Memory is kept from frame to frame.
class Elsed : public LineDetector {
 public:
  Elsed();
  ~Elsed() override;

  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return true; }
  LineSegments detect(const Frame& frame) override;

  const ElsedParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  ElsedParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
