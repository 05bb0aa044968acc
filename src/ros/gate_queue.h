// A callback queue that keeps what comes until it is opened.
#pragma once

#include <ros/callback_queue_interface.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <deque>
#include <mutex>

namespace evolin::ros_shell {

/// Stands before `target`. Closed at first: callbacks wait here. From open() on they go straight
/// through, those that waited before all others. Safe for any number of threads.
class GateQueue : public ros::CallbackQueueInterface {
 public:
  explicit GateQueue(boost::shared_ptr<ros::CallbackQueueInterface> target);

  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner_id) override;

  /// Also waits for those of them that run, as the target does.
  void removeByID(std::uint64_t owner_id) override;

  void open();

 private:
  struct Waiting {
    ros::CallbackInterfacePtr callback;
    std::uint64_t owner_id;
  };

  boost::shared_ptr<ros::CallbackQueueInterface> target_;
  std::mutex mutex_;
  bool open_ = false;
  std::deque<Waiting> waiting_;
};

}  // namespace evolin::ros_shell
