// The lower bound of association: pairs by chance.
#pragma once

#include <cstdint>

#include "evolin_ros/association/line_associator.h"

namespace evolin {

struct RandomParameters {
  int seed = 1;
};

/// Plug-in `random`. Every line of the frame that has fewer gets a partner, one to one, all such
/// pairings being equally likely; `distance` is NaN. The same seed and stamps give the same pairs,
/// whatever was matched before. Throws Error when not configured.
class RandomAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const RandomParameters& parameters() const { return parameters_; }

 private:
  RandomParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
