// The rules that tell a loop from a late or repeated message.
#include "evolin_ros/evaluation/stream_evaluator.h"

#include <algorithm>
#include <utility>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// Results that a front-end of several threads may give out before the first one.
constexpr std::size_t kMostSwapped = 8;

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
  } else if (key == follower.last || key == *follower.received.rbegin()) {
    return std::nullopt;
  } else {
    const bool seen_before = follower.received.count(key) != 0;
    const bool before_all = key < *follower.received.begin();
    if (seen_before || (before_all && !startedOutOfOrder(input, key.first))) {
      // An input that slept through a whole pass must not lag behind for ever.
      follower.pass = std::max(follower.pass + 1, newest_ - 1);
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
  if (follower.received.size() > kMostSwapped) {
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
  const int pass_before = follower.pass;
  const std::optional<int> pass = passOf(input, key);
  const std::string sources = sourcesText(pass_before == 0 ? source : follower.source, source);
  follower.source = source;
  if (!pass) {
    drop(input, kRepeated, "a second message of stamp " + secondsText(key.first) + sources, update);
    return nullptr;
  }
  if (*pass != pass_before && !sources.empty() && told_.insert({input, kSeveralSources}).second) {
    update->warnings.push_back("time jumped back to " + secondsText(key.first) + sources +
                               "; every jump begins a pass of its own");
  }
  if (*pass > newest_) {
    newest_ = *pass;
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
  }
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

template <class Add>
EvaluationUpdate StreamEvaluator::add(Input input, Key key, const std::string& source,
                                      const Add& add) {
  EvaluationUpdate update;
  if (PassEvaluation* pass = enter(input, key, source, &update)) {
    update.append(marked(add(pass), followers_[input].pass));
    previous_changed_ = previous_changed_ || followers_[input].pass != newest_;
  }
  return update;
}

EvaluationUpdate StreamEvaluator::addImage(Stamp stamp) {
  return add(kImage, {stamp, 0}, "", [&](PassEvaluation* pass) { return pass->addImage(stamp); });
}

EvaluationUpdate StreamEvaluator::addLines(LineSet lines) {
  return add(kLines, {lines.stamp, 0}, lines.source,
             [&](PassEvaluation* pass) { return pass->addLines(std::move(lines)); });
}

EvaluationUpdate StreamEvaluator::addGroundTruth(LineSet ground_truth) {
  return add(kGroundTruth, {ground_truth.stamp, 0}, ground_truth.source,
             [&](PassEvaluation* pass) { return pass->addGroundTruth(std::move(ground_truth)); });
}

EvaluationUpdate StreamEvaluator::addMatches(MatchSet matches) {
  return add(kMatches, {matches.stamp, matches.first_stamp}, matches.source,
             [&](PassEvaluation* pass) { return pass->addMatches(std::move(matches)); });
}

EvaluationUpdate StreamEvaluator::setCamera(const Camera& camera) {
  camera_ = camera;
  EvaluationUpdate update;
  for (auto& [number, pass] : passes_) {
    update.append(marked(pass.setCamera(camera), number));
  }
  return update;
}

EvaluationUpdate StreamEvaluator::addDepth(Stamp stamp, DepthMap depth) {
  return add(kDepth, {stamp, 0}, "",
             [&](PassEvaluation* pass) { return pass->addDepth(stamp, std::move(depth)); });
}

EvaluationUpdate StreamEvaluator::addPose(const StampedPose& pose) {
  return add(kPose, {pose.stamp, 0}, "", [&](PassEvaluation* to) { return to->addPose(pose); });
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

bool StreamEvaluator::waiting() const { return current().waiting() || hasPendingTasks(); }

void StreamEvaluator::reset() {
  const std::uint64_t generation = generation_ + 1;
  const std::optional<Camera> camera = camera_;
  *this = StreamEvaluator(options_);
  generation_ = generation;
  if (camera) {
    setCamera(*camera);
  }
}

}  // namespace evolin
