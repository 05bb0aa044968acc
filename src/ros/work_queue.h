// One thread that works items off in order, behind a queue that drops its oldest when it is full.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace evolin::ros_shell {

/// Safe for several threads. The thread begins with the first item.
template <class Item>
class WorkQueue {
 public:
  /// `capacity`: items that may wait, 0 for any number. `work` is called on the queue's thread and
  /// must not throw.
  WorkQueue(std::size_t capacity, std::function<void(Item)> work)
      : capacity_(capacity), work_(std::move(work)) {}

  ~WorkQueue() { stop(); }
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Returns the older items that had to give way, oldest first.
  std::vector<Item> push(Item item) {
    std::vector<Item> dropped;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (stopping_) {
        return dropped;
      }
      if (!thread_.joinable()) {
        thread_ = std::thread([this] { run(); });
      }
      items_.push_back(std::move(item));
      while (capacity_ > 0 && items_.size() > capacity_) {
        dropped.push_back(std::move(items_.front()));
        items_.pop_front();
      }
    }
    changed_.notify_one();
    return dropped;
  }

  /// Forgets what waits; returns how many items that were.
  std::size_t clear() {
    std::deque<Item> forgotten;
    const std::lock_guard<std::mutex> lock(mutex_);
    forgotten.swap(items_);
    return forgotten.size();
  }

  /// Lets the item that is worked on end; those that wait are forgotten, as are all to come.
  void stop() {
    std::thread thread;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopping_ = true;
      thread.swap(thread_);
    }
    changed_.notify_all();
    if (thread.joinable()) {
      thread.join();
    }
  }

  std::size_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return items_.size();
  }

  std::size_t capacity() const { return capacity_; }

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return stopping_ || !items_.empty(); });
      if (stopping_) {
        return;
      }
      Item item = std::move(items_.front());
      items_.pop_front();
      lock.unlock();
      work_(std::move(item));
      lock.lock();
    }
  }

  const std::size_t capacity_;
  const std::function<void(Item)> work_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace evolin::ros_shell
