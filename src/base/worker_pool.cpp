// One counter that all workers take tasks from, under one lock: tasks take milliseconds.
#include "evolin_ros/base/worker_pool.h"

namespace evolin {

WorkerPool::WorkerPool(int workers) {
  for (int worker = 1; worker < workers; ++worker) {
    threads_.emplace_back([this, worker] { serve(static_cast<std::size_t>(worker)); });
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void WorkerPool::takeTasks(std::size_t worker, std::unique_lock<std::mutex>* lock) {
  while (next_ < tasks_) {
    const std::size_t task = next_++;
    lock->unlock();
    (*work_)(task, worker);
    lock->lock();
    if (++finished_ == tasks_) {
      changed_.notify_all();
    }
  }
}

void WorkerPool::serve(std::size_t worker) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || next_ < tasks_; });
    if (stopping_) {
      return;
    }
    takeTasks(worker, &lock);
  }
}

void WorkerPool::forEach(std::size_t tasks,
                         const std::function<void(std::size_t, std::size_t)>& work) {
  std::unique_lock<std::mutex> lock(mutex_);
  work_ = &work;
  tasks_ = tasks;
  next_ = 0;
  finished_ = 0;
  if (tasks > 1) {
    changed_.notify_all();
  }
  takeTasks(0, &lock);
  changed_.wait(lock, [this] { return finished_ == tasks_; });
  work_ = nullptr;
}

}  // namespace evolin
