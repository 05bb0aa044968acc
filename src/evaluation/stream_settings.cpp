// Where the settings of a method change within a stream: a pass ends there and another begins.
#include <algorithm>
#include <iterator>
#include <utility>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/stream_evaluator.h"

namespace evolin {

namespace {

/// Results that a front-end of several threads may give out after the first of other settings.
constexpr std::size_t kMostLate = 8;
/// Parts of frames without lines that are kept for the next pass, at least.
constexpr std::size_t kLeastAhead = 10000;
/// Poses and depth so long before a frame may still be its neighbours in time.
constexpr Stamp kNeighbourhood = 2 * kNanosecondsPerSecond;

}  // namespace

bool StreamEvaluator::isRepeated(const Follower& follower, Key key) const {
  return key == follower.last || (!follower.received.empty() && key == *follower.received.rbegin());
}

void StreamEvaluator::openPass(EvaluationUpdate* update) {
  ++newest_;
  noted_.clear();
  update->new_pass = true;
  previous_changed_ = true;
  const auto opened = passes_.emplace(newest_, PassEvaluation(options_)).first;
  if (camera_) {
    update->append(marked(opened->second.setCamera(*camera_), newest_));
  }
  while (passes_.begin()->first < newest_ - 1) {
    passes_.begin()->second.skipPending();
    released_.emplace(passes_.begin()->first, std::move(passes_.begin()->second));
    passes_.erase(passes_.begin());
  }
  boundaries_.erase(boundaries_.begin(), boundaries_.lower_bound(newest_ - 1));
  if (update->changed_settings.empty()) {
    for (auto& parts : ahead_) {
      parts.clear();
    }
  }
}

/// A stamp that was there before, or one before all, is a matter of time's jumps.
bool StreamEvaluator::changesSettings(Input input, Key key, const std::string& source) const {
  const Follower& follower = followers_[input];
  return (input == kLines || input == kMatches) && follower.pass == newest_ &&
         follower.shared == 0 && source != follower.taken_source && !isRepeated(follower, key) &&
         !follower.received.empty() && follower.received.count(key) == 0 &&
         key > *follower.received.begin() && !isBetweenSettings(input, key, source);
}

void StreamEvaluator::beginSettings(Input input, Key key, const std::string& source,
                                    EvaluationUpdate* update) {
  Follower& changed = followers_[input];
  const Follower& lines = followers_[kLines];
  Stamp boundary = key.first;
  if (input != kLines && lines.pass == newest_ && !lines.received.empty()) {
    // Frames whose lines are scored already stay where they are.
    boundary = std::max(boundary, lines.received.rbegin()->first + 1);
  }
  update->changed_settings = std::string(input == kLines ? "the lines are" : "the matches are") +
                             " those of " + quote(source) + " from " + formatStamp(boundary) +
                             " s on, no longer those of " + quote(changed.taken_source);
  const int before = newest_;
  passes_.at(before).addNote(update->changed_settings);
  passes_.at(before).forgetFrom(boundary);
  openPass(update);
  boundaries_[newest_] = {boundary, key.first};
  PassEvaluation* const pass = &passes_.at(newest_);
  pass->addNote(update->changed_settings);
  changed.pass = newest_;
  changed.taken_source = source;
  changed.received.clear();
  for (int other = 0; other < kInputs; ++other) {
    Follower& follower = followers_[other];
    const Stamp from = other == kDepth || other == kPose ? boundary - kNeighbourhood : boundary;
    for (const auto& [part, add] : ahead_[other]) {
      // Pairs across the change are of neither side.
      const Stamp first = other == kMatches ? part.second : part.first;
      if (first >= from && other != input) {
        update->append(marked(add(pass), newest_));
      }
    }
    if (&follower != &changed && follower.pass == before && follower.last.first >= boundary) {
      follower.pass = newest_;
      follower.received.erase(follower.received.begin(),
                              follower.received.lower_bound({boundary, 0}));
    }
  }
}

/// An input that lags behind the one that changed gets to the boundary later.
void StreamEvaluator::crossBoundaries(Input input, Key key) {
  Follower& follower = followers_[input];
  const auto next = boundaries_.find(follower.pass + 1);
  if (follower.pass == 0 || next == boundaries_.end() || key.first < next->second.first ||
      isRepeated(follower, key) || follower.received.count(key) != 0) {
    return;
  }
  follower.pass = next->first;
  follower.received.clear();
}

/// Late results of the settings before, matches of frames that stay in the pass before, and pairs
/// with a frame on either side.
bool StreamEvaluator::isBetweenSettings(Input input, Key key, const std::string& source) const {
  const Follower& follower = followers_[input];
  const auto found = boundaries_.find(follower.pass);
  if ((input != kLines && input != kMatches) || found == boundaries_.end()) {
    return false;
  }
  const Boundary& boundary = found->second;
  if (input == kMatches && key.first >= boundary.first) {
    return key.second < boundary.first;
  }
  const bool late = source != follower.taken_source && follower.received.size() <= kMostLate;
  return key.first < boundary.first &&
         (late || (input == kMatches && key.first >= boundary.changed));
}

void StreamEvaluator::remember(Input input, Key key, const AddTo& add) {
  if (followers_[input].pass != newest_) {
    return;
  }
  if (input != kLines) {
    ahead_[input].emplace_back(key, add);
    if (ahead_[input].size() >
        (input == kDepth ? options_.motion.depth_buffer : std::max(options_.buffer, kLeastAhead))) {
      ahead_[input].pop_front();
    }
    return;
  }
  for (int other = 0; other < kInputs; ++other) {
    Stamp kept = key.first;
    std::size_t spare = 0;
    if (other == kPose) {
      kept -= kNeighbourhood;
    } else if (other == kDepth) {  // images are large: none that no frame can ask for any more
      kept -= options_.motion.max_time_difference;
      spare = kMostLate;
    }
    auto& parts = ahead_[other];
    while (parts.size() > spare && parts.front().first.first <= kept) {
      parts.pop_front();
    }
  }
}

void StreamEvaluator::passOver(Input input, Key key, PassEvaluation* pass) {
  const bool is_new = noted_.insert({input, kPaused}).second;
  if (input == kMatches) {
    pass->countSkippedPair(is_new ? "matches that came while the evaluation was paused are skipped"
                                  : "");
  } else {
    pass->skipFrame(key.first, is_new ? "frames with parts that came while the evaluation was "
                                        "paused are skipped"
                                      : "");
  }
}

}  // namespace evolin
