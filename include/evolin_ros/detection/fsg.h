// FSG, our own implementation (Suarez, Munoz, Buenaposada, Baumela: FSG: A statistical approach to
// line detection via fast segments grouping, IROS 2018).
#pragma once

#include <memory>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"

namespace evolin {

/// The defaults are those of the benchmark.
struct FsgParameters {
  double endpoint_error = 6;  ///< of the segments that are grouped, pixels, 0.5 to 100
  double max_overlap = 0.2;   ///< share of a segment that may lie beside its group, 0 to 1
  double max_gap = 4;         ///< to the group, in mean lengths of its segments, 0 to 1000
  int orientation_bins = 50;  ///< of half a turn; neighbouring bins may group, 3 to 1000
  int length_bins = 1000;     ///< of the image's diagonal; longer segments group first, 1 to 100000
  double segment_density = 150;  ///< pixels a segment in an image of noise, 1 to 1e6
  double min_line_length = 30;   ///< of a segment that stays alone, pixels, 0 to 100000
  DetectorSelection selection;
};

/// Plug-in `fsg`. No score. Groups the segments of LSD (seeds in rows, standard refinement). Memory
/// is kept from frame to frame.
class Fsg : public LineDetector {
 public:
  Fsg();
  ~Fsg() override;

  void configure(const YAML::Node& parameters) override;
  LineSegments detect(const Frame& frame) override;

  const FsgParameters& parameters() const { return parameters_; }

 private:
  class Engine;

  FsgParameters parameters_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
