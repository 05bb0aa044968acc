// What nodelets share that turn foreign messages into lines of an image: they wait for the camera,
// hold messages back until it is known, and count what they refuse.
#pragma once

#include <evolin_ros/LineArray.h>
#include <ros/message_traits.h>

#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "adapter_camera.h"
#include "conversions.h"
#include "evolin_ros/base/parameters.h"
#include "health.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

/// All callbacks share the single-threaded queue, so that nothing needs a lock.
template <class Message>
class CameraAdapter : public SafeNodelet {
 protected:
  using MessagePtr = boost::shared_ptr<const Message>;

  /// Publishes what comes of a message; what it throws refuses the message.
  virtual void convert(const Message& message, const AdapterView& view) = 0;

  /// Reads ~camera, ~frame_id, ~source, ~queue_size, ~warn_after, ~diagnostics and
  /// ~diagnostic_period.
  void readCommon(ParameterReader* reader) {
    reader->read("camera", &camera_options_.camera);
    reader->read("frame_id", &camera_options_.frame_id);
    reader->read("source", &source_);
    reader->read("queue_size", &queue_size_, 1, 100000);
    reader->read("warn_after", &warn_after_, 0, 1e6);
    health_ = std::make_unique<Health>(getName(), readHealthLimits(reader, getName()));
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), warn_after_);
  }

  /// The messages of `type` on `topic` are missed when they do not come, with `hint` what to do,
  /// and how they fare stands on /diagnostics from now on: see heard() and finished().
  void startHealth(const std::string& topic, const std::string& type, const std::string& hint) {
    topic_ = getNodeHandle().resolveName(topic);
    watchdog_->expect(topic_, type, hint);
    health_->expect(topic_);
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
  }

  void heard() {
    watchdog_->heard(topic_);
    health_->heard(topic_);
  }

  /// What came of a message is out; `begin`: when it came.
  void finished(const ros::WallTime& begin) {
    const double seconds = (ros::WallTime::now() - begin).toSec();
    health_->finished(seconds, seconds);
  }

  /// Subscribes to `topic` and the camera, advertises the lines.
  void begin(const std::string& topic, AdapterPixels pixels, const std::string& hint) {
    ros::NodeHandle& handle = getNodeHandle();
    lines_ = handle.advertise<evolin_ros::LineArray>(topics::kLines, kResultQueue);
    camera_options_.pixels = pixels;
    camera_ = std::make_unique<AdapterCamera>(
        handle, camera_options_,
        AdapterCamera::Callbacks{[this] { release(); },
                                 [this](const std::string& why) { onUnusableCamera(why); }});
    if (camera_->isAwaited()) {
      watchdog_->expect(handle.resolveName(topics::kCameraInfo), "sensor_msgs/CameraInfo",
                        "Remap 'camera_info', or set ~camera to a preset or file.");
    }
    startHealth(topic, ros::message_traits::datatype<Message>(), hint);
    input_ = handle.subscribe(topic, kResultQueue, &CameraAdapter::onMessage, this);
    NODELET_INFO("lines of %s as '%s', waiting for it%s", topic_.c_str(), source_.c_str(),
                 camera_->isAwaited() ? " and for camera_info" : "");
  }

  /// First in the destructor of a class that derives: convert() is not called any more.
  void end() {
    if (health_) {
      health_->stop();
    }
    input_.shutdown();
    if (camera_) {
      camera_->stop();
    }
  }

  /// `set` with stamp, frame, source and the view's size filled in.
  void publish(LineSet* set, const ros::Time& stamp, const AdapterView& view) {
    set->stamp = fromRos(stamp);
    set->frame_id = view.frame_id;
    set->source = source_;
    set->width = view.view.size().width;
    set->height = view.view.size().height;
    lines_.publish(boost::make_shared<evolin_ros::LineArray>(toMessage(*set)));
  }

  /// Something of a message had to be left out.
  void warn(const std::string& text) {
    if (warnings_.due()) {
      NODELET_WARN("%s: %s", topic_.c_str(), text.c_str());
    }
  }

  std::string source_;

 private:
  void onMessage(const MessagePtr& message) {
    heard();
    if (camera_->view() != nullptr) {
      take(*message);
      return;
    }
    held_.push_back(message);
    if (held_.size() > static_cast<std::size_t>(queue_size_)) {
      held_.pop_front();
      ++lost_;
      health_->dropped("before the camera was known");
      if (warnings_.due()) {
        NODELET_WARN(
            "%s: there is no usable camera on %s yet; of the messages the newest %d are held back, "
            "given up: %zu",
            topic_.c_str(), getNodeHandle().resolveName(topics::kCameraInfo).c_str(), queue_size_,
            lost_);
      }
    }
  }

  void release() {
    watchdog_->heard(getNodeHandle().resolveName(topics::kCameraInfo));
    if (lost_ > 0) {
      NODELET_WARN("%s: messages that came before the camera was known and were given up: %zu",
                   topic_.c_str(), lost_);
    }
    for (const MessagePtr& message : held_) {
      take(*message);
    }
    held_.clear();
  }

  void onUnusableCamera(const std::string& why) {
    watchdog_->heard(getNodeHandle().resolveName(topics::kCameraInfo));
    // Once: it comes with every image.
    if (std::exchange(camera_problem_, why) != why) {
      NODELET_ERROR("%s: %s", getNodeHandle().resolveName(topics::kCameraInfo).c_str(),
                    why.c_str());
    }
  }

  void take(const Message& message) {
    const ros::WallTime begin = ros::WallTime::now();
    try {
      convert(message, *camera_->view());
      finished(begin);
    } catch (const std::exception& error) {
      ++refused_;
      health_->dropped("refused");
      if (errors_.due()) {
        NODELET_ERROR("%s: message at %.6f refused (%zu so far): %s", topic_.c_str(),
                      message.header.stamp.toSec(), refused_, error.what());
      }
    }
  }

  AdapterCamera::Options camera_options_;
  int queue_size_ = 100;
  double warn_after_ = 3;
  std::string topic_;
  std::deque<MessagePtr> held_;
  std::size_t lost_ = 0;
  std::size_t refused_ = 0;
  WallThrottle warnings_;
  WallThrottle errors_;
  std::string camera_problem_;  ///< of the newest camera_info that could not be used
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<AdapterCamera> camera_;
  ros::Publisher lines_;
  ros::Subscriber input_;
};

}  // namespace evolin::ros_shell
