// Matched pairs of frames on their way to a pose estimate, or to the count of what they lack.
#include <iterator>

#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/motion_evaluation.h"
#include "evolin_ros/metrics/association.h"

namespace evolin {

MotionUpdate MotionEvaluation::addMatches(const MatchSet& matches) {
  MotionUpdate update;
  if (!options_.pose) {
    return update;
  }
  const PairKey key(matches.first_stamp, matches.stamp);
  if (!tryPair(key, matches, false, &update)) {
    pending_.insert_or_assign(key, matches);
    if (pending_.size() > options_.buffer) {
      tryPair(pending_.begin()->first, pending_.begin()->second, true, &update);
      pending_.erase(pending_.begin());
    }
  }
  return update;
}

void MotionEvaluation::tryPairs(Stamp stamp, MotionUpdate* update) {
  for (auto pair = pending_.begin(); pair != pending_.end();) {
    const bool concerned = pair->first.first == stamp || pair->first.second == stamp;
    const bool done = concerned && tryPair(pair->first, pair->second, false, update);
    pair = done ? pending_.erase(pair) : std::next(pair);
  }
}

bool MotionEvaluation::tryPair(const PairKey& key, const MatchSet& matches, bool complete,
                               MotionUpdate* update) {
  const auto first = nodes_.find(key.first);
  const auto second = nodes_.find(key.second);
  const bool sources_known = !ground_truth_source_.empty() || matches.lines_source == lines_source_;
  if (!complete && (first == nodes_.end() || second == nodes_.end() || !sources_known)) {
    return false;
  }
  const bool truth = !ground_truth_source_.empty() && matches.lines_source == ground_truth_source_;
  for (const auto& node : {first, second}) {
    if (complete || node == nodes_.end()) {
      continue;
    }
    const State lines = truth ? node->second.truth.state : node->second.detected.state;
    if (lines == State::kAbsent || lines == State::kWaiting ||
        node->second.pose_state == State::kWaiting) {
      return false;
    }
  }
  if (std::size_t* const reason = reasonAgainst(key, truth)) {
    ++*reason;
  } else {
    makeTask(matches, first->second, second->second, truth, update);
  }
  return true;
}

/// The count of what a pair lacks; null when it lacks nothing.
std::size_t* MotionEvaluation::reasonAgainst(const PairKey& key, bool truth) {
  bool left_buffer = false;
  bool no_lines = false;
  bool bad_lines = false;
  bool no_pose = false;
  bool no_depth = false;
  for (const Stamp stamp : {key.first, key.second}) {
    const auto node = nodes_.find(stamp);
    if (node == nodes_.end()) {
      (gone_ && stamp <= *gone_ ? left_buffer : no_lines) = true;
      continue;
    }
    const State lines = truth ? node->second.truth.state : node->second.detected.state;
    no_lines = no_lines || lines == State::kAbsent;
    bad_lines = bad_lines || lines == State::kBad;
    no_pose = no_pose || node->second.pose_state != State::kReady;
    no_depth = no_depth || lines != State::kReady;
  }
  return left_buffer ? &counts_.pairs_left_buffer
         : no_lines  ? &counts_.pairs_no_lines
         : bad_lines ? &counts_.pairs_bad_lines
         : no_pose   ? &counts_.pairs_no_pose
         : no_depth  ? &counts_.pairs_no_depth
                     : nullptr;
}

void MotionEvaluation::makeTask(const MatchSet& matches, const Node& first, const Node& second,
                                bool truth, MotionUpdate* update) {
  PoseTask task;
  task.first_stamp = matches.first_stamp;
  task.stamp = matches.stamp;
  task.matched = matches.matches.size();
  try {
    task.matches = liftedMatches(truth ? first.truth.lifted : first.detected.lifted,
                                 truth ? second.truth.lifted : second.detected.lifted,
                                 toIndexPairs(matches.matches));
  } catch (const Error& error) {
    ++counts_.pairs_skipped;
    update->notes.push_back("matches of " + formatStamp(matches.first_stamp) + " and " +
                            formatStamp(matches.stamp) + ": " + error.what());
    return;
  }
  task.camera = *camera_;
  task.truth = relativeMotion(first.pose, second.pose);
  ++counts_.pose_pairs;
  update->pose_tasks.push_back(std::move(task));
}

}  // namespace evolin
