// The nodelet evolin_ros/LineAssociator: images and their lines in, matches between frames a step
// apart out.
#include <cv_bridge/cv_bridge.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Header.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "associator_options.h"
#include "camera_source.h"
#include "conversions.h"
#include "evolin_ros/drawing/overlay.h"
#include "frame_lines_joiner.h"
#include "health.h"
#include "node_parameters.h"
#include "plugin_loader.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"
#include "work_queue.h"

namespace evolin::ros_shell {

class LineAssociatorNodelet : public SafeNodelet {
 public:
  /// The pair that is worked on is finished; nothing of this object is used by then.
  ~LineAssociatorNodelet() override {
    if (!queue_) {
      unloadLast();
      return;
    }
    health_->stop();
    settings()->camera->stop();
    queue_->stop();
    const std::string drops = health_->dropsText();
    NODELET_INFO("%zu frames done; left out: %s", health_->finishedCount(),
                 drops.empty() ? "none" : drops.c_str());
    if (const MatchCounts counts = settings()->associator->counts(); !counts.empty()) {
      NODELET_INFO("with the last settings: %s", toText(counts).c_str());
    }
    unloadLast();
  }

 private:
  /// What one frame is worked on with; exchanged as a whole between two frames.
  struct Settings {
    AssociatorOptions options;
    std::shared_ptr<LineAssociator> associator;
    std::shared_ptr<CameraSource> camera;
    std::string source;
  };

  struct Item {
    FrameLinesJoiner::Pair pair;
    ros::WallTime arrival;
    int pass;
  };

  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    first_ = readAssociatorOptions(privateParameters(getPrivateNodeHandle()), getName());
    first_.named_associator = first_.associator;
    settings_ = makeSettings(first_);
    image_topic_ = handle.resolveName(topics::kImage);
    lines_topic_ = handle.resolveName(topics::kLines);
    NODELET_INFO("associator %s over %d frame(s), waiting for %s and %s%s",
                 first_.associator.c_str(), first_.frame_step, image_topic_.c_str(),
                 lines_topic_.c_str(),
                 first_.lazy ? " (subscribed once somebody listens to the matches)" : "");
    joiner_ = std::make_unique<FrameLinesJoiner>(static_cast<std::size_t>(first_.queue_size));
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), first_.warn_after);
    health_ = std::make_unique<Health>(getName(), first_.health);
    queue_ = std::make_unique<WorkQueue<Item>>(first_.realtime ? 1 : 0,
                                               [this](const Item& item) { work(item); });
    health_->setQueue([this] { return Health::Fill{queue_->waiting(), queue_->capacity()}; });
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
    // On the manager's own threads: it answers while frames are worked on.
    reload_ = getMTPrivateNodeHandle().advertiseService(services::kReload,
                                                        &LineAssociatorNodelet::onReload, this);

    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    matches_image_ =
        image_transport_->advertise(topics::kMatchesImage, 1, on_listener, on_listener);
    matches_ = handle.advertise<evolin_ros::LineMatchArray>(topics::kMatches, kResultQueue,
                                                            on_listener, on_listener);
    left_out_ = handle.advertise<std_msgs::Header>(
        handle.resolveName(topics::kMatches) + topics::kLeftOutSuffix, kResultQueue);
    // Of listeners that the topic has already, for the sake of another nodelet in this manager,
    // older releases of roscpp do not tell.
    if (!first_.lazy || hasListener()) {
      subscribe();
    }
  }

  std::shared_ptr<const Settings> makeSettings(const AssociatorOptions& options) {
    const LibraryLock lock = lockLibraries();
    auto settings = std::make_shared<Settings>();
    settings->options = options;
    settings->associator = loader_.loadAssociator(options.associator);
    settings->associator->configure(options.parameters);
    settings->camera = std::make_shared<CameraSource>(
        getNodeHandle(), "associator " + options.associator, settings->associator->needs(),
        options.camera, options.rectify);
    settings->source = options.taggedSource();
    return settings;
  }

  std::shared_ptr<const Settings> settings() const {
    const std::lock_guard<std::mutex> lock(settings_mutex_);
    return settings_;
  }

  bool onReload(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    const std::lock_guard<std::mutex> one_at_a_time(change_mutex_);
    try {
      AssociatorOptions options =
          readAssociatorOptions(privateParameters(getPrivateNodeHandle()), getName());
      options.named_associator = first_.named_associator;
      std::shared_ptr<const Settings> after = makeSettings(options);
      const std::string later = first_.needsRestart(options);
      response.message = "from the next frame on, the matches are those of '" + after->source +
                         "'" + (later.empty() ? "" : "; only a restart takes up " + later);
      response.success = 1;
      {
        const std::lock_guard<std::mutex> lock(settings_mutex_);
        settings_.swap(after);
      }
      NODELET_INFO("%s", response.message.c_str());
    } catch (const std::exception& error) {
      response.message = std::string(error.what()) + "; the settings stay as they were";
      response.success = 0;
      NODELET_ERROR("reload: %s", response.message.c_str());
    }
    return true;
  }

  bool hasListener() const {
    return matches_.getNumSubscribers() > 0 || matches_image_.getNumSubscribers() > 0;
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
      for (const std::string& topic : {image_topic_, lines_topic_}) {
        watchdog_->forget(topic);
        health_->forget(topic);
      }
      image_.shutdown();
      image_ = image_transport::Subscriber();
      lines_.shutdown();
      queue_->clear();
    }
  }

  void subscribe() {
    watchdog_->expect(image_topic_, "sensor_msgs/Image", "Remap 'image' to the camera's topic.");
    watchdog_->expect(lines_topic_, "evolin_ros/LineArray", "Remap 'lines' to a detector's topic.");
    health_->expect(image_topic_);
    health_->expect(lines_topic_);
    // Frames wait in queues of our own, which know what they drop.
    lines_ = getNodeHandle().subscribe(topics::kLines, kUnlimitedQueue,
                                       &LineAssociatorNodelet::onLines, this);
    image_ = image_transport_->subscribe(
        topics::kImage, kUnlimitedQueue, &LineAssociatorNodelet::onImage, this,
        image_transport::TransportHints(first_.image_transport, ros::TransportHints(),
                                        getPrivateNodeHandle()));
  }

  void onImage(const sensor_msgs::ImageConstPtr& message) {
    watchdog_->heard(image_topic_);
    health_->heard(image_topic_);
    take(joiner_->addImage(message));
  }

  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    watchdog_->heard(lines_topic_);
    health_->heard(lines_topic_);
    take(joiner_->addLines(message));
  }

  void take(const FrameLinesJoiner::Result& result) {
    if (!result.problem.empty()) {
      health_->dropped("without their image", result.left_out.size());
      for (const std_msgs::Header& header : result.left_out) {
        left_out_.publish(header);
      }
      if (warnings_.due()) {
        NODELET_WARN("%s", result.problem.c_str());
      }
    }
    const ros::WallTime now = ros::WallTime::now();
    for (const FrameLinesJoiner::Pair& pair : result.complete) {
      if (pair.begins_pass) {
        NODELET_INFO("time jumped back: frames of the last pass are forgotten");
        ++pass_;
      }
      const std::vector<Item> dropped = queue_->push({pair, now, pass_});
      health_->dropped("dropped to keep up", dropped.size());
      for (const Item& item : dropped) {
        left_out_.publish(item.pair.lines->header);
      }
    }
  }

  /// On the queue's thread.
  void work(const Item& item) {
    if (window_pass_ != item.pass) {
      window_.clear();
      window_pass_ = item.pass;
    }
    try {
      const double processing = associate(item.pair);
      health_->finished((ros::WallTime::now() - item.arrival).toSec(), processing);
    } catch (const std::exception& error) {
      health_->dropped("unusable");
      left_out_.publish(item.pair.lines->header);
      if (errors_.due()) {
        NODELET_ERROR("no matches for the frame at %.6f: %s", item.pair.lines->header.stamp.toSec(),
                      error.what());
      }
    }
  }

  /// Returns the seconds that the method took.
  double associate(const FrameLinesJoiner::Pair& pair) {
    const auto settings = this->settings();
    const LineSet set = fromMessage(*pair.lines);
    // Indices of two sources must never meet in one match, nor frames of two passes, nor images
    // of two cameras.
    if (!window_.empty() && (pair.begins_pass || window_source_ != set.source ||
                             set.stamp <= window_.back()->frame.stamp ||
                             window_rectify_ != settings->options.rectify)) {
      window_.clear();
    }
    window_rectify_ = settings->options.rectify;
    if (describer_ != settings->associator) {
      forgetDescriptions();
      describer_ = settings->associator;
    }
    window_source_ = set.source;
    auto current = std::make_shared<FrameLines>();
    current->frame = toFrame(pair.image);
    settings->camera->fill(&current->frame);
    current->lines = set.lines;
    window_.push_back(current);
    const auto step = static_cast<std::size_t>(first_.frame_step);
    if (window_.size() > step + 1) {
      window_.pop_front();
    }
    if (window_.size() <= step) {
      left_out_.publish(pair.lines->header);
      return 0;
    }
    return match(*settings, *window_.front(), *current, pair.lines->header);
  }

  /// One associator does not understand what another has noted of a frame.
  void forgetDescriptions() {
    for (const std::shared_ptr<FrameLines>& frame : window_) {
      frame->description.reset();
    }
  }

  double match(const Settings& settings, const FrameLines& first, const FrameLines& second,
               const std_msgs::Header& header) {
    const auto begin = std::chrono::steady_clock::now();
    MatchSet set;
    set.matches = settings.associator->match(first, second);
    set.processing_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    set.first_stamp = first.frame.stamp;
    set.source = settings.source;
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
    return set.processing_time;
  }

  AssociatorOptions first_;  ///< what the nodelet was started with
  std::string image_topic_;
  std::string lines_topic_;
  PluginLoader loader_;
  mutable std::mutex settings_mutex_;
  std::shared_ptr<const Settings> settings_;  ///< guarded by settings_mutex_
  std::mutex change_mutex_;                   ///< one change of settings at a time
  std::unique_ptr<FrameLinesJoiner> joiner_;
  WallThrottle warnings_;
  WallThrottle errors_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  int pass_ = 0;  ///< of the newest frame: how often time jumped back
  // Of the queue's thread alone, up to the blank line.
  std::deque<std::shared_ptr<FrameLines>> window_;  ///< the last frame_step + 1 frames
  int window_pass_ = 0;
  std::string window_source_;
  Rectify window_rectify_ = Rectify::kNever;
  std::shared_ptr<LineAssociator> describer_;  ///< whose descriptions the window's frames hold

  std::unique_ptr<WorkQueue<Item>> queue_;
  std::mutex connect_mutex_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Subscriber image_;
  image_transport::Publisher matches_image_;
  ros::Subscriber lines_;
  ros::Publisher matches_;
  ros::Publisher left_out_;
  ros::ServiceServer reload_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::LineAssociatorNodelet, nodelet::Nodelet)
