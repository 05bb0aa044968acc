// Threads that share out independent pieces of work, over and over.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace evolin {

class WorkerPool {
 public:
  /// The calling thread is one of `workers` (at least 1).
  explicit WorkerPool(int workers);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  std::size_t size() const { return threads_.size() + 1; }

  /// Runs work(task, worker) for every task in [0, tasks) and returns when all are done; tasks
  /// begin in their order, and a worker is never in two calls at a time. `work` must not throw. One
  /// thread at a time.
  void forEach(std::size_t tasks,
               const std::function<void(std::size_t task, std::size_t worker)>& work);

 private:
  void serve(std::size_t worker);
  void takeTasks(std::size_t worker, std::unique_lock<std::mutex>* lock);

  std::mutex mutex_;  ///< guards what follows, up to the threads
  std::condition_variable changed_;
  const std::function<void(std::size_t, std::size_t)>* work_ = nullptr;
  std::size_t tasks_ = 0;
  std::size_t next_ = 0;
  std::size_t finished_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace evolin
