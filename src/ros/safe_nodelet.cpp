// Holding a nodelet's queues, and telling why it does not start.
#include "safe_nodelet.h"

#include <nodelet/detail/callback_queue.h>

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

void SafeNodelet::onInit() {
  single_threaded_queue_ = hold(getSTCallbackQueue());
  multi_threaded_queue_ = hold(getMTCallbackQueue());
  try {
    const LibraryLock lock = lockLibraries();
    start();
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }
}

}  // namespace evolin::ros_shell
