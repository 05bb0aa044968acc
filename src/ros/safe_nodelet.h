// The base of our nodelets: it may be unloaded while its callbacks run.
#pragma once

#include <nodelet/nodelet.h>

#include <boost/shared_ptr.hpp>

namespace nodelet::detail {
class CallbackQueue;
}

namespace evolin::ros_shell {

/// A manager drops the callback queues of a nodelet at once when it is told to unload it, although
/// a callback that runs keeps the nodelet itself, and with it its subscriptions and timers, alive
/// until it returns. This base keeps the queues, too, for as long as anything can deliver to them.
class SafeNodelet : public nodelet::Nodelet {
 public:
  SafeNodelet();
  ~SafeNodelet() override;
  SafeNodelet(const SafeNodelet&) = delete;
  SafeNodelet& operator=(const SafeNodelet&) = delete;
  SafeNodelet(SafeNodelet&&) = delete;
  SafeNodelet& operator=(SafeNodelet&&) = delete;

 protected:
  /// Reads parameters, advertises, subscribes. What it throws is logged as fatal and refuses the
  /// nodelet.
  virtual void start() = 0;

 private:
  void onInit() final;

  // A base's members outlive those of the classes that derive from it.
  boost::shared_ptr<nodelet::detail::CallbackQueue> single_threaded_queue_;
  boost::shared_ptr<nodelet::detail::CallbackQueue> multi_threaded_queue_;
};

}  // namespace evolin::ros_shell
