// Following lines through the frames of a pass, and letting go of what only following needs.
#include <utility>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "evolin_ros/metrics/association.h"

namespace evolin {

namespace {

/// Frames that wait for matches and for frames that come out of order.
constexpr std::size_t kFollowReach = 32;

}  // namespace

/// Matches come after the lines that they are between; of ones that overtake them no track is made.
void PassEvaluation::keepForTracks(const MatchSet& matches) {
  const auto second = unfollowed_.find(matches.stamp);
  if (second != unfollowed_.end() && matches.lines_source != ground_truth_source_) {
    second->second.matched_with = matches.first_stamp;
    second->second.matches = toIndexPairs(matches.matches);
  }
}

/// A frame is final once nothing is waited for that would tell which physical lines it shows.
void PassEvaluation::followTracks() {
  while (unfollowed_.size() > kFollowReach) {
    const auto oldest = unfollowed_.begin();
    Entry& entry = entries_.at(oldest->first);
    if (entry.record.state == FrameState::kWaiting) {
      return;
    }
    follow(std::move(oldest->second), entry, &follower_);
    unfollowed_.erase(oldest);
    entry.followed = true;
    letGo(&entry);
  }
}

void PassEvaluation::follow(TrackedLines lines, const Entry& entry, TrackFollower* follower) {
  lines.true_ids = entry.carried_ids;
  follower->add(lines);
}

/// What later frames can need of one that has left the buffer and is followed: nothing.
void PassEvaluation::letGo(Entry* entry) {
  if (entry->released && (entry->followed || !wants(MetricFamily::kTracks))) {
    entry->carried_ids = std::vector<std::int64_t>();  // {} would keep the memory
  }
}

TrackReport PassEvaluation::tracks() const {
  TrackFollower follower = follower_;
  for (const auto& [stamp, lines] : unfollowed_) {
    follow(lines, entries_.at(stamp), &follower);
  }
  return follower.report();
}

}  // namespace evolin
