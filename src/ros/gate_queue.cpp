// What waits, and handing it on.
#include "gate_queue.h"

#include <algorithm>
#include <utility>

namespace evolin::ros_shell {

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
  target_->addCallback(callback, owner_id);
}

void GateQueue::removeByID(std::uint64_t owner_id) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto is_his = [owner_id](const Waiting& waiting) { return waiting.owner_id == owner_id; };
    waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), is_his), waiting_.end());
  }
  target_->removeByID(owner_id);
}

void GateQueue::open() {
  const std::lock_guard<std::mutex> lock(mutex_);
  // Adding runs nothing, so that the lock may be held: nobody overtakes.
  for (const Waiting& waiting : waiting_) {
    target_->addCallback(waiting.callback, waiting.owner_id);
  }
  waiting_.clear();
  open_ = true;
}

}  // namespace evolin::ros_shell
