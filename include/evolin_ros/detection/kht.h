// KHT, our own implementation (Fernandes, Oliveira: Real-time line detection through an improved
// Hough transform voting scheme, Pattern Recognition 41, 2008).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of the benchmark.
struct KhtParameters {
  double canny_threshold1 = 80.0;   ///< hysteresis, gradient units, 0 to 100000
  double canny_threshold2 = 200.0;  ///< hysteresis, gradient units, 0 to 100000
  int min_cluster = 10;             ///< edge pixels that vote together, 3 to 100000
  double min_deviation = 2.0;       ///< of a cluster's pixels that splits it, pixels, 0.1 to 100
  double delta = 0.5;               ///< bins of the vote, pixels and degrees, 0.1 to 10
  double min_height = 0.002;        ///< of a cluster's vote, share of the highest, 0 to 1
  double sigmas = 2.0;              ///< that a cluster's uncertainty is enlarged by, 1 to 10
  DetectorSelection selection;
};

/// Plug-in `kht`. The method finds infinite lines; each is cut to the image. Score: rank among the
/// lines of its frame by votes, from 1 (most) down to 0. Memory is kept from frame to frame.
class Kht : public LineDetector {
 public:
  Kht();
  ~Kht() override;

  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return true; }
  LineSegments detect(const Frame& frame) override;

  const KhtParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  KhtParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
