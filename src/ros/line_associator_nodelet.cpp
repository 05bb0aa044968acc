// The nodelet evolin_ros/LineAssociator: images and their lines in, matches between frames a step
// apart out.
#include <cv_bridge/cv_bridge.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>

#include "camera_source.h"
#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/drawing/overlay.h"
#include "frame_lines_joiner.h"
#include "node_parameters.h"
#include "plugin_loader.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class LineAssociatorNodelet : public SafeNodelet {
 private:
  struct Options {
    std::string associator = "lbd";
    std::string config;
    std::string source;
    std::string camera;
    std::string image_transport = "raw";
    int frame_step = 1;
    int queue_size = kImageQueue;
    bool lazy = true;
    double warn_after = 3;
  };

  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    readOptions();
    NODELET_INFO("associator %s over %d frame(s), waiting for %s and %s%s",
                 options_.associator.c_str(), options_.frame_step,
                 handle.resolveName(topics::kImage).c_str(),
                 handle.resolveName(topics::kLines).c_str(),
                 options_.lazy ? " (subscribed once somebody listens to the matches)" : "");
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);

    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    matches_image_ =
        image_transport_->advertise(topics::kMatchesImage, 1, on_listener, on_listener);
    matches_ = handle.advertise<evolin_ros::LineMatchArray>(topics::kMatches, kResultQueue,
                                                            on_listener, on_listener);
    // Of listeners that the topic has already, for the sake of another nodelet in this manager,
    // older releases of roscpp do not tell.
    if (!options_.lazy || hasListener()) {
      subscribe();
    }
  }

  void readOptions() {
    ParameterReader reader(privateParameters(getPrivateNodeHandle()), getName());
    reader.read("associator", &options_.associator);
    reader.read("config", &options_.config);
    reader.read("source", &options_.source);
    reader.read("camera", &options_.camera);
    reader.read("image_transport", &options_.image_transport);
    reader.read("frame_step", &options_.frame_step, 1, 100000);
    reader.read("queue_size", &options_.queue_size, 1, 100000);
    reader.read("lazy", &options_.lazy);
    reader.read("warn_after", &options_.warn_after, 0, 1e6);
    const YAML::Node overrides = reader.readMap("parameters");
    reader.finish();
    if (options_.source.empty()) {
      options_.source = options_.associator;
    }
    associator_ = loader_.loadAssociator(options_.associator);
    associator_->configure(mergedParameters(options_.config, overrides));
    camera_ = std::make_unique<CameraSource>(getNodeHandle(), "associator " + options_.associator,
                                             associator_->needs(), options_.camera);
    joiner_ = std::make_unique<FrameLinesJoiner>(static_cast<std::size_t>(options_.queue_size));
  }

  bool hasListener() const {
    return matches_.getNumSubscribers() > 0 || matches_image_.getNumSubscribers() > 0;
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
      watchdog_->forget(imageTopic());
      watchdog_->forget(linesTopic());
      image_.shutdown();
      image_ = image_transport::Subscriber();
      lines_.shutdown();
    }
  }

  void subscribe() {
    watchdog_->expect(imageTopic(), "sensor_msgs/Image", "Remap 'image' to the camera's topic.");
    watchdog_->expect(linesTopic(), "evolin_ros/LineArray", "Remap 'lines' to a detector's topic.");
    lines_ = getNodeHandle().subscribe(topics::kLines, kResultQueue,
                                       &LineAssociatorNodelet::onLines, this);
    image_ = image_transport_->subscribe(
        topics::kImage, static_cast<std::uint32_t>(options_.queue_size),
        &LineAssociatorNodelet::onImage, this,
        image_transport::TransportHints(options_.image_transport, ros::TransportHints(),
                                        getPrivateNodeHandle()));
  }

  std::string imageTopic() { return getNodeHandle().resolveName(topics::kImage); }
  std::string linesTopic() { return getNodeHandle().resolveName(topics::kLines); }

  void onImage(const sensor_msgs::ImageConstPtr& message) {
    watchdog_->heard(imageTopic());
    take(joiner_->addImage(message));
  }

  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    watchdog_->heard(linesTopic());
    take(joiner_->addLines(message));
  }

  void take(const FrameLinesJoiner::Result& result) {
    if (!result.problem.empty()) {
      if (warnings_.due()) {
        NODELET_WARN("%s", result.problem.c_str());
      }
    }
    for (const FrameLinesJoiner::Pair& pair : result.complete) {
      if (pair.begins_pass) {
        NODELET_INFO("time jumped back: frames of the last pass are forgotten");
        window_.clear();
      }
      try {
        associate(pair);
      } catch (const std::exception& error) {
        if (errors_.due()) {
          NODELET_ERROR("no matches for the frame at %.6f: %s", pair.lines->header.stamp.toSec(),
                        error.what());
        }
      }
    }
  }

  void associate(const FrameLinesJoiner::Pair& pair) {
    const LineSet set = fromMessage(*pair.lines);
    // Indices of two sources must never meet in one match.
    if (!window_.empty() && window_source_ != set.source) {
      window_.clear();
    }
    window_source_ = set.source;
    auto current = std::make_shared<FrameLines>();
    current->frame = toFrame(pair.image);
    camera_->fill(&current->frame);
    current->lines = set.lines;
    window_.push_back(current);
    const auto step = static_cast<std::size_t>(options_.frame_step);
    if (window_.size() > step + 1) {
      window_.pop_front();
    }
    if (window_.size() == step + 1) {
      match(*window_.front(), *current, pair.lines->header);
    }
  }

  void match(const FrameLines& first, const FrameLines& second, const std_msgs::Header& header) {
    const auto begin = std::chrono::steady_clock::now();
    MatchSet set;
    set.matches = associator_->match(first, second);
    set.processing_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    set.first_stamp = first.frame.stamp;
    set.source = options_.source;
    set.lines_source = window_source_;
    const auto message = boost::make_shared<evolin_ros::LineMatchArray>(toMessage(set));
    message->header = header;
    matches_.publish(message);
    if (matches_image_.getNumSubscribers() > 0) {
      const cv::Mat picture = drawMatches(first.frame.image, first.lines, second.frame.image,
                                          second.lines, set.matches);
      matches_image_.publish(
          cv_bridge::CvImage(header, sensor_msgs::image_encodings::BGR8, picture).toImageMsg());
    }
  }

  Options options_;
  PluginLoader loader_;
  std::shared_ptr<LineAssociator> associator_;
  std::unique_ptr<CameraSource> camera_;
  std::unique_ptr<FrameLinesJoiner> joiner_;
  WallThrottle warnings_;
  WallThrottle errors_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::deque<std::shared_ptr<FrameLines>> window_;  ///< the last frame_step + 1 frames
  std::string window_source_;
  std::mutex connect_mutex_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Subscriber image_;
  image_transport::Publisher matches_image_;
  ros::Subscriber lines_;
  ros::Publisher matches_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::LineAssociatorNodelet, nodelet::Nodelet)
