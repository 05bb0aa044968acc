// Associates lines by the binary line band descriptor of OpenCV (Zhang, Koch 2013).
#pragma once

#include <string>

#include "evolin_ros/association/line_associator.h"

namespace evolin {

struct LbdBinaryParameters {
  bool cross_check = true;  ///< keep a pair only if each line is the other's nearest
  int max_distance = 256;   ///< bits, 0 to 256; pairs further apart are dropped; 256: none is
};

/// Plug-in `lbd_binary`. `distance` of a match is the number of bits that differ (0 to 256). Lines
/// that have no descriptor (see describeLbdBinary) never match. Throws Error for an image that is
/// not 8-bit grey or BGR or is too large, when OpenCV fails, and when not configured.
class LbdBinaryAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override;
  void describe(const FrameLines& lines) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const LbdBinaryParameters& parameters() const { return parameters_; }

 private:
  LbdBinaryParameters parameters_;
  bool configured_ = false;
};

}  // namespace evolin
