// The base of our nodelets: messages and timers may come while it starts, and it may be unloaded
// while its callbacks run.
#pragma once

#include <nodelet/nodelet.h>

#include <boost/shared_ptr.hpp>
#include <memory>
#include <mutex>

#include "gate_queue.h"

namespace nodelet::detail {
class CallbackQueue;
}

namespace evolin::ros_shell {

/// A manager drops the callback queues of a nodelet at once when it is told to unload it, although
/// a callback that runs keeps the nodelet itself, and with it its subscriptions and timers, alive
/// until it returns. This base keeps the queues, too, for as long as anything can deliver to them.
///
/// While a nodelet starts, the manager throws away what comes to its queues. A timer one of whose
/// calls is thrown away never fires again, and a subscription is late by one message from then on.
/// Here everything waits until the nodelet has started.
class SafeNodelet : public nodelet::Nodelet {
 public:
  SafeNodelet();
  ~SafeNodelet() override;
  SafeNodelet(const SafeNodelet&) = delete;
  SafeNodelet& operator=(const SafeNodelet&) = delete;
  SafeNodelet(SafeNodelet&&) = delete;
  SafeNodelet& operator=(SafeNodelet&&) = delete;

 protected:
  /// Before start(), without the lock of the libraries: what may have to wait for other nodelets to
  /// go, who need that lock. Errors as in start().
  virtual void prepare() {}

  /// Reads parameters, advertises, subscribes. What it throws is logged as fatal and refuses the
  /// nodelet.
  virtual void start() = 0;

  /// Held while libraries of plug-ins (ours, or transports of images) are loaded or unloaded: in
  /// one thread of the process at a time, since class_loader's own list of them is not safe.
  /// start() has it; so must what loads later, before any other lock.
  using LibraryLock = std::unique_lock<std::recursive_mutex>;
  [[nodiscard]] static LibraryLock lockLibraries();

  /// The last thing in the destructor of a nodelet that holds plug-ins or transports: they unload
  /// with its members, on whatever thread has let go of the nodelet last.
  void unloadLast() { unloading_ = lockLibraries(); }

 private:
  void onInit() final;
  void closeGates();

  LibraryLock unloading_;  ///< until all members of the classes that derive are gone

  // A base's members outlive those of the classes that derive from it.
  boost::shared_ptr<nodelet::detail::CallbackQueue> single_threaded_queue_;
  boost::shared_ptr<nodelet::detail::CallbackQueue> multi_threaded_queue_;
  std::unique_ptr<GateQueue> single_threaded_gate_;
  std::unique_ptr<GateQueue> multi_threaded_gate_;
};

}  // namespace evolin::ros_shell
