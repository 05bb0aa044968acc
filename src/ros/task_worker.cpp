// First in, first out.
#include "task_worker.h"

#include <utility>

namespace evolin::ros_shell {

TaskWorker::TaskWorker(const TaskOptions& options, std::size_t capacity, Done done)
    : runner_(options), capacity_(capacity), done_(std::move(done)), thread_([this] { work(); }) {}

TaskWorker::~TaskWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
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

void TaskWorker::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  tasks_.clear();
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
    }
    done_(runner_.run(task));
  }
}

}  // namespace evolin::ros_shell
