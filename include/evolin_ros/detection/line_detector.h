// The plug-in base of line detectors: one class and one line of plug-in XML make a method available
// everywhere.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin {

/// Finds line segments in one image. One instance serves one thread; two instances share nothing.
class LineDetector {
 public:
  LineDetector() = default;
  LineDetector(const LineDetector&) = delete;
  LineDetector& operator=(const LineDetector&) = delete;
  virtual ~LineDetector() = default;

  /// Called once, before the first frame, with a map of the method's parameters (possibly empty).
  /// Throws ConfigError for a key that the method does not have or a value that it does not accept,
  /// UnavailableError when this build lacks the method.
  virtual void configure(const YAML::Node& parameters) = 0;

  /// Why this build cannot run the method ("" when it can); may be asked before configure().
  virtual std::string whyUnavailable() const { return {}; }

  virtual Needs needs() const { return {}; }

  /// Whether every line carries a score that grows with quality.
  virtual bool givesScores() const { return false; }

  /// Segments in pixels of `frame.image` (8-bit grey or BGR, any size down to 1x1), in the method's
  /// own order. Throws Error for an image of another type.
  virtual LineSegments detect(const Frame& frame) = 0;

  /// Seconds that the method took for the frame of the last detect(), where it knows better than a
  /// clock around the call (a recording does); none: the clock is right.
  virtual std::optional<double> processingTime() const { return {}; }
};

}  // namespace evolin
