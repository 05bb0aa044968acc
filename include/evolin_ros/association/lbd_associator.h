// Associates lines by the float line band descriptor (Zhang, Koch 2013).
#pragma once

#include <opencv2/core.hpp>

#include "evolin_ros/association/descriptor_choice.h"
#include "evolin_ros/association/lbd_descriptor.h"
#include "evolin_ros/association/line_associator.h"

namespace evolin {

using LbdParameters = DescriptorChoice;

/// More than two float descriptors, of length 1 at most, can differ by.
constexpr double kLbdLargestDistance = 2;

/// Plug-in `lbd`. `distance` of a match is the Euclidean distance of the descriptors (0 to 2).
/// Lines without length and lines that have no descriptor (see describeLbd) never match. Throws
/// Error for an image that is not 8-bit grey or BGR and when not configured.
class LbdAssociator : public LineAssociator {
 public:
  void configure(const YAML::Node& parameters) override;
  void describe(const FrameLines& lines) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const LbdParameters& parameters() const { return parameters_; }

 private:
  /// Of a frame, described now where its description is not this method's.
  cv::Mat descriptorsOf(const FrameLines& lines);

  LbdDescriber describer_;
  LbdParameters parameters_{kLbdLargestDistance};
  bool configured_ = false;
};

}  // namespace evolin
