// Associates lines by following points along them with pyramidal Lucas-Kanade optical flow.
#pragma once

#include "evolin_ros/association/geometric_matching.h"
#include "evolin_ros/association/line_associator.h"

namespace evolin {

struct LkTrackingParameters {
  double spacing = 8;        ///< pixels between two points on a line; at least 4 points, at most 24
  int window = 21;           ///< side of the window that is followed, pixels, odd
  int levels = 3;            ///< of the pyramid above the image
  double max_backward = 1;   ///< pixels from a point to where it comes back to
  double tolerance = 1.5;    ///< pixels from a followed point to the line through the others
  double min_support = 0.5;  ///< share of a line's points that must lie on one line
  GeometricGates gates{5, 3, 0.3};
};

/// Plug-in `lk_tracking`. Points along each line of the first image are followed into the second
/// and back (Bouguet 2001), the line that most of them lie on is fitted by least squares, and the
/// line of the second image that lies there is its match, one to one; `distance` is in pixels. A
/// frame's pyramid is its description, made once. Throws Error when not configured, for images of
/// different sizes, and for an image that is not 8-bit grey or BGR.
class LkTrackingAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  void describe(const FrameLines& lines) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const LkTrackingParameters& parameters() const { return parameters_; }

 private:
  LkTrackingParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
