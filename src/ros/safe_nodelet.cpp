// Holding a nodelet's queues, and telling why it does not start.
#include "safe_nodelet.h"

#include <nodelet/detail/callback_queue.h>
#include <ros/node_handle.h>

#include <exception>

namespace evolin::ros_shell {

namespace {

/// None where somebody else than nodelet's own loader hosts the nodelet; his queues are his.
boost::shared_ptr<nodelet::detail::CallbackQueue> hold(ros::CallbackQueueInterface& queue) {
  auto* const held = dynamic_cast<nodelet::detail::CallbackQueue*>(&queue);
  return held == nullptr ? nullptr : held->shared_from_this();
}

}  // namespace

SafeNodelet::SafeNodelet() = default;

SafeNodelet::~SafeNodelet() = default;

SafeNodelet::LibraryLock SafeNodelet::lockLibraries() {
  // One for the process, as class_loader's list is.
  static std::recursive_mutex mutex;
  return LibraryLock(mutex);
}

void SafeNodelet::closeGates() {
  single_threaded_queue_ = hold(getSTCallbackQueue());
  multi_threaded_queue_ = hold(getMTCallbackQueue());
  if (single_threaded_queue_ == nullptr || multi_threaded_queue_ == nullptr) {
    return;
  }
  single_threaded_gate_ = std::make_unique<GateQueue>(single_threaded_queue_);
  multi_threaded_gate_ = std::make_unique<GateQueue>(multi_threaded_queue_);
  getNodeHandle().setCallbackQueue(single_threaded_gate_.get());
  getPrivateNodeHandle().setCallbackQueue(single_threaded_gate_.get());
  getMTNodeHandle().setCallbackQueue(multi_threaded_gate_.get());
  getMTPrivateNodeHandle().setCallbackQueue(multi_threaded_gate_.get());
}

void SafeNodelet::onInit() {
  closeGates();
  try {
    prepare();
    const LibraryLock lock = lockLibraries();
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
  if (single_threaded_gate_ != nullptr) {
    // The loader does so as soon as this returns; before that the queues would drop what waits.
    single_threaded_queue_->enable();
    multi_threaded_queue_->enable();
    single_threaded_gate_->open();
    multi_threaded_gate_->open();
  }
}

}  // namespace evolin::ros_shell
