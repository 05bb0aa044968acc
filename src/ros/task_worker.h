// One thread that does an evaluation's heavy tasks in order, behind a bounded queue.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "evolin_ros/evaluation/task.h"

namespace evolin::ros_shell {

class TaskWorker {
 public:
  using Done = std::function<void(const EvaluationResult&)>;

  /// `capacity`: tasks that may wait. `done` is called on the worker's thread.
  TaskWorker(const TaskOptions& options, std::size_t capacity, Done done);

  /// Lets the task that runs end; those that wait are forgotten.
  ~TaskWorker();

  TaskWorker(const TaskWorker&) = delete;
  TaskWorker& operator=(const TaskWorker&) = delete;

  /// False, and the task is not taken, when the queue is full.
  bool add(EvaluationTask task);

  /// Forgets the tasks that wait.
  void clear();

 private:
  void work();

  TaskRunner runner_;
  std::size_t capacity_;
  Done done_;
  std::mutex mutex_;  ///< guards what follows, up to the thread
  std::condition_variable changed_;
  std::deque<EvaluationTask> tasks_;
  bool stopping_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace evolin::ros_shell
