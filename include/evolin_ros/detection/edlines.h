// EDLines, our own implementation (Akinlar, Topal: EDLines: a real-time line segment detector with
// a false detection control, Pattern Recognition Letters 32, 2011).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of OpenCV's EdgeDrawing, with which the benchmark ran.
struct EdLinesParameters {
  int kernel = 5;                ///< side of the smoothing window, pixels, odd, 1 to 15
  double sigma = 1.0;            ///< of the smoothing, pixels, 0.1 to 10
  int gradient_threshold = 20;   ///< |dx| + |dy| of the Prewitt filter, 1 to 1530
  int anchor_threshold = 0;      ///< rise of an anchor above its neighbours, 0 to 1530
  int scan_interval = 1;         ///< anchors every so many rows and columns, pixels, 1 to 64
  int min_path_length = 10;      ///< of an edge, pixels, 2 to 100000
  int min_line_length = 0;       ///< pixels of the first fit, 0 (from the image's size) to 1000
  double first_fit_error = 0.5;  ///< root mean square distance of the first fit, px, 0.01 to 10
  double pixel_distance = 1.0;   ///< of a pixel from its line, pixels, 0.01 to 10
  double join_distance = 6.0;    ///< gap between lines that are joined, pixels, 0 to 1000
  double join_error = 1.3;       ///< mean distance of joined lines, pixels, 0.001 to 100
  bool validate = true;          ///< lines that noise would have are dropped
  DetectorSelection selection;
};

/// Plug-in `edlines`. No score. Memory is kept from frame to frame.
class EdLines : public LineDetector {
 public:
  EdLines();
  ~EdLines() override;

  void configure(const YAML::Node& parameters) override;
  LineSegments detect(const Frame& frame) override;

  const EdLinesParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  EdLinesParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
