// Associates lines by the binary line band descriptor (Zhang, Koch 2013): our own, or OpenCV's.
#pragma once

#include <string>

#include "evolin_ros/association/descriptor_choice.h"
#include "evolin_ros/association/lbd_binary_descriptor.h"
#include "evolin_ros/association/line_associator.h"

namespace evolin {

using LbdBinaryParameters = DescriptorChoice;

/// Bits of a descriptor.
constexpr double kLbdBinaryLargestDistance = 8 * kLbdBinaryBytes;

/// Plug-in `lbd_binary`. `distance` of a match is the number of bits that differ (0 to 256). Lines
/// that have no descriptor (see describeLbdBinary) never match. Throws Error for an image that is
/// not 8-bit grey or BGR and when not configured.
class LbdBinaryAssociator : public LineAssociator {
 public:
  LbdBinaryAssociator();

  void configure(const YAML::Node& parameters) override;
  void describe(const FrameLines& lines) override;
  LineMatches match(const FrameLines& first, const FrameLines& second) override;

  const LbdBinaryParameters& parameters() const { return parameters_; }

 protected:
  using Describe = BinaryDescriptors (*)(const cv::Mat& gray, const LineSegments& lines);

  /// `owner` stands at the head of every message.
  LbdBinaryAssociator(std::string owner, Describe describe_lines);

 private:
  void requireConfigured(const char* function) const;
  BinaryDescriptors descriptorsOf(const FrameLines& lines) const;

  std::string owner_;
  Describe describe_lines_;
  LbdBinaryParameters parameters_{kLbdBinaryLargestDistance};
  bool configured_ = false;
};

/// Plug-in `opencv_lbd_binary`: the same by OpenCV's BinaryDescriptor, as an independent check.
/// Throws Error besides for an image that is too large and when OpenCV fails.
class OpenCvLbdBinaryAssociator : public LbdBinaryAssociator {
 public:
  OpenCvLbdBinaryAssociator();

  std::string whyUnavailable() const override;
};

}  // namespace evolin
