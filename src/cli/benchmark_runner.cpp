// A queue of tasks, and processes that are waited for together.
#include "benchmark_runner.h"

#include <poll.h>

#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "child_process.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/benchmarking/task_queue.h"
#include "interrupt.h"

namespace evolin::cli {

namespace {

enum class Kind { kSequence, kDetection, kCell };

struct Work {
  Kind kind = Kind::kCell;
  std::size_t place = 0;
};

class Runner {
 public:
  Runner(const BenchmarkContext& context, const RunnerOptions& options,
         std::function<void(std::size_t)> changed)
      : context_(context), options_(options), changed_(std::move(changed)) {}

  std::optional<std::size_t> addSequence(std::size_t sequence) {
    if (isSequenceMade(context_, sequence)) {
      return std::nullopt;
    }
    return addOnce(Kind::kSequence, sequence, std::nullopt);
  }

  std::optional<std::size_t> addDetection(std::size_t detection) {
    if (isDetectionMade(context_, detection)) {
      return std::nullopt;
    }
    return addOnce(Kind::kDetection, detection,
                   addSequence(context_.plan.detections[detection].sequence));
  }

  void addCell(std::size_t cell) {
    const std::optional<std::size_t>& detection = context_.plan.cells[cell].detection;
    std::optional<std::size_t> after =
        detection ? addDetection(*detection) : std::optional<std::size_t>();
    if (!after) {
      after = addSequence(context_.matrix.cells[cell].sequence);
    }
    addOnce(Kind::kCell, cell, after);
  }

  /// False when the user interrupted.
  bool run() {
    const InterruptGuard guard;
    bool told = false;
    while (!children_.empty() || (queue_.busy() && !guard.interrupted())) {
      if (guard.interrupted() && !told) {
        told = true;
        for (const auto& [task, child] : children_) {
          child->process.interrupt();
        }
      }
      if (!guard.interrupted()) {
        startWhatMay();
      }
      wait();
      collect(guard);
    }
    return !guard.interrupted();
  }

  const std::string& firstFailure() const { return first_failure_; }

 private:
  struct Child {
    explicit Child(const std::function<std::string()>& work) : process(work) {}
    ChildProcess process;
    StopWatch watch;
  };

  std::size_t addOnce(Kind kind, std::size_t place, std::optional<std::size_t> after) {
    const auto [entry, is_new] = tasks_.try_emplace({kind, place}, works_.size());
    if (is_new) {
      works_.push_back({kind, place});
      queue_.add(after);
    }
    return entry->second;
  }

  void startWhatMay() {
    while (children_.size() < static_cast<std::size_t>(options_.jobs)) {
      const std::optional<std::size_t> task = queue_.next();
      if (!task) {
        return;
      }
      const Work work = works_[*task];
      children_.emplace(*task, std::make_unique<Child>([this, work] {
        perform(work);
        return std::string();
      }));
    }
  }

  void perform(const Work& work) const {
    switch (work.kind) {
      case Kind::kSequence:
        return makeSequence(context_, work.place);
      case Kind::kDetection:
        return makeDetection(context_, work.place);
      case Kind::kCell:
        return runCell(context_, work.place);
    }
  }

  /// Until a process has something to say, or for a moment: a signal may come just before.
  void wait() const {
    constexpr int kMoment = 200;  // ms
    std::vector<pollfd> descriptors;
    for (const auto& [task, child] : children_) {
      descriptors.push_back({child->process.descriptor(), POLLIN, 0});
    }
    poll(descriptors.data(), descriptors.size(), kMoment);
  }

  void collect(const InterruptGuard& guard) {
    for (auto child = children_.begin(); child != children_.end();) {
      pollfd descriptor = {child->second->process.descriptor(), POLLIN, 0};
      if (poll(&descriptor, 1, 0) <= 0 || !child->second->process.advance()) {
        ++child;
        continue;
      }
      const ChildResult result = child->second->process.result();
      const double seconds = child->second->watch.seconds();
      const std::size_t task = child->first;
      child = children_.erase(child);
      if (result.done) {
        queue_.finish(task);
        tell(works_[task], "finished", seconds, "");
        note(works_[task]);
      } else if (!guard.interrupted()) {
        fail(task, result.text, seconds);
      }
    }
  }

  void fail(std::size_t task, const std::string& why, double seconds) {
    if (first_failure_.empty()) {
      first_failure_ = nameOf(works_[task]) + ": " + why;
    }
    tell(works_[task], "FAILED", seconds, ": " + why);
    recordFailure(works_[task], why);
    for (const std::size_t lost : queue_.fail(task)) {
      ++ended_;  // its failure is told with the one behind which it waited
      recordFailure(works_[lost], nameOf(works_[task]) + ": " + why);
    }
  }

  void recordFailure(const Work& work, const std::string& why) {
    if (work.kind == Kind::kCell) {
      recordCell(context_, work.place, CellState::kFailed, why);
    }
    note(work);
  }

  void note(const Work& work) const {
    if (work.kind == Kind::kCell) {
      changed_(work.place);
    }
  }

  std::string nameOf(const Work& work) const {
    switch (work.kind) {
      case Kind::kSequence:
        return "sequence " + context_.matrix.sequences[work.place].name;
      case Kind::kDetection:
        return "detection " + context_.plan.detections[work.place].id;
      case Kind::kCell:
        break;
    }
    return context_.matrix.cells[work.place].id;
  }

  void tell(const Work& work, const std::string& what, double seconds, const std::string& more) {
    ++ended_;
    if (!options_.quiet) {
      char time[32];
      std::snprintf(time, sizeof time, " in %.1f s", seconds);
      std::cerr << "[" << ended_ << "/" << works_.size() << "] " << nameOf(work) << " " << what
                << time << more << std::endl;
    }
  }

  const BenchmarkContext& context_;
  const RunnerOptions& options_;
  std::function<void(std::size_t)> changed_;
  TaskQueue queue_;
  std::vector<Work> works_;  ///< by task
  std::map<std::pair<Kind, std::size_t>, std::size_t> tasks_;
  std::map<std::size_t, std::unique_ptr<Child>> children_;  ///< by task
  std::string first_failure_;
  std::size_t ended_ = 0;
};

}  // namespace

bool runCells(const BenchmarkContext& context, const std::vector<std::size_t>& places,
              const RunnerOptions& options, const std::function<void(std::size_t)>& changed) {
  Runner runner(context, options, changed);
  for (const std::size_t place : places) {
    runner.addCell(place);
  }
  return runner.run();
}

bool runDetections(const BenchmarkContext& context, const std::vector<std::size_t>& detections,
                   const RunnerOptions& options) {
  Runner runner(context, options, [](std::size_t /*cell*/) {});
  for (const std::size_t detection : detections) {
    runner.addDetection(detection);
  }
  const bool complete = runner.run();
  if (complete && !runner.firstFailure().empty()) {
    throw Error(runner.firstFailure());
  }
  return complete;
}

}  // namespace evolin::cli
