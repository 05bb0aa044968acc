// The plug-in base of line associators.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin {

/// Matches the lines of two frames. One instance serves one thread; two instances share nothing.
class LineAssociator {
 public:
  LineAssociator() = default;
  LineAssociator(const LineAssociator&) = delete;
  LineAssociator& operator=(const LineAssociator&) = delete;
  virtual ~LineAssociator() = default;

  /// As LineDetector::configure.
  virtual void configure(const YAML::Node& parameters) = 0;

  /// Why this build cannot run the method ("" when it can); may be asked before configure().
  virtual std::string whyUnavailable() const { return {}; }

  virtual Needs needs() const { return {}; }

  /// Fills `lines.description` ahead of the matches that will need it, so that a driver may do this
  /// for several frames at once, by several instances of the same parameters; a method without
  /// descriptions leaves it alone. Errors as match().
  virtual void describe(const FrameLines& /*lines*/) {}

  /// Pairs of indices into `first.lines` and `second.lines`, sorted by the first index.
  /// Descriptions are computed once a frame and kept in FrameLines::description.
  virtual LineMatches match(const FrameLines& first, const FrameLines& second) = 0;
};

}  // namespace evolin
