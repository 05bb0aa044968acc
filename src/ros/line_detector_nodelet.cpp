// The nodelet evolin_ros/LineDetector: images in, lines of any detector plug-in out.
#include <cv_bridge/cv_bridge.h>
#include <dynamic_reconfigure/server.h>
#include <evolin_ros/LineDetectorConfig.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Header.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "camera_source.h"
#include "conversions.h"
#include "detector_options.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/drawing/overlay.h"
#include "health.h"
#include "node_parameters.h"
#include "plugin_loader.h"
#include "safe_nodelet.h"
#include "sequence_gaps.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"
#include "work_queue.h"

namespace evolin::ros_shell {

class LineDetectorNodelet : public SafeNodelet {
 public:
  /// The image that is worked on is finished; nothing of this object is used by then.
  ~LineDetectorNodelet() override {
    if (!queue_) {
      unloadLast();
      return;
    }
    health_->stop();
    settings()->camera->stop();
    queue_->stop();
    const std::string drops = health_->dropsText();
    NODELET_INFO("%zu images done; left out: %s", health_->finishedCount(),
                 drops.empty() ? "none" : drops.c_str());
    unloadLast();
  }

 private:
  using Config = evolin_ros::LineDetectorConfig;

  /// What one image is worked on with; exchanged as a whole between two images.
  struct Settings {
    DetectorOptions options;
    std::shared_ptr<LineDetector> detector;
    std::shared_ptr<CameraSource> camera;
    std::string source;
  };

  struct Item {
    sensor_msgs::ImageConstPtr image;
    ros::WallTime arrival;
  };

  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    const DetectorOptions options =
        readDetectorOptions(privateParameters(getPrivateNodeHandle()), getName());
    first_ = options;
    first_.named_detector = options.detector;
    settings_ = makeSettings(first_);
    image_topic_ = handle.resolveName(topics::kImage);
    NODELET_INFO("detector %s, waiting for %s%s", options.detector.c_str(), image_topic_.c_str(),
                 options.lazy ? " (subscribed once somebody listens to the lines)" : "");
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options.warn_after);
    health_ = std::make_unique<Health>(getName(), options.health);
    queue_ = std::make_unique<WorkQueue<Item>>(
        options.realtime ? 1 : static_cast<std::size_t>(options.queue_size),
        [this](const Item& item) { work(item); });
    health_->setQueue([this] { return Health::Fill{queue_->waiting(), queue_->capacity()}; });
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
    offerSettings();

    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    lines_image_ = image_transport_->advertise(topics::kLinesImage, 1, on_listener, on_listener);
    lines_ = handle.advertise<evolin_ros::LineArray>(topics::kLines, kResultQueue, on_listener,
                                                     on_listener);
    left_out_ = handle.advertise<std_msgs::Header>(
        handle.resolveName(topics::kLines) + topics::kLeftOutSuffix, kResultQueue);
    // Of listeners that the topic has already, for the sake of another nodelet in this manager,
    // older releases of roscpp do not tell.
    if (!options.lazy || hasListener()) {
      subscribe();
    }
  }

  std::shared_ptr<const Settings> makeSettings(const DetectorOptions& options) {
    const LibraryLock lock = lockLibraries();
    auto settings = std::make_shared<Settings>();
    settings->options = options;
    settings->detector = loader_.loadDetector(options.detector);
    configure(settings->detector.get(), options);
    settings->camera = std::make_shared<CameraSource>(
        getNodeHandle(), "detector " + options.detector, settings->detector->needs(),
        options.camera, options.rectify);
    settings->source = options.taggedSource();
    warnOfIdleThreshold(*settings);
    return settings;
  }

  /// Where the detector cannot run here (its OpenCV or its network lacks), the error names those
  /// that can.
  void configure(LineDetector* detector, const DetectorOptions& options) {
    try {
      detector->configure(options.parameters);
    } catch (const UnavailableError& error) {
      std::string others;
      for (const PluginInfo& info : loader_.listDetectors()) {
        if (info.why_unavailable.empty() && info.name != options.detector) {
          others += (others.empty() ? "" : ", ") + info.name;
        }
      }
      throw UnavailableError(std::string(error.what()) + "; available for ~detector: " + others);
    }
  }

  void warnOfIdleThreshold(const Settings& settings) {
    if (settings.options.selection.score_threshold > LineSelection::kNoScoreThreshold &&
        !settings.detector->givesScores()) {
      NODELET_WARN("~score_threshold has no effect: %s gives no scores",
                   settings.options.detector.c_str());
    }
  }

  std::shared_ptr<const Settings> settings() const {
    const std::lock_guard<std::mutex> lock(settings_mutex_);
    return settings_;
  }

  /// The image that is worked on keeps the settings that it began with.
  void exchange(std::shared_ptr<const Settings> settings) {
    const std::lock_guard<std::mutex> lock(settings_mutex_);
    settings_.swap(settings);
  }

  /// On the manager's own threads: they answer while images are worked on.
  void offerSettings() {
    reconfigure_ = std::make_unique<dynamic_reconfigure::Server<Config>>(change_mutex_,
                                                                         getMTPrivateNodeHandle());
    reconfigure_->setCallback(
        [this](const Config& config, std::uint32_t /*level*/) { onReconfigure(config); });
    reload_ = getMTPrivateNodeHandle().advertiseService(services::kReload,
                                                        &LineDetectorNodelet::onReload, this);
  }

  /// Called under change_mutex_.
  void onReconfigure(const Config& config) {
    const auto before = settings();
    auto after = std::make_shared<Settings>(*before);
    LineSelection& selection = after->options.selection;
    selection.score_threshold = config.score_threshold;
    selection.min_length = config.min_length;
    selection.max_lines = static_cast<std::size_t>(config.max_lines);
    after->options.style = {config.line_width, config.draw_endpoints};
    after->source = after->options.taggedSource();
    exchange(after);
    if (after->source != before->source) {
      NODELET_INFO("from the next image on, the lines are those of '%s', no longer of '%s'",
                   after->source.c_str(), before->source.c_str());
      warnOfIdleThreshold(*after);
    }
  }

  bool onReload(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    const boost::recursive_mutex::scoped_lock lock(change_mutex_);
    try {
      DetectorOptions options =
          readDetectorOptions(privateParameters(getPrivateNodeHandle()), getName());
      options.named_detector = first_.named_detector;
      const auto after = makeSettings(options);
      exchange(after);
      reconfigure_->updateConfig(toConfig(options));
      const std::string later = first_.needsRestart(options);
      response.message = "from the next image on, the lines are those of '" + after->source + "'" +
                         (later.empty() ? "" : "; only a restart takes up " + later);
      response.success = 1;
      NODELET_INFO("%s", response.message.c_str());
    } catch (const std::exception& error) {
      response.message = std::string(error.what()) + "; the settings stay as they were";
      response.success = 0;
      NODELET_ERROR("reload: %s", response.message.c_str());
    }
    return true;
  }

  static Config toConfig(const DetectorOptions& options) {
    Config config = Config::__getDefault__();
    config.score_threshold = options.selection.score_threshold;
    config.min_length = options.selection.min_length;
    config.max_lines = static_cast<int>(options.selection.max_lines);
    config.line_width = options.style.width;
    config.draw_endpoints = options.style.endpoints;
    return config;
  }

  bool hasListener() const {
    return lines_.getNumSubscribers() > 0 || lines_image_.getNumSubscribers() > 0;
  }

  /// Called at every change of listeners, from any thread.
  void connect() {
    const LibraryLock libraries = lockLibraries();
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    if (!first_.lazy) {
      return;
    }
    const bool wanted = hasListener();
    if (wanted && !image_) {
      subscribe();
    } else if (!wanted && image_) {
      watchdog_->forget(image_topic_);
      health_->forget(image_topic_);
      image_.shutdown();
      image_ = image_transport::Subscriber();
      queue_->clear();
    }
  }

  void subscribe() {
    watchdog_->expect(image_topic_, "sensor_msgs/Image", "Remap 'image' to the camera's topic.");
    health_->expect(image_topic_);
    // Images wait in the queue of our own, which knows what it drops.
    image_ = image_transport_->subscribe(
        topics::kImage, kUnlimitedQueue, &LineDetectorNodelet::onImage, this,
        image_transport::TransportHints(first_.image_transport, ros::TransportHints(),
                                        getPrivateNodeHandle()));
  }

  void onImage(const sensor_msgs::ImageConstPtr& message) {
    watchdog_->heard(image_topic_);
    health_->heard(image_topic_);
    const std::uint32_t lost = gaps_.lostBefore(*message);
    const std::vector<Item> dropped = queue_->push({message, ros::WallTime::now()});
    for (const Item& item : dropped) {
      left_out_.publish(item.image->header);
    }
    health_->dropped("lost before they came", lost);
    health_->dropped(first_.realtime ? "dropped to keep up" : "over ~queue_size", dropped.size());
    if (lost > 0 && warnings_.due()) {
      NODELET_WARN("%u images were lost before %.6f on their way here", lost,
                   message->header.stamp.toSec());
    }
    if (!dropped.empty() && !first_.realtime && warnings_.due()) {
      NODELET_WARN(
          "%zu images were dropped before %.6f: ~queue_size is %d, the detector is slower than the "
          "camera",
          dropped.size(), message->header.stamp.toSec(), first_.queue_size);
    }
  }

  /// On the queue's thread.
  void work(const Item& item) {
    try {
      const double processing = detect(item.image);
      health_->finished((ros::WallTime::now() - item.arrival).toSec(), processing);
    } catch (const std::exception& error) {
      health_->dropped("unusable");
      left_out_.publish(item.image->header);
      if (errors_.due()) {
        NODELET_ERROR("%s: no lines for the image at %.6f: %s", image_topic_.c_str(),
                      item.image->header.stamp.toSec(), error.what());
      }
    }
  }

  /// Returns the seconds that the call of the method took.
  double detect(const sensor_msgs::ImageConstPtr& message) {
    const auto settings = this->settings();
    Frame frame = toFrame(message);
    settings->camera->fill(&frame);
    const auto begin = std::chrono::steady_clock::now();
    LineSet set;
    set.lines = selectLines(settings->detector->detect(frame), settings->options.selection);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    set.processing_time = settings->detector->processingTime().value_or(seconds);
    set.source = settings->source;
    set.width = frame.image.cols;
    set.height = frame.image.rows;
    set.scored = settings->detector->givesScores();
    const auto lines = boost::make_shared<evolin_ros::LineArray>(toMessage(set));
    lines->header = message->header;
    lines_.publish(lines);
    if (lines_image_.getNumSubscribers() > 0) {
      lines_image_.publish(
          cv_bridge::CvImage(message->header, sensor_msgs::image_encodings::BGR8,
                             drawLines(frame.image, set.lines, settings->options.style))
              .toImageMsg());
    }
    return seconds;
  }

  DetectorOptions first_;  ///< what the nodelet was started with
  std::string image_topic_;
  PluginLoader loader_;
  mutable std::mutex settings_mutex_;
  std::shared_ptr<const Settings> settings_;  ///< guarded by settings_mutex_
  boost::recursive_mutex change_mutex_;       ///< one change of settings at a time
  WallThrottle warnings_;
  WallThrottle errors_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<WorkQueue<Item>> queue_;
  SequenceGaps gaps_;
  std::mutex connect_mutex_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Subscriber image_;
  image_transport::Publisher lines_image_;
  ros::Publisher lines_;
  ros::Publisher left_out_;
  ros::ServiceServer reload_;
  std::unique_ptr<dynamic_reconfigure::Server<Config>> reconfigure_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::LineDetectorNodelet, nodelet::Nodelet)
