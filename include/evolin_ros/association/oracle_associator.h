// The upper bound of association: matches as depth and poses say.
#pragma once

#include "evolin_ros/association/geometric_matching.h"
#include "evolin_ros/association/line_associator.h"

namespace evolin {

struct OracleParameters {
  GeometricGates gates{3, 3, 0.3};
  double max_gap = 0.1;  ///< metres between the two lines in space, where both have depth; an edge
                         ///< that has come before another one is so told from it
};

/// Plug-in `oracle`. `distance` of a match is in pixels. Needs depth, camera and poses of both
/// frames; throws Error naming the frame where one is missing, and when not configured.
class OracleAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  Needs needs() const override { return {true, true, true}; }
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const OracleParameters& parameters() const { return parameters_; }

 private:
  OracleParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
