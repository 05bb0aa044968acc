// Two followers side by side until the lines show whether they have ids.
#include "evolin_ros/evaluation/track_follower.h"

namespace evolin {

void TrackFollower::add(const TrackedLines& frame) {
  if (previous_ && frame.stamp <= *previous_) {
    ++late_;
    return;
  }
  matches_ = matches_ || frame.matched_with.has_value();
  if (!ids_ && !frame.track_ids.empty()) {
    ids_ = true;
    by_matches_.reset();
    builder_ = TrackBuilder();
  }
  by_ids_.addFrame(
      frame.track_ids.empty() ? std::vector<std::int64_t>(frame.count, kNoId) : frame.track_ids,
      frame.true_ids);
  if (!ids_) {
    IndexPairs pairs;
    if (frame.matched_with && frame.matched_with == previous_) {
      for (const IndexPair& pair : frame.matches) {
        if (pair.first < static_cast<std::int64_t>(previous_count_) &&
            pair.second < static_cast<std::int64_t>(frame.count)) {
          pairs.push_back(pair);
        }
      }
    }
    by_matches_.addFrame(builder_.addFrame(frame.count, pairs), frame.true_ids);
  }
  previous_ = frame.stamp;
  previous_count_ = frame.count;
}

TrackReport TrackFollower::report() const {
  TrackReport report;
  report.late = late_;
  if (!ids_ && !matches_) {
    report.reason = "not evaluated: the detected lines carry no track ids and are not matched";
    return report;
  }
  report.from_matches = !ids_;
  const TrackMetrics& metrics = ids_ ? by_ids_ : by_matches_;
  report.frames = metrics.frames();
  report.tracks = metrics.tracks();
  report.mean_length = metrics.meanLength();
  report.median_length = metrics.medianLength();
  report.longest = metrics.longest();
  report.observations = metrics.observations();
  report.identity_switches = metrics.identitySwitches();
  report.drifts = metrics.drifts();
  return report;
}

}  // namespace evolin
