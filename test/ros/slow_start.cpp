// The nodelet sends to itself before it has started.
#include "slow_start.h"

#include <nodelet/loader.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include "safe_nodelet.h"

namespace evolin::test {

namespace {

constexpr int kMessages = 3;
constexpr int kTicks = 3;

class SlowStart : public ros_shell::SafeNodelet {
 public:
  bool gotAll() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ticks_ >= kTicks && numbers_.size() == kMessages;
  }

  bool gotTheRightOnes() {
    const std::lock_guard<std::mutex> lock(mutex_);
    bool right = !early_;
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      right = right && numbers_[i] == static_cast<int>(i);
    }
    return right;
  }

 private:
  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    publisher_ = handle.advertise<std_msgs::Int32>("numbers", kMessages);
    subscriber_ = handle.subscribe("numbers", kMessages, &SlowStart::onNumber, this);
    timer_ = getMTNodeHandle().createWallTimer(ros::WallDuration(0.01),
                                               [this](const ros::WallTimerEvent&) { tick(); });
    for (int i = 0; i < kMessages; ++i) {
      std_msgs::Int32 number;
      number.data = i;
      publisher_.publish(number);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the timer is long due
    const std::lock_guard<std::mutex> lock(mutex_);
    early_ = ticks_ > 0 || !numbers_.empty();
  }

  void onNumber(const std_msgs::Int32ConstPtr& number) {
    const std::lock_guard<std::mutex> lock(mutex_);
    numbers_.push_back(number->data);
  }

  void tick() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++ticks_;
  }

  std::mutex mutex_;
  std::vector<int> numbers_;
  int ticks_ = 0;
  bool early_ = false;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
};

}  // namespace

int slowStart() {
  const auto nodelet = boost::make_shared<SlowStart>();
  const boost::function<boost::shared_ptr<nodelet::Nodelet>(const std::string&)> make =
      [&nodelet](const std::string&) { return nodelet; };
  nodelet::Loader loader(make);
  const ros::NodeHandle node;  // keeps the node up between nodelets
  if (!loader.load("/slow", "slow_start", {}, {})) {
    return 3;
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!nodelet->gotAll() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const bool right = nodelet->gotAll() && nodelet->gotTheRightOnes();
  loader.unload("/slow");
  return right ? 0 : 4;
}

}  // namespace evolin::test
