// Associates lines by angle, distance and overlap after a predicted motion.
#pragma once

#include <string>

#include "evolin_ros/association/geometric_matching.h"
#include "evolin_ros/association/line_associator.h"

namespace evolin {

enum class MotionPrediction {
  kNone,         ///< lines stay where they are
  kTranslation,  ///< the whole image moves, as phase correlation of the two says (Kuglin, Hines
                 ///< 1975)
  kPose          ///< every line as depth and the poses say
};

struct GeometricParameters {
  MotionPrediction prediction = MotionPrediction::kTranslation;
  GeometricGates gates;
};

/// Plug-in `geometric`. `distance` of a match is in pixels. needs() depends on the configuration.
/// Throws Error when not configured, for images of different sizes and where a part that the
/// prediction needs is missing.
class GeometricAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  Needs needs() const override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const GeometricParameters& parameters() const { return parameters_; }

 private:
  GeometricParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
