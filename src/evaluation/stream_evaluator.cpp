// The rules that tell a loop from a late or repeated message.
#include "evolin_ros/evaluation/stream_evaluator.h"

#include <algorithm>
#include <utility>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// Results that a front-end of several threads may give out before the first one.
constexpr int kMostSwapped = 8;

/// Stamps of an input that are known again when they come a second time.
constexpr std::size_t kLeastRemembered = 1000;

std::string secondsText(Stamp stamp) { return formatStamp(stamp) + " s"; }

/// Which publishers an input has is not known here, but two methods on one topic give themselves
/// away.
std::string sourcesText(const std::string& before, const std::string& now) {
  return before == now ? ""
                       : " (from " + quote(now) + ", the message before it from " + quote(before) +
                             ": does more than one node publish here?)";
}

}  // namespace

StreamEvaluator::StreamEvaluator(PassOptions options) : options_(std::move(options)) {
  passes_.emplace(newest_, PassEvaluation(options_));
}

std::optional<int> StreamEvaluator::passOf(Input input, Key key) {
  Follower& follower = followers_[input];
  if (follower.pass == 0) {
    follower.pass = newest_;
  } else if (isRepeated(follower, key)) {
    return std::nullopt;
  } else {
    const bool seen_before = follower.received.count(key) != 0;
    const bool before_all = key < *follower.received.begin();
    if (seen_before || (before_all && !startedOutOfOrder(input, key.first))) {
      // An input that slept through a whole pass must not lag behind for ever.
      follower.pass = std::max(follower.pass + 1, newest_ - 1);
      // Nor does a jump back lead into a pass that continues the one before it.
      while (follower.pass < newest_ && boundaries_.count(follower.pass) != 0) {
        ++follower.pass;
      }
      follower.received.clear();
    }
  }
  follower.last = key;
  follower.received.insert(key);
  // What is before all of so many is a jump, whether it was there or not.
  if (follower.received.size() > std::max(options_.buffer, kLeastRemembered)) {
    follower.received.erase(follower.received.begin());
  }
  return follower.pass;
}

bool StreamEvaluator::startedOutOfOrder(Input input, Stamp stamp) const {
  const Follower& follower = followers_[input];
  if (follower.received.size() > static_cast<std::size_t>(kMostSwapped)) {
    return false;
  }
  return std::any_of(followers_.begin(), followers_.end(), [&](const Follower& other) {
    return &other != &follower && other.pass == follower.pass &&
           other.received.count({stamp, 0}) != 0;
  });
}

PassEvaluation* StreamEvaluator::enter(Input input, Key key, const std::string& source,
                                       EvaluationUpdate* update) {
  if (key.first == 0) {
    drop(input, kNoStamp, "a message without a stamp (0 s)", update);
    return nullptr;
  }
  Follower& follower = followers_[input];
  if (changesSettings(input, key, source)) {
    beginSettings(input, key, source, update);
  }
  crossBoundaries(input, key);
  if (isBetweenSettings(input, key, source)) {
    drop(input, kBetweenSettings,
         "a message of stamp " + secondsText(key.first) +
             ", on the other side of a change of settings,",
         update);
    return nullptr;
  }
  const int pass_before = follower.pass;
  const std::optional<int> pass = passOf(input, key);
  const std::string sources = sourcesText(pass_before == 0 ? source : follower.source, source);
  follower.source = source;
  if (!pass) {
    follower.shared = source == follower.taken_source ? follower.shared : kMostSwapped;
    drop(input, kRepeated, "a second message of stamp " + secondsText(key.first) + sources, update);
    return nullptr;
  }
  if (*pass != pass_before && !sources.empty() && told_.insert({input, kSeveralSources}).second) {
    update->warnings.push_back("time jumped back to " + secondsText(key.first) + sources +
                               "; every jump begins a pass of its own");
  }
  if (*pass > newest_) {
    openPass(update);
  }
  if (source == follower.taken_source) {
    follower.shared = std::max(follower.shared - 1, 0);
  } else if (pass_before != 0 && *pass != pass_before) {
    follower.shared = kMostSwapped;
  }
  follower.taken_source = source;
  const auto found = passes_.find(*pass);
  if (found == passes_.end()) {
    drop(input, kPassClosed,
         "a message of stamp " + secondsText(key.first) + ", which belongs to pass " +
             std::to_string(*pass) + ", in pass " + std::to_string(newest_),
         update);
    return nullptr;
  }
  return &found->second;
}

void StreamEvaluator::drop(Input input, Fault fault, const std::string& what,
                           EvaluationUpdate* update) {
  // Images, depth and poses are no result: what they lack shows where it is missed. Without stamps,
  // though, a whole stream of depth or poses would vanish.
  if (input == kImage || ((input == kDepth || input == kPose) && fault != kNoStamp)) {
    return;
  }
  constexpr const char* kNames[kInputs] = {"images",  "lines", "ground truth",
                                           "matches", "depth", "poses"};
  constexpr const char* kCounts[kInputs] = {
      "", "dropped", "dropped", "skipped pairs", "depth_left_out", "poses_left_out"};
  const std::string text =
      what + " is left out; it and others of its kind count as " + kCounts[input];
  const bool is_new = noted_.insert({input, fault}).second;
  const std::string note = is_new ? std::string(kNames[input]) + ": " + text : "";
  PassEvaluation& newest = passes_.at(newest_);
  switch (input) {
    case kMatches:
      newest.countSkippedPair(note);
      break;
    case kDepth:
      newest.countLeftOutDepth(note);
      break;
    case kPose:
      newest.countLeftOutPose(note);
      break;
    default:
      newest.countDroppedFrame(note);
  }
  if (told_.insert({input, fault}).second) {
    update->warnings.push_back(text);
  }
}

EvaluationUpdate StreamEvaluator::marked(EvaluationUpdate update, int pass) const {
  for (EvaluationTask& task : update.tasks) {
    task.generation = generation_;
    task.pass = pass;
  }
  return update;
}

EvaluationUpdate StreamEvaluator::add(Input input, Key key, const std::string& source,
                                      const AddTo& add) {
  EvaluationUpdate update;
  if (paused_ && input == kImage) {
    return update;
  }
  PassEvaluation* const pass = enter(input, key, source, &update);
  if (pass == nullptr) {
    return update;
  }
  if (paused_ && input != kDepth && input != kPose) {
    passOver(input, key, pass);
  } else {
    update.append(marked(add(pass), followers_[input].pass));
    remember(input, key, add);
  }
  previous_changed_ = previous_changed_ || followers_[input].pass != newest_;
  return update;
}

EvaluationUpdate StreamEvaluator::addImage(Stamp stamp) {
  return add(kImage, {stamp, 0}, "",
             [stamp](PassEvaluation* pass) { return pass->addImage(stamp); });
}

EvaluationUpdate StreamEvaluator::addLines(LineSet lines) {
  return add(kLines, {lines.stamp, 0}, lines.source,
             [&](PassEvaluation* pass) { return pass->addLines(std::move(lines)); });
}

EvaluationUpdate StreamEvaluator::addGroundTruth(const LineSet& ground_truth) {
  return add(kGroundTruth, {ground_truth.stamp, 0}, ground_truth.source,
             [ground_truth](PassEvaluation* pass) { return pass->addGroundTruth(ground_truth); });
}

EvaluationUpdate StreamEvaluator::addMatches(const MatchSet& matches) {
  return add(kMatches, {matches.stamp, matches.first_stamp}, matches.source,
             [matches](PassEvaluation* pass) { return pass->addMatches(matches); });
}

EvaluationUpdate StreamEvaluator::setCamera(const Camera& camera) {
  camera_ = camera;
  EvaluationUpdate update;
  for (auto& [number, pass] : passes_) {
    update.append(marked(pass.setCamera(camera), number));
  }
  return update;
}

EvaluationUpdate StreamEvaluator::addDepth(Stamp stamp, const DepthMap& depth) {
  return add(kDepth, {stamp, 0}, "",
             [stamp, depth](PassEvaluation* pass) { return pass->addDepth(stamp, depth); });
}

EvaluationUpdate StreamEvaluator::addPose(const StampedPose& pose) {
  return add(kPose, {pose.stamp, 0}, "", [pose](PassEvaluation* to) { return to->addPose(pose); });
}

PassEvaluation* StreamEvaluator::passOf(std::uint64_t generation, int pass) {
  const auto found = generation == generation_ ? passes_.find(pass) : passes_.end();
  return found == passes_.end() ? nullptr : &found->second;
}

EvaluationUpdate StreamEvaluator::addResult(const EvaluationResult& result) {
  PassEvaluation* pass = passOf(result.generation, result.pass);
  if (pass == nullptr) {
    return {};
  }
  previous_changed_ = previous_changed_ || result.pass != newest_;
  return pass->addResult(result);
}

void StreamEvaluator::skip(const EvaluationTask& task) {
  if (PassEvaluation* pass = passOf(task.generation, task.pass)) {
    pass->skip(task);
    previous_changed_ = previous_changed_ || task.pass != newest_;
  }
}

Report StreamEvaluator::report(bool complete) const {
  Report report = current().report(complete);
  report.pass = newest_;
  return report;
}

const PassEvaluation* StreamEvaluator::previous() const {
  const auto found = passes_.find(newest_ - 1);
  return found == passes_.end() ? nullptr : &found->second;
}

std::optional<Report> StreamEvaluator::previousReport() const {
  if (previous() == nullptr) {
    return std::nullopt;
  }
  Report report = previous()->report(true);
  report.pass = newest_ - 1;
  return report;
}

std::optional<std::pair<int, PassEvaluation>> StreamEvaluator::takeReleased() {
  return std::exchange(released_, std::nullopt);
}

std::optional<Report> StreamEvaluator::takeReleasedReport() {
  const std::optional<std::pair<int, PassEvaluation>> released = takeReleased();
  if (!released) {
    return std::nullopt;
  }
  Report report = released->second.report(true);
  report.pass = released->first;
  return report;
}

bool StreamEvaluator::hasPendingTasks() const {
  return std::any_of(passes_.begin(), passes_.end(),
                     [](const auto& pass) { return pass.second.hasPendingTasks(); });
}

bool StreamEvaluator::waiting(const MayCome& may_come) const {
  return current().waiting(may_come) || hasPendingTasks();
}

void StreamEvaluator::reset() {
  const std::uint64_t generation = generation_ + 1;
  const std::optional<Camera> camera = camera_;
  const bool paused = paused_;
  *this = StreamEvaluator(options_);
  generation_ = generation;
  paused_ = paused;
  if (camera) {
    setCamera(*camera);
  }
}

}  // namespace evolin
