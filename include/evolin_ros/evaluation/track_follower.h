// Follows lines from frame to frame as frames become final, so that no frame need be kept for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/line_segment.h"
#include "evolin_ros/metrics/track_length.h"

namespace evolin {

/// How long lines are followed; see TrackMetrics.
struct TrackReport {
  std::string reason;  ///< why there are none; "" when there are
  bool from_matches = false;
  std::size_t frames = 0;
  std::size_t late = 0;  ///< frames that came after many later ones: left out
  std::uint64_t tracks = 0;
  std::optional<double> mean_length;
  std::optional<double> median_length;
  std::uint32_t longest = 0;
  std::uint64_t observations = 0;
  std::uint64_t identity_switches = 0;
  std::uint64_t drifts = 0;
};

/// What following needs of one frame's detected lines.
struct TrackedLines {
  Stamp stamp = 0;
  std::size_t count = 0;
  std::vector<std::int64_t> track_ids;  ///< the lines' own; empty: none has one
  std::vector<std::int64_t> true_ids;   ///< of the physical lines; empty: not known
  std::optional<Stamp> matched_with;    ///< the frame that `matches` come from
  IndexPairs matches;                   ///< (row there, row here)
};

/// Follows by the lines' own ids where any line has one, else by matches of neighbouring frames;
/// until the first id it does both. Copies are independent.
class TrackFollower {
 public:
  /// The next frame in order of time, or one to be counted as late.
  void add(const TrackedLines& frame);

  TrackReport report() const;

 private:
  bool ids_ = false;
  bool matches_ = false;
  std::size_t late_ = 0;
  TrackMetrics by_ids_;
  TrackMetrics by_matches_;  ///< no longer fed once there are ids
  TrackBuilder builder_;
  std::optional<Stamp> previous_;
  std::size_t previous_count_ = 0;
};

}  // namespace evolin
