// The plug-in base of line associators.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin {

/// How often something happened, by what it was.
using MatchCounts = std::map<std::string, std::size_t>;

/// "3 of this; 5 of that".
inline std::string toText(const MatchCounts& counts) {
  std::string text;
  for (const auto& [what, count] : counts) {
    text += (text.empty() ? "" : "; ") + std::to_string(count) + " " + what;
  }
  return text;
}

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

  /// What the reader of the results should know of all matches so far and cannot see in them; a
  /// driver adds up those of its instances and tells them in the end.
  virtual MatchCounts counts() const { return {}; }
};

}  // namespace evolin
