// LSWMS, our own implementation (Nieto, Cuevas, Salgado, Garcia: Line segment detection using
// weighted mean shift procedures on a 2D slice sampling strategy, Pattern Analysis and Applications
// 14, 2011).
#pragma once

#include <memory>
#include <string>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of the benchmark, without the shift of its lines.
struct LswmsParameters {
  int radius = 3;                 ///< of the mean shift's window, pixels, 1 to 15
  double angle_tolerance = 22.5;  ///< of a pixel's gradient to the line's, degrees, 1 to 45
  double max_error =
      0.19625;  ///< mean angle of an accepted line's gradients, radians, 0.001 to 1.6
  std::string score = "angle";  ///< angle or length
  bool compatible = false;      ///< coordinates and scores as published
  DetectorSelection selection;
};

/// Plug-in `lswms`. Score: `angle`: 1 - e / max_error, where e is the mean angle between the line's
/// normal and the gradients along it, at least 0; `length`: pixels. With `compatible`: the error
/// that the published implementation returns (radians, often 0, and lower is better), and its
/// lines, which lie some pixels to the lower right. Memory is kept from frame to frame.
class Lswms : public LineDetector {
 public:
  Lswms();
  ~Lswms() override;

  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return true; }
  LineSegments detect(const Frame& frame) override;

  const LswmsParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  LswmsParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
