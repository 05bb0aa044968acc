// What waits, and handing it on.
#include "gate_queue.h"

#include <algorithm>
#include <utility>

namespace evolin::ros_shell {

namespace {

// The target's last owner may be a thread of nodelet's, which then frees it. ThreadSanitizer does
// not see the counting of owners that puts this after our last call, as nodelet was not built with
// it; the only access of ours to the target is the look-up of these two functions.

[[gnu::no_sanitize_thread]] void addTo(ros::CallbackQueueInterface* target,
                                       const ros::CallbackInterfacePtr& callback,
                                       std::uint64_t owner_id) {
  target->addCallback(callback, owner_id);
}

[[gnu::no_sanitize_thread]] void removeFrom(ros::CallbackQueueInterface* target,
                                            std::uint64_t owner_id) {
  target->removeByID(owner_id);
}

}  // namespace

GateQueue::GateQueue(boost::shared_ptr<ros::CallbackQueueInterface> target)
    : target_(std::move(target)) {}

void GateQueue::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!open_) {
      waiting_.push_back({callback, owner_id});
      return;
    }
  }
  addTo(target_.get(), callback, owner_id);
}

void GateQueue::removeByID(std::uint64_t owner_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto is_his = [owner_id](const Waiting& waiting) { return waiting.owner_id == owner_id; };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_his), waiting_.end());
  }
  removeFrom(target_.get(), owner_id);
}

void GateQueue::open() {
  const std::lock_guard<std::mutex> lock(mutex_);
  // Adding runs nothing, so that the lock may be held: nobody overtakes.
  for (const Waiting& waiting : waiting_) {
    addTo(target_.get(), waiting.callback, waiting.owner_id);
  }
  waiting_.clear();
  open_ = true;
}

}  // namespace evolin::ros_shell
