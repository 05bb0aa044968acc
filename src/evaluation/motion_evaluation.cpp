// Frames wait for their depth and pose, are scored in order of time, and leave when nothing can
// need them any more.
#include "evolin_ros/evaluation/motion_evaluation.h"

#include <algorithm>
#include <iterator>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

/// Results that a front-end of several threads may give out before an earlier one.
constexpr std::size_t kMostSwapped = 8;

void requireSize(const std::string& frame, ImageSize lines, ImageSize depth) {
  if (lines.width != depth.width || lines.height != depth.height) {
    throw Error("frame " + frame + ": lines are of an image of " + std::to_string(lines.width) +
                "x" + std::to_string(lines.height) + ", its depth is of " +
                std::to_string(depth.width) + "x" + std::to_string(depth.height) +
                "; expected depth registered to the image, of its size");
  }
}

std::optional<RepeatabilityMetrics> byScore(const MotionOptions& options) {
  if (options.repeatability_score_thresholds.empty()) {
    return std::nullopt;
  }
  RepeatabilityOptions repeatabilities = options.repeatabilities;
  repeatabilities.score_thresholds = options.repeatability_score_thresholds;
  return RepeatabilityMetrics(repeatabilities);
}

bool isScored(const SpatialFrame& frame) {
  return std::all_of(frame.lines.begin(), frame.lines.end(),
                     [](const SpatialLine& line) { return line.segment.hasScore(); });
}

}  // namespace

MotionEvaluation::MotionEvaluation(MotionOptions options)
    : options_(std::move(options)),
      method_(options_.pose_method),
      repeatability_(options_.repeatabilities),
      by_score_(byScore(options_)),
      one_to_one_(options_.one_to_one),
      best_localization_(options_.best_localization),
      depth_(options_.max_time_difference, options_.depth_buffer) {}

MotionUpdate MotionEvaluation::setCamera(const Camera& camera) {
  MotionUpdate update;
  if (!camera_) {
    camera_ = camera;
    if (hasDistortion(camera)) {
      update.notes.emplace_back(
          "camera_info has a distortion; depth and poses take images and lines as rectified: "
          "repeatability and relative pose are wrong where they are not");
    }
    resolveAll(false, &update);
    advance(false, &update);
  } else if (!camera_differs_ && !sameIntrinsics(*camera_, camera)) {
    camera_differs_ = true;
    update.notes.emplace_back(
        "camera_info changed within the sequence; the intrinsics of its first message are used for "
        "depth and poses");
  }
  return update;
}

MotionUpdate MotionEvaluation::addImage(Stamp stamp) {
  MotionUpdate update;
  nodeAt(stamp, &update);
  return update;
}

void MotionEvaluation::removeImage(Stamp stamp) {
  const auto node = nodes_.find(stamp);
  if (node != nodes_.end() && node->second.detected.state == State::kAbsent &&
      node->second.truth.state == State::kAbsent) {
    nodes_.erase(node);
  }
}

void MotionEvaluation::forgetFrom(Stamp boundary) {
  for (auto node = nodes_.lower_bound(boundary); node != nodes_.end();) {
    const bool has_lines = node->second.detected.state != State::kAbsent;
    if (!has_lines) {
      unresolved_.erase(node->first);
    }
    node = has_lines ? std::next(node) : nodes_.erase(node);
  }
  for (auto pair = pending_.begin(); pair != pending_.end();) {
    pair = pair->first.second >= boundary ? pending_.erase(pair) : std::next(pair);
  }
}

MotionUpdate MotionEvaluation::addLines(const LineSet& lines) {
  MotionUpdate update;
  lines_source_ = lines.source;
  if (settled_ && lines.stamp <= *settled_) {
    ++counts_.late;
  }
  if (Node* node = nodeAt(lines.stamp, &update)) {
    takeLines(lines, true, &node->detected, &update);
    unresolved_.insert(lines.stamp);
    resolve(lines.stamp, false, &update);
    advance(false, &update);
  }
  return update;
}

MotionUpdate MotionEvaluation::addGroundTruth(const LineSet& ground_truth) {
  MotionUpdate update;
  ground_truth_source_ = ground_truth.source;
  if (Node* node = nodeAt(ground_truth.stamp, &update)) {
    if (options_.pose) {
      takeLines(ground_truth, false, &node->truth, &update);
      unresolved_.insert(ground_truth.stamp);
      resolve(ground_truth.stamp, false, &update);
    }
    advance(false, &update);
  }
  return update;
}

void MotionEvaluation::takeLines(const LineSet& lines, bool detected, Lifting* lifting,
                                 MotionUpdate* update) {
  const auto bad = std::find_if(lines.lines.begin(), lines.lines.end(),
                                [](const LineSegment& line) { return !line.isFinite(); });
  lifting->state = bad == lines.lines.end() ? State::kWaiting : State::kBad;
  if (lifting->state == State::kBad) {
    update->notes.push_back((detected ? "lines of frame " : "ground truth of frame ") +
                            formatStamp(lines.stamp) + ", row " +
                            std::to_string(bad - lines.lines.begin()) +
                            ": coordinates are not finite; the frame is left out of repeatability "
                            "and relative pose");
    return;
  }
  lifting->lines = lines.lines;
  lifting->size = {lines.width, lines.height};
}

MotionUpdate MotionEvaluation::addDepth(Stamp stamp, DepthMap depth) {
  MotionUpdate update;
  depth_.add(stamp, std::move(depth));
  resolveAll(false, &update);
  advance(false, &update);
  if (settled_) {
    depth_.trim(*settled_, [this](Stamp depth_stamp) { return mayBeLackedAt(depth_stamp); });
  }
  return update;
}

/// Whether lines of a frame that depth of this stamp may belong to have not come or not been lifted
/// yet; of a frame that nothing was heard of, they have not.
bool MotionEvaluation::mayBeLackedAt(Stamp depth_stamp) const {
  const auto lacks = [](const Lifting& lifting) {
    return lifting.state == State::kAbsent || lifting.state == State::kWaiting;
  };
  const auto first = nodes_.lower_bound(depth_stamp - options_.max_time_difference);
  const auto last = nodes_.upper_bound(depth_stamp + options_.max_time_difference);
  return first == last || std::any_of(first, last, [&](const Nodes::value_type& node) {
           return lacks(node.second.detected) || (options_.pose && lacks(node.second.truth));
         });
}

MotionUpdate MotionEvaluation::addPose(const StampedPose& pose) {
  MotionUpdate update;
  if (trajectory_.add(pose)) {
    resolveAll(false, &update);
    advance(false, &update);
  }
  return update;
}

MotionUpdate MotionEvaluation::finish() {
  MotionUpdate update;
  resolveAll(true, &update);
  advance(true, &update);
  for (const auto& [key, matches] : pending_) {
    tryPair(key, matches, true, &update);
  }
  pending_.clear();
  return update;
}

MotionEvaluation::Node* MotionEvaluation::nodeAt(Stamp stamp, MotionUpdate* update) {
  if (!wanted()) {
    return nullptr;
  }
  const auto found = nodes_.find(stamp);
  if (found != nodes_.end()) {
    return &found->second;
  }
  // One that is older than everything kept would be the first to leave.
  if (nodes_.size() >= options_.buffer && stamp < nodes_.begin()->first) {
    return nullptr;
  }
  Node* node = &nodes_[stamp];
  limitNodes(update);
  return node;
}

void MotionEvaluation::limitNodes(MotionUpdate* update) {
  if (nodes_.size() <= options_.buffer) {
    return;
  }
  const auto oldest = nodes_.begin();
  const Stamp stamp = oldest->first;
  if (!settled_ || stamp > *settled_) {
    resolve(stamp, true, update);
    settle(stamp, &oldest->second, update);
  }
  unresolved_.erase(stamp);
  gone_ = std::max(stamp, gone_.value_or(stamp));
  nodes_.erase(oldest);
  // One that is older than all that are kept is not taken any more.
  trajectory_.forgetBefore(nodes_.begin()->first);
}

void MotionEvaluation::resolveAll(bool complete, MotionUpdate* update) {
  const std::vector<Stamp> stamps(unresolved_.begin(), unresolved_.end());
  for (const Stamp stamp : stamps) {
    resolve(stamp, complete, update);
  }
}

void MotionEvaluation::resolve(Stamp stamp, bool complete, MotionUpdate* update) {
  Node& node = nodes_.at(stamp);
  bool changed = false;
  for (const bool detected : {true, false}) {
    Lifting& lifting = detected ? node.detected : node.truth;
    if (lifting.state == State::kWaiting) {
      lifting.state = lift(stamp, complete, detected, &lifting, &node, update);
      changed = changed || lifting.state != State::kWaiting;
    }
  }
  if (node.pose_state == State::kWaiting) {
    const std::vector<StampedPose>& poses = trajectory_.poses();
    if (const std::optional<Pose> pose = trajectory_.at(stamp)) {
      node.pose = *pose;
      node.pose_state = State::kReady;
    } else if (complete || (!poses.empty() && poses.back().stamp >= stamp)) {
      node.pose_state = State::kNever;
    }
    changed = changed || node.pose_state != State::kWaiting;
  }
  if (node.detected.state != State::kWaiting && node.truth.state != State::kWaiting &&
      node.pose_state != State::kWaiting) {
    unresolved_.erase(stamp);
  }
  if (changed) {
    tryPairs(stamp, update);
  }
}

MotionEvaluation::State MotionEvaluation::lift(Stamp stamp, bool complete, bool detected,
                                               Lifting* lifting, Node* node, MotionUpdate* update) {
  const DepthMap* depth = nullptr;
  const Lookup lookup = depth_.find(stamp, complete, &depth);
  if (lookup == Lookup::kNotYet || (!camera_ && !complete)) {
    return State::kWaiting;
  }
  State state = State::kNever;
  if (lookup == Lookup::kNever && depth_.hasForgotten(stamp) && !depth_told_) {
    depth_told_ = true;
    update->notes.push_back(
        "lines of " + formatStamp(stamp) + " came when their depth image had left the buffer of " +
        std::to_string(options_.depth_buffer) +
        " images; they and others of the kind count as frames without depth: raise depth_buffer");
  }
  if (lookup == Lookup::kFound && camera_) {
    const std::string name = formatStamp(stamp);
    try {
      requireSize(name, lifting->size, depth->size());
      if (options_.pose) {
        lifting->lifted =
            liftEndpoints(name, lifting->lines, *depth, *camera_, method_.endpoints());
      }
      if (detected && options_.repeatability) {
        node->spatial = std::make_shared<SpatialFrame>(liftLines(
            options_.repeatabilities.protocol, name, lifting->lines, *depth, *camera_, Pose()));
      }
      state = State::kReady;
    } catch (const Error& error) {
      update->notes.emplace_back(error.what());
    }
  }
  lifting->lines = LineSegments();
  return state;
}

void MotionEvaluation::advance(bool complete, MotionUpdate* update) {
  auto node = settled_ ? nodes_.upper_bound(*settled_) : nodes_.begin();
  while (node != nodes_.end() && (complete || isSettled(node))) {
    settle(node->first, &node->second, update);
    ++node;
  }
}

bool MotionEvaluation::isSettled(Nodes::const_iterator node) const {
  if (node->second.detected.state != State::kAbsent) {
    return node->second.detected.state != State::kWaiting &&
           node->second.pose_state != State::kWaiting;
  }
  std::size_t overtaken = 0;
  for (auto later = std::next(node); later != nodes_.end() && overtaken < kMostSwapped; ++later) {
    overtaken += later->second.detected.state != State::kAbsent ? 1 : 0;
  }
  return overtaken == kMostSwapped;
}

void MotionEvaluation::settle(Stamp stamp, Node* node, MotionUpdate* update) {
  settled_ = stamp;
  const std::size_t place = places_++;
  if (node->detected.state == State::kAbsent) {
    return;
  }
  if (node->detected.state == State::kBad) {
    ++counts_.bad_lines;
  } else if (node->pose_state != State::kReady) {
    ++counts_.no_pose;
  } else if (node->detected.state != State::kReady) {
    ++counts_.no_depth;
  } else {
    ++counts_.frames;
    if (node->spatial) {
      node->spatial->pose = node->pose;
      scorePairs(stamp, node->spatial, update);
      recent_.push_back({place, stamp, node->spatial});
    }
  }
  node->spatial.reset();
}

MotionWaiting MotionEvaluation::waiting() const {
  MotionWaiting waiting;
  auto node = settled_ ? nodes_.upper_bound(*settled_) : nodes_.begin();
  for (; node != nodes_.end(); ++node) {
    const State lines = node->second.detected.state;
    if (lines == State::kAbsent || lines == State::kBad) {
      continue;
    }
    if (node->second.pose_state == State::kWaiting) {
      ++waiting.pose;
    } else if (lines == State::kWaiting) {
      ++waiting.depth;
    }
  }
  return waiting;
}

void MotionEvaluation::scorePairs(Stamp stamp, const std::shared_ptr<const SpatialFrame>& frame,
                                  MotionUpdate* update) {
  const std::vector<int>& steps = options_.repeatabilities.frame_steps;
  const auto longest = static_cast<std::size_t>(*std::max_element(steps.begin(), steps.end()));
  const std::size_t place = places_ - 1;
  while (!recent_.empty() && recent_.front().place + longest < place) {
    recent_.pop_front();
  }
  for (const int step : steps) {
    const auto first = std::find_if(recent_.begin(), recent_.end(), [&](const Scored& scored) {
      return scored.place + static_cast<std::size_t>(step) == place;
    });
    if (first == recent_.end()) {
      continue;
    }
    RepeatabilityRecord record;
    record.first_stamp = first->stamp;
    record.stamp = stamp;
    record.frame_step = step;
    ProjectedPair pair(*first->frame, *frame);
    try {
      record.pair = repeatability_.addPair(step, &pair);
    } catch (const Error& error) {
      update->notes.emplace_back(error.what());
      continue;
    }
    if (by_score_ && isScored(*first->frame) && isScored(*frame)) {
      record.by_score = by_score_->addPair(step, &pair);
    } else if (by_score_) {
      ++counts_.unscored_pairs;
    }
    // The relatives are of one step, or their pairs would count several times.
    if (step == steps.front()) {
      const OneToOneRepeatability one_to_one = one_to_one_.addPair(pair);
      record.one_to_one_by_count = one_to_one.byCount();
      record.one_to_one_by_length = one_to_one.byLength();
      record.best = best_localization_.addPair(&pair);
    }
    update->repeatability.push_back(std::move(record));
  }
}

}  // namespace evolin
