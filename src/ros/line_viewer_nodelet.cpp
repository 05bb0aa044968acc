// The nodelet evolin_ros/LineViewer: images, lines, ground truth and matches in, pictures and
// markers of what is right, wrong and missing out.
#include <cv_bridge/cv_bridge.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>
#include <pluginlib/class_list_macros.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "health.h"
#include "node_parameters.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "view_joiner.h"
#include "view_markers.h"
#include "view_numbers.h"
#include "viewer_options.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class LineViewerNodelet : public SafeNodelet {
 public:
  LineViewerNodelet() = default;
  ~LineViewerNodelet() override {
    if (health_) {
      health_->stop();
    }
    unloadLast();
  }
  LineViewerNodelet(const LineViewerNodelet&) = delete;
  LineViewerNodelet& operator=(const LineViewerNodelet&) = delete;
  LineViewerNodelet(LineViewerNodelet&&) = delete;
  LineViewerNodelet& operator=(LineViewerNodelet&&) = delete;

 private:
  /// Wall time without any part until frames that wait for one are shown without it, s.
  static constexpr double kIdle = 0.5;

  void start() override {
    ros::NodeHandle& handle = getNodeHandle();
    options_ = readViewerOptions(privateParameters(getPrivateNodeHandle()), getName());
    startAfresh();
    image_transport_ = std::make_unique<image_transport::ImageTransport>(handle);
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);
    health_ = std::make_unique<Health>(getName(), options_.health);
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
    NODELET_INFO("shows %s and %s on %s and %s, while somebody looks",
                 handle.resolveName(topics::kLines).c_str(),
                 handle.resolveName(topics::kGroundTruthLines).c_str(),
                 handle.resolveName(topics::kOverlay).c_str(),
                 handle.resolveName(topics::kMarkers).c_str());
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    const auto on_listener = [this](const auto&) { connect(); };
    overlay_ = image_transport_->advertise(topics::kOverlay, 1, on_listener, on_listener);
    markers_ = handle.advertise<visualization_msgs::MarkerArray>(topics::kMarkers, 1, on_listener,
                                                                 on_listener);
    // Of listeners that the topics have already older releases of roscpp do not tell.
    follow();
  }

  /// Called at every change of listeners, from any thread.
  void connect() {
    const LibraryLock libraries = lockLibraries();
    const std::lock_guard<std::mutex> lock(connect_mutex_);
    follow();
  }

  void follow() {
    const bool wanted = overlay_.getNumSubscribers() > 0 || markers_.getNumSubscribers() > 0;
    if (wanted && !image_) {
      subscribe();
    } else if (!wanted && image_) {
      unsubscribe();
    }
  }

  void subscribe() {
    afresh_ = true;
    expect(topics::kImage, "sensor_msgs/Image", "Remap 'image' to the camera's topic.");
    expect(topics::kLines, "evolin_ros/LineArray", "Remap 'lines' to the front-end's topic.");
    listen<evolin_ros::LineArray>(topics::kLines, [this](const auto& message) {
      heard(topics::kLines);
      show(joiner_->addLines(message));
    });
    ground_truth_ = listen<evolin_ros::LineArray>(
        topics::kGroundTruthLines,
        [this](const auto& message) { show(joiner_->addGroundTruth(message)); });
    matches_ = listen<evolin_ros::LineMatchArray>(
        topics::kMatches, [this](const auto& message) { show(joiner_->addMatches(message)); });
    listen<sensor_msgs::CameraInfo>(topics::kCameraInfo,
                                    [this](const auto& message) { takeCamera(*message); });
    listenToFigures();
    idle_timer_ = getNodeHandle().createWallTimer(
        ros::WallDuration(kIdle / 2), [this](const ros::WallTimerEvent&) { showWhenIdle(); });
    // Last: it says whether there are subscriptions.
    image_ = image_transport_->subscribe(
        topics::kImage, static_cast<std::uint32_t>(options_.queue_size),
        [this](const sensor_msgs::ImageConstPtr& message) {
          heard(topics::kImage);
          refresh();
          show(joiner_->addImage(message));
        },
        ros::VoidPtr(),
        image_transport::TransportHints(options_.image_transport, ros::TransportHints(),
                                        getPrivateNodeHandle()));
  }

  void listenToFigures() {
    listen<evolin_ros::DetectionMetrics>(topics::kDetectionCumulative, [this](const auto& message) {
      // The evaluator was reset, or time jumped back.
      if (numbers_->take(*message)) {
        frames_->clear();
        takeMarkersAway(message->header);
      }
    });
    listen<evolin_ros::HeatmapMetrics>(topics::kHeatmapCumulative,
                                       [this](const auto& message) { numbers_->take(*message); });
    listen<evolin_ros::RepeatabilityMetrics>(
        topics::kRepeatabilityCumulative,
        [this](const auto& message) { numbers_->take(*message); });
    listen<evolin_ros::AssociationMetrics>(
        topics::kAssociationCumulative,
        [this](const auto& message) { numbers_->takeTrue(*message); });
    listen<evolin_ros::AssociationMetrics>(
        topics::kDetectedAssociationCumulative,
        [this](const auto& message) { numbers_->takeDetected(*message); });
    listen<evolin_ros::PoseMetrics>(topics::kPoseCumulative,
                                    [this](const auto& message) { numbers_->take(*message); });
    listen<evolin_ros::Coverage>(topics::kCoverage,
                                 [this](const auto& message) { numbers_->take(*message); });
  }

  /// All share the single-threaded queue, so that each stays in its own order.
  template <class Message, class Take>
  ros::Subscriber listen(const char* topic, const Take& take) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [this, take](const boost::shared_ptr<const Message>& message) {
          refresh();
          take(message);
        };
    subscribers_.push_back(getNodeHandle().subscribe<Message>(topic, kResultQueue, callback));
    return subscribers_.back();
  }

  void unsubscribe() {
    for (const char* topic : {topics::kImage, topics::kLines}) {
      watchdog_->forget(getNodeHandle().resolveName(topic));
      health_->forget(getNodeHandle().resolveName(topic));
    }
    idle_timer_.stop();
    image_.shutdown();
    image_ = image_transport::Subscriber();
    for (ros::Subscriber& subscriber : subscribers_) {
      subscriber.shutdown();
    }
    subscribers_.clear();
    ground_truth_ = matches_ = ros::Subscriber();
  }

  void expect(const char* topic, const std::string& type, const std::string& hint) {
    watchdog_->expect(getNodeHandle().resolveName(topic), type, hint);
    health_->expect(getNodeHandle().resolveName(topic));
  }

  void heard(const char* topic) {
    watchdog_->heard(getNodeHandle().resolveName(topic));
    health_->heard(getNodeHandle().resolveName(topic));
  }

  /// Before every message. What was kept before somebody looked again is of long ago.
  void refresh() {
    // Never waits for the mutex: whoever holds it waits for callbacks to end.
    if (afresh_.exchange(false)) {
      startAfresh();
    }
    const std::unique_lock<std::mutex> lock(connect_mutex_, std::try_to_lock);
    if (lock && ground_truth_.getNumPublishers() > 0) {
      joiner_->expectGroundTruth();
    }
    if (lock && matches_.getNumPublishers() > 0) {
      joiner_->expectMatches();
    }
    last_part_ = ros::WallTime::now();
  }

  void startAfresh() {
    not_shown_ = 0;
    joiner_ = std::make_unique<ViewJoiner>(static_cast<std::size_t>(options_.queue_size),
                                           static_cast<std::size_t>(options_.patience));
    frames_ = std::make_unique<ViewFrames>(options_.frame);
    numbers_ = std::make_unique<ViewNumbers>(options_.frame.threshold);
    anew_ = true;
  }

  void showWhenIdle() {
    if ((ros::WallTime::now() - last_part_).toSec() > kIdle) {
      show(joiner_->flush());
    }
  }

  void takeCamera(const sensor_msgs::CameraInfo& message) {
    try {
      camera_ = fromMessage(message);
      camera_problem_.clear();
    } catch (const Error& error) {
      camera_.reset();
      // Once: it comes with every image.
      if (std::exchange(camera_problem_, error.what()) != error.what()) {
        NODELET_WARN("no markers: %s: %s", getNodeHandle().resolveName(topics::kCameraInfo).c_str(),
                     error.what());
      }
    }
  }

  void show(const ViewJoiner::Result& result) {
    if (!result.problem.empty()) {
      const UnpairedParts& unpaired = joiner_->unpaired();
      health_->dropped("not shown", unpaired.sum() - std::exchange(not_shown_, unpaired.sum()));
      warn(result.problem + "; so far not shown: " + std::to_string(unpaired.images) + " images, " +
           std::to_string(unpaired.lines) + " lines, " + std::to_string(unpaired.ground_truths) +
           " ground truths, " + std::to_string(unpaired.matches) + " matches");
    }
    for (const ViewParts& parts : result.frames) {
      const ros::WallTime begin = ros::WallTime::now();
      try {
        publish(parts);
        const double seconds = (ros::WallTime::now() - begin).toSec();
        health_->finished(seconds, seconds);
      } catch (const std::exception& error) {
        health_->dropped("unusable");
        warn("no picture of the frame at " + formatStamp(fromRos(parts.lines->header.stamp)) +
             ": " + error.what());
      }
    }
  }

  void publish(const ViewParts& parts) {
    EvaluatedFrame frame = frames_->make(parts);
    for (const std::string& problem : frames_->problems()) {
      warn(problem);
    }
    anew_ = anew_ || parts.begins_pass;
    const std_msgs::Header& header = parts.image->header;
    if (markers_.getNumSubscribers() > 0 && camera_) {
      markers_.publish(toMarkers(header, *camera_, options_.plane_distance, frame, options_.view,
                                 std::exchange(anew_, false)));
    }
    if (overlay_.getNumSubscribers() > 0) {
      frame.sections = numbers_->sections(joiner_->unpaired().sum());
      const cv::Mat picture = drawEvaluatedFrame(frame, options_.view);
      overlay_.publish(
          cv_bridge::CvImage(header, sensor_msgs::image_encodings::BGR8, picture).toImageMsg());
    }
  }

  /// At once: where nothing is played, no next frame would.
  void takeMarkersAway(const std_msgs::Header& header) {
    if (markers_.getNumSubscribers() > 0) {
      markers_.publish(noMarkers(header));
    }
    anew_ = true;
  }

  void warn(const std::string& text) {
    if (warnings_.due()) {
      NODELET_WARN("%s", text.c_str());
    }
  }

  ViewerOptions options_;
  WallThrottle warnings_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  // Of the callbacks, which come one at a time.
  std::unique_ptr<ViewJoiner> joiner_;
  std::unique_ptr<ViewFrames> frames_;
  std::unique_ptr<ViewNumbers> numbers_;
  std::optional<Camera> camera_;
  std::string camera_problem_;  ///< of the newest camera_info, when it cannot be used
  std::size_t not_shown_ = 0;   ///< parts without the others, as far as /diagnostics was told
  bool anew_ = true;            ///< the next markers are the first of a pass
  ros::WallTime last_part_;
  std::atomic<bool> afresh_{false};  ///< somebody looks again
  // Of changes of listeners, which come from any thread.
  std::mutex connect_mutex_;
  std::unique_ptr<image_transport::ImageTransport> image_transport_;
  image_transport::Publisher overlay_;
  ros::Publisher markers_;
  image_transport::Subscriber image_;
  std::vector<ros::Subscriber> subscribers_;  ///< all but that of images
  ros::Subscriber ground_truth_;              ///< of these
  ros::Subscriber matches_;
  ros::WallTimer idle_timer_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::LineViewerNodelet, nodelet::Nodelet)
