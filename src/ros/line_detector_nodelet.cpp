// The nodelet evolin_ros/LineDetector: images in, lines of any detector plug-in out.
#include <cv_bridge/cv_bridge.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <memory>
#include <mutex>

#include "camera_source.h"
#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/drawing/overlay.h"
#include "node_parameters.h"
#include "plugin_loader.h"
#include "safe_nodelet.h"
#include "sequence_gaps.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class LineDetectorNodelet : public SafeNodelet {
 private:
  struct Options {
    std::string detector = "opencv_lsd";
    std::string config;
    std::string source;
    std::string camera;
    std::string image_transport = "raw";
    int queue_size = kImageQueue;
    bool lazy = true;
    double warn_after = 3;
  };

  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    readOptions();
    NODELET_INFO("detector %s, waiting for %s%s", options_.detector.c_str(),
                 handle.resolveName(topics::kImage).c_str(),
                 options_.lazy ? " (subscribed once somebody listens to the lines)" : "");
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);

    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    lines_image_ = image_transport_->advertise(topics::kLinesImage, 1, on_listener, on_listener);
    lines_ = handle.advertise<evolin_ros::LineArray>(topics::kLines, kResultQueue, on_listener,
                                                     on_listener);
    // Of listeners that the topic has already, for the sake of another nodelet in this manager,
    // older releases of roscpp do not tell.
    if (!options_.lazy || hasListener()) {
      subscribe();
    }
  }

  void readOptions() {
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    reader.read("detector", &options_.detector);
    reader.read("config", &options_.config);
    reader.read("source", &options_.source);
    reader.read("camera", &options_.camera);
    reader.read("image_transport", &options_.image_transport);
    reader.read("queue_size", &options_.queue_size, 1, 100000);
    reader.read("lazy", &options_.lazy);
    reader.read("warn_after", &options_.warn_after, 0, 1e6);
    const YAML::Node overrides = reader.readMap("parameters");
    reader.finish();
    if (options_.source.empty()) {
      options_.source = options_.detector;
    }
    detector_ = loader_.loadDetector(options_.detector);
    configureDetector(mergedParameters(options_.config, overrides));
    camera_ = std::make_unique<CameraSource>(getNodeHandle(), "detector " + options_.detector,
                                             detector_->needs(), options_.camera);
  }

  /// Where the build, for its OpenCV's sake, lacks the detector, the error names those that run.
  void configureDetector(const YAML::Node& parameters) {
    try {
      detector_->configure(parameters);
    } catch (const UnavailableError& error) {
      std::string others;
      for (const PluginInfo& info : loader_.listDetectors()) {
        if (info.why_unavailable.empty()) {
          others += (others.empty() ? "" : ", ") + info.name;
        }
      }
      throw UnavailableError(std::string(error.what()) + "; available for ~detector: " + others);
    }
  }

  bool hasListener() const {
    return lines_.getNumSubscribers() > 0 || lines_image_.getNumSubscribers() > 0;
  }

  /// Called at every change of listeners, from any thread.
  void connect() {
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    if (!options_.lazy) {
      return;
    }
    const bool wanted = hasListener();
    if (wanted && !image_) {
      subscribe();
    } else if (!wanted && image_) {
      watchdog_->forget(getNodeHandle().resolveName(topics::kImage));
      image_.shutdown();
      image_ = image_transport::Subscriber();
    }
  }

  void subscribe() {
    watchdog_->expect(getNodeHandle().resolveName(topics::kImage), "sensor_msgs/Image",
                      "Remap 'image' to the camera's topic.");
    image_ = image_transport_->subscribe(
        topics::kImage, static_cast<std::uint32_t>(options_.queue_size),
        &LineDetectorNodelet::onImage, this,
        image_transport::TransportHints(options_.image_transport, ros::TransportHints(),
                                        getPrivateNodeHandle()));
  }

  void onImage(const sensor_msgs::ImageConstPtr& message) {
    watchdog_->heard(getNodeHandle().resolveName(topics::kImage));
    if (const std::uint32_t lost = gaps_.lostBefore(*message); lost > 0) {
      if (warnings_.due()) {
        NODELET_WARN(
            "%u images were lost before %.6f: ~queue_size is %d, the detector is "
            "slower than the camera",
            lost, message->header.stamp.toSec(), options_.queue_size);
      }
    }
    try {
      detect(message);
    } catch (const std::exception& error) {
      if (errors_.due()) {
        NODELET_ERROR("%s: no lines for the image at %.6f: %s",
                      getNodeHandle().resolveName(topics::kImage).c_str(),
                      message->header.stamp.toSec(), error.what());
      }
    }
  }

  void detect(const sensor_msgs::ImageConstPtr& message) {
    Frame frame = toFrame(message);
    camera_->fill(&frame);
    const auto begin = std::chrono::steady_clock::now();
    LineSet set;
    set.lines = detector_->detect(frame);
    set.processing_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    set.source = options_.source;
    set.width = frame.image.cols;
    set.height = frame.image.rows;
    set.scored = detector_->givesScores();
    const auto lines = boost::make_shared<evolin_ros::LineArray>(toMessage(set));
    lines->header = message->header;
    lines_.publish(lines);
    if (lines_image_.getNumSubscribers() > 0) {
      lines_image_.publish(cv_bridge::CvImage(message->header, sensor_msgs::image_encodings::BGR8,
                                              drawLines(frame.image, set.lines))
                               .toImageMsg());
    }
  }

  Options options_;
  PluginLoader loader_;
  std::shared_ptr<LineDetector> detector_;
  std::unique_ptr<CameraSource> camera_;
  WallThrottle warnings_;
  WallThrottle errors_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  SequenceGaps gaps_;
  std::mutex connect_mutex_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Subscriber image_;
  image_transport::Publisher lines_image_;
  ros::Publisher lines_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::LineDetectorNodelet, nodelet::Nodelet)
