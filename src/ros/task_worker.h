// One thread that does an evaluation's heavy tasks in order, behind a bounded queue.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "evolin_ros/evaluation/task.h"

namespace evolin::ros_shell {

class TaskWorker {
 public:
  using Done = std::function<void(const EvaluationResult&)>;

  /// `capacity`: tasks that may wait. `done` is called on the worker's thread.
  TaskWorker(const TaskOptions& options, std::size_t capacity, Done done);

  /// Breaks the task that runs off; those that wait are forgotten.
  ~TaskWorker();

  TaskWorker(const TaskWorker&) = delete;
  TaskWorker& operator=(const TaskWorker&) = delete;

  /// False, and the task is not taken, when the queue is full.
  bool add(EvaluationTask task);

  /// Tasks that wait.
  std::size_t waiting() const;

  std::size_t capacity() const { return capacity_; }

  /// Takes the tasks that wait, which will not be run, and breaks the one that runs off: its
  /// result, handed to `done` as any other's before this returns, says so. Not from `done` itself,
  /// nor under a lock that it takes.
  std::vector<EvaluationTask> cancel();

 private:
  void work();

  std::atomic<bool> stop_task_{false};
  TaskRunner runner_;
  std::size_t capacity_;
  Done done_;
  mutable std::mutex mutex_;  ///< guards what follows, up to the thread
  std::condition_variable changed_;
  std::deque<EvaluationTask> tasks_;
  bool running_ = false;
  std::uint64_t finished_ = 0;  ///< tasks
  bool stopping_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace evolin::ros_shell
