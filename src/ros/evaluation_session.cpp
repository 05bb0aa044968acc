// Nothing that asks the parameter server or the disk runs under the evaluation's lock.
#include "evaluation_session.h"

#include <algorithm>

#include "evolin_ros/evaluation/report_confidence.h"
#include "evolin_ros/evaluation/report_curves.h"
#include "node_parameters.h"

namespace evolin::ros_shell {

EvaluationSession::EvaluationSession(ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                                     const EvaluatorOptions& options, const std::string& owner,
                                     Log log)
    : options_(options),
      handle_(handle),
      private_handle_(private_handle),
      log_(std::move(log)),
      keeper_(options.output_dir, owner),
      metrics_(handle, options.pass),
      evaluator_(options.pass),
      last_input_(ros::WallTime::now()),
      worker_({options.pass.evaluation.heatmap, options.pass.motion.pose_method},
              static_cast<std::size_t>(options.task_queue),
              [this](const EvaluationResult& result) { onResult(result); }) {}

void EvaluationSession::noteInput(bool of_frame) {
  if (of_frame) {
    const ros::WallTime now = ros::WallTime::now();
    if (inputs_ > 0) {
      longest_gap_ = std::max(longest_gap_, (now - last_input_).toSec());
    }
    last_input_ = now;
  }
  ++inputs_;
}

/// Gives the update's tasks to the worker; what does not fit is counted.
void EvaluationSession::handOut(EvaluationUpdate* update) {
  for (const EvaluationTask& task : std::exchange(update->tasks, {})) {
    if (worker_.add(task)) {
      continue;
    }
    evaluator_.skip(task);
    if (!queue_told_) {
      queue_told_ = true;
      log_.warning(std::to_string(options_.task_queue) +
                   " heatmaps and pose estimates wait already: what comes is left out and counted "
                   "in coverage; play slower, or raise ~task_queue, or take them out of ~metrics");
    }
  }
}

void EvaluationSession::onResult(const EvaluationResult& result) {
  EvaluationUpdate update;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_input_ = ros::WallTime::now();
    ++inputs_;
    update = evaluator_.addResult(result);
    metrics_.publish(update, last_header_);
  }
  for (const std::string& note : update.notes) {
    log_.warning(note);
  }
}

void EvaluationSession::publishSums(bool now) {
  const std::lock_guard<std::mutex> one_at_a_time(sums_mutex_);
  const ros::WallTime begin = ros::WallTime::now();
  std::optional<PassSums> sums;
  std_msgs::Header header;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (inputs_ == published_inputs_ || (!now && begin < next_sums_)) {
      return;
    }
    published_inputs_ = inputs_;
    sums = evaluator_.current().sums();
    header = last_header_;
  }
  metrics_.publishSums(*sums, header);
  // On a long run the sums must not take the inputs' time.
  constexpr double kShare = 20;
  const ros::WallTime end = ros::WallTime::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  next_sums_ = end + (end - begin) * kShare;
}

/// Parameters of a method may be set for its next settings while a pass is of the old ones; what
/// stands there when a pass begins is what it is of.
void EvaluationSession::keepParameters(int pass) {
  {
    const std::lock_guard<std::mutex> lock(parameters_mutex_);
    if (options_.record_parameters.empty() || parameters_.count(pass) != 0) {
      return;
    }
  }
  std::map<std::string, std::string> texts;
  for (const std::string& name : options_.record_parameters) {
    const std::string resolved = handle_.resolveName(name);
    texts["parameters of " + resolved] = parametersAsJson(resolved);
  }
  const std::lock_guard<std::mutex> lock(parameters_mutex_);
  parameters_[pass] = std::move(texts);
  // The session writes the two newest passes, and those that wait to be written.
  constexpr int kKept = 100;
  parameters_.erase(parameters_.begin(), parameters_.lower_bound(pass - kKept));
}

/// What a report must carry to be understood later.
void EvaluationSession::addProvenance(Report* report) const {
  int images = 0;
  if (private_handle_.getParam("input/images", images) && images >= 0) {
    report->input_images = static_cast<std::size_t>(images);
  }
  report->provenance["parameters"] = parametersAsJson(private_handle_.getNamespace());
  {
    const std::lock_guard<std::mutex> lock(parameters_mutex_);
    const auto kept = parameters_.find(report->pass);
    if (kept != parameters_.end()) {
      report->provenance.insert(kept->second.begin(), kept->second.end());
      return;
    }
  }
  for (const std::string& name : options_.record_parameters) {
    const std::string resolved = handle_.resolveName(name);
    report->provenance["parameters of " + resolved] = parametersAsJson(resolved);
  }
}

std::filesystem::path EvaluationSession::write(Report report) {
  addProvenance(&report);
  int newest = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest = evaluator_.pass();
  }
  return keeper_.write(std::move(report), newest);
}

/// Under save_mutex_. Reports are put together from copies, so that inputs need not wait.
void EvaluationSession::writeFinished() {
  while (true) {
    std::optional<std::pair<int, PassEvaluation>> finished;
    bool released = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      previous_unwritten_ = evaluator_.takePreviousChanged() || previous_unwritten_;
      released = !released_.empty();
      if (released) {
        finished = std::move(released_.front());
        released_.pop_front();
      } else if (previous_unwritten_ && evaluator_.previous() != nullptr) {
        finished.emplace(evaluator_.pass() - 1, *evaluator_.previous());
        previous_unwritten_ = false;
        written_passes_ = finished->first;
      }
    }
    if (!finished) {
      return;
    }
    try {
      Report report = finished->second.report(true);
      report.pass = finished->first;
      write(std::move(report));
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (released) {
        released_.push_front(std::move(*finished));
      } else {
        previous_unwritten_ = true;
      }
      throw;
    }
  }
}

EvaluationSession::~EvaluationSession() {
  try {
    const std::lock_guard<std::mutex> one_at_a_time(save_mutex_);
    writeFinished();
  } catch (const std::exception& error) {
    log_.error(error.what());
  }
}

std::filesystem::path EvaluationSession::save(bool complete, bool confidence) {
  // Written in the order in which they are built: a snapshot must not land on a final report.
  const std::lock_guard<std::mutex> one_at_a_time(save_mutex_);
  return saveNewest(complete, confidence);
}

std::filesystem::path EvaluationSession::saveNewest(bool complete, bool confidence) {
  writeFinished();
  std::optional<std::pair<int, PassEvaluation>> newest;
  std::size_t inputs = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest.emplace(evaluator_.pass(), evaluator_.current());
    inputs = inputs_;
  }
  Report report = newest->second.report(complete);
  report.pass = newest->first;
  if (confidence) {
    addCurves(newest->second.evaluator().detection(), &report);
  }
  if (confidence && options_.bootstrap.resamples > 0) {
    addConfidence(newest->second.evaluator().detection(), options_.bootstrap, &report);
  }
  newest.reset();
  std::filesystem::path file = write(std::move(report));
  const std::lock_guard<std::mutex> lock(mutex_);
  saved_inputs_ = inputs;
  return file;
}

std::string EvaluationSession::reportAsJson() {
  std::optional<std::pair<int, PassEvaluation>> newest;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest.emplace(evaluator_.pass(), evaluator_.current());
  }
  Report report = newest->second.report(false);
  report.pass = newest->first;
  addProvenance(&report);
  return toJson(report);
}

void EvaluationSession::pause(bool paused) {
  const std::lock_guard<std::mutex> lock(mutex_);
  evaluator_.pause(paused);
}

std::pair<CoverageCounts, bool> EvaluationSession::coverage() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {evaluator_.coverage(), evaluator_.isPaused()};
}

void EvaluationSession::saveChanges() {
  // Before the look: the final report may be on its way, with all that has come. What comes while
  // another writes waits for the next period, so that no thread of the manager stands still.
  const std::unique_lock<std::mutex> one_at_a_time(save_mutex_, std::try_to_lock);
  if (!one_at_a_time) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (inputs_ == saved_inputs_) {
      return;
    }
  }
  try {
    saveNewest(false, false);
  } catch (const std::exception& error) {
    if (errors_.due()) {
      log_.error(error.what());
    }
  }
}

void EvaluationSession::saveWhenIdle() {
  double idle = 0;
  bool finished = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    // A pass that is over changes with its last parts: those may wait for the next saving.
    finished = !released_.empty() || written_passes_ < evaluator_.pass() - 1;
    idle = (ros::WallTime::now() - last_input_).toSec();
  }
  if (finished) {
    try {
      const std::unique_lock<std::mutex> one_at_a_time(save_mutex_, std::try_to_lock);
      if (one_at_a_time) {
        writeFinished();
      }
    } catch (const std::exception& error) {
      if (errors_.due()) {
        log_.error(error.what());
      }
    }
  }
  if (idle > options_.idle_timeout) {
    saveChanges();
  }
}

bool EvaluationSession::drain(const std::function<bool()>& stopped,
                              const std::function<MayCome()>& may_come) {
  const bool all = waitForTheRest(stopped, may_come);
  giveUpTasks();
  return all;
}

bool EvaluationSession::waitForTheRest(const std::function<bool()>& stopped,
                                       const std::function<MayCome()>& may_come) {
  constexpr double kSettled = 0.3;
  // A slow method's next result may be a few of its longest pauses away.
  constexpr double kPauses = 4;
  constexpr double kLongest = 30;
  while (!stopped()) {
    const MayCome awaited = may_come();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const double idle = (ros::WallTime::now() - last_input_).toSec();
      const double patience =
          std::max(options_.drain_timeout, std::min(kPauses * longest_gap_, kLongest));
      if (idle > (evaluator_.waiting(awaited) ? patience : kSettled)) {
        return true;
      }
    }
    ros::WallDuration(0.02).sleep();
  }
  return false;
}

void EvaluationSession::giveUpTasks() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!evaluator_.hasPendingTasks()) {
      return;
    }
  }
  const std::vector<EvaluationTask> left = worker_.cancel();
  if (left.empty()) {
    return;
  }
  const std::string text =
      std::to_string(left.size()) +
      " heatmaps and pose estimates still waited at the end; they are left out and counted in "
      "coverage: lower ~heatmap_budget, or raise ~drain_timeout";
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const EvaluationTask& task : left) {
      evaluator_.skip(task);
    }
    evaluator_.addNote(text);
  }
  log_.warning(text);
}

void EvaluationSession::reset() {
  worker_.cancel();  // what it brings is of the figures that are forgotten
  {
    const std::scoped_lock lock(save_mutex_, mutex_);
    evaluator_.reset();
    released_.clear();
    previous_unwritten_ = false;
    written_passes_ = 0;
    queue_told_ = false;
    keeper_.startOver();
    longest_gap_ = 0;
    last_header_ = {};
    published_inputs_.reset();
  }
  {
    const std::lock_guard<std::mutex> lock(parameters_mutex_);
    parameters_.clear();
  }
  // What is latched is of figures that are forgotten.
  publishSums(true);
}

}  // namespace evolin::ros_shell
