// LSD, our own implementation (Grompone von Gioi, Jakubowicz, Morel, Randall: LSD: a Line Segment
// Detector, IPOL 2012).
#pragma once

#include <memory>
#include <string>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are the article's.
struct LsdParameters {
  std::string refine = "advanced";  ///< none, standard or advanced; only the last gives scores
  double scale = 0.8;               ///< of the image before detection, 0.1 to 4
  double sigma_scale = 0.6;         ///< the blur's sigma is sigma_scale / scale pixels, 0.01 to 10
  double quantization = 2.0;      ///< bound of the gradient's rounding error, grey levels, 0 to 255
  double angle_tolerance = 22.5;  ///< degrees, 0.1 to 89
  double log_eps = 0.0;           ///< accepted when -log10(NFA) exceeds it, -1000 to 1000
  double density_threshold = 0.7;  ///< share of aligned points in the rectangle, 0 to 0.99
  int bins = 1024;                 ///< of the gradient's pseudo-ordering, 1 to 65536
  bool compatible = true;  ///< counts and scores as OpenCV before 4.8, false: as the article
  DetectorSelection selection;
};

/// Plug-in `lsd`. Score: -log10 of the number of false alarms. Finds the lines of OpenCV's LSD
/// before 4.8, in any OpenCV. Memory is kept from frame to frame.
class Lsd : public LineDetector {
 public:
  Lsd();
  ~Lsd() override;

  void configure(const YAML::Node& parameters) override;
  bool givesScores() const override { return parameters_.refine == "advanced"; }
  LineSegments detect(const Frame& frame) override;

  const LsdParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  LsdParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
