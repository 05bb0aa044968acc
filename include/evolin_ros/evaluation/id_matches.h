// Matches of front-ends that follow lines by track ids: lines of equal id in frames a step apart.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "evolin_ros/evaluation/inputs.h"

namespace evolin {

/// Takes the frames of one front-end in order of time. Only frames that come count as steps: of a
/// front-end that leaves out images, frames a step apart are further apart in time, and the stamps
/// of the matches say how far.
class IdMatcher {
 public:
  struct Result {
    /// Between the frame a step before and this one, `source` as in the constructor; none while
    /// there is no such frame.
    std::optional<MatchSet> matches;
    /// There is one, but it or this frame has lines and none of them an id.
    bool without_ids = false;
    std::size_t repeated = 0;  ///< lines of this frame whose id another line before them has
    bool jumped_back = false;  ///< the frame is not later than the last: earlier ones are forgotten
  };

  /// `frame_step`: frames from the first to the second of a pair, at least 1. `source` names the
  /// matcher; "" for "ids".
  explicit IdMatcher(int frame_step, std::string source = "");

  /// Lines of another source begin anew: indices of two sources never meet in one match. Of lines
  /// that repeat an id the first alone is matched; a negative id is none.
  Result add(const LineSet& lines);

  /// The next frame has none before it.
  void startSequence() { window_.clear(); }

 private:
  std::size_t step_;
  std::string source_;
  std::deque<LineSet>
      window_;  ///< the last frames, at most a step and one; repeated ids taken away
};

}  // namespace evolin
