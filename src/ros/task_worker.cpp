// First in, first out.
#include "task_worker.h"

#include <iterator>
#include <utility>

namespace evolin::ros_shell {

TaskWorker::TaskWorker(const TaskOptions& options, std::size_t capacity, Done done)
    : runner_(options, &stop_task_),
      capacity_(capacity),
      done_(std::move(done)),
      thread_([this] { work(); }) {}

TaskWorker::~TaskWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    stop_task_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool TaskWorker::add(EvaluationTask task) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (tasks_.size() >= capacity_) {
      return false;
    }
    tasks_.push_back(std::move(task));
  }
  changed_.notify_all();
  return true;
}

std::vector<EvaluationTask> TaskWorker::cancel() {
  std::unique_lock<std::mutex> lock(mutex_);
  std::vector<EvaluationTask> waiting(std::make_move_iterator(tasks_.begin()),
                                      std::make_move_iterator(tasks_.end()));
  tasks_.clear();
  if (running_) {
    stop_task_ = true;
    const std::uint64_t current = finished_;
    changed_.wait(lock, [&] { return finished_ != current; });
  }
  return waiting;
}

std::size_t TaskWorker::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return tasks_.size();
}

void TaskWorker::work() {
  while (true) {
    EvaluationTask task;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (stopping_) {
        return;
      }
      task = std::move(tasks_.front());
      tasks_.pop_front();
      running_ = true;
      stop_task_ = false;
    }
    done_(runner_.run(task));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      running_ = false;
      ++finished_;
    }
    changed_.notify_all();
  }
}

}  // namespace evolin::ros_shell
